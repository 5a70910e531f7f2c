#include "device/protocols/falcon.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

/// What the device sends: the same frame as it receives, with encoders for motors.
std::vector<std::uint8_t> answer(const std::array<std::int16_t, 3>& encoders,
                                 std::uint8_t flags = 0) {
  const auto packet = encode_falcon({encoders});
  std::vector<std::uint8_t> bytes(packet.begin(), packet.end());
  bytes[13] = static_cast<std::uint8_t>('A' + flags);
  return bytes;
}

std::vector<std::uint8_t> with_status(std::vector<std::uint8_t> bytes) {
  bytes.insert(bytes.begin(), {0x01, 0x60});
  return bytes;
}

TEST(FalconTest, SendsNibblesLowestFirst) {
  FalconOutput output;
  output.motors = {0x123, -1, 0};
  output.homing = true;
  output.green = true;
  const auto packet = encode_falcon(output);
  // 0x0123 is 3, 2, 1, 0; -1 is 15 four times
  EXPECT_EQ(std::string(packet.begin(), packet.end()), "<DCBAPPPPAAAADA>");
}

TEST(FalconTest, ClampsMotors) {
  const auto packet = encode_falcon({{32767, -32768, 4095}});
  const auto read = decode_falcon(packet);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->encoders, (std::array<std::int16_t, 3>{4095, -4095, 4095}));
}

TEST(FalconTest, ReadsEncodersButtonsAndHomedLegs) {
  const auto read = decode_falcon(answer({-2000, 1234, -1}, 0x54));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->encoders, (std::array<std::int16_t, 3>{-2000, 1234, -1}));
  EXPECT_EQ(read->buttons, 4);
  EXPECT_EQ(read->homed, 5);
}

TEST(FalconTest, RefusesWhatIsNoPacket) {
  std::vector<std::uint8_t> packet = answer({1, 2, 3});
  EXPECT_FALSE(decode_falcon(Bytes(packet).first(14)));
  packet[3] = 0x20;
  EXPECT_FALSE(decode_falcon(packet));
  packet = answer({1, 2, 3});
  packet[15] = 'A';
  EXPECT_FALSE(decode_falcon(packet));
  EXPECT_FALSE(decode_falcon({}));
}

TEST(FalconTest, PutsPacketsTogetherThatAreSplitOverUsb) {
  const std::vector<std::uint8_t> whole = answer({7, 8, 9});
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    FalconStream stream;
    const auto middle = whole.begin() + static_cast<std::ptrdiff_t>(cut);
    const auto first = take_ftdi_packet(stream, with_status({whole.begin(), middle}));
    const auto second = take_ftdi_packet(stream, with_status({middle, whole.end()}));
    ASSERT_NE(first.has_value(), second.has_value()) << cut;
    EXPECT_EQ((first ? first : second)->encoders[2], 9);
  }
}

TEST(FalconTest, HasNothingInAPacketOfStatusOnly) {
  FalconStream stream;
  EXPECT_FALSE(take_ftdi_packet(stream, std::array<std::uint8_t, 2>{0x01, 0x60}));
  EXPECT_FALSE(take_ftdi_packet(stream, std::array<std::uint8_t, 1>{0x01}));
  EXPECT_FALSE(take_ftdi_packet(stream, {}));
}

TEST(FalconTest, FindsTheNextPacketAfterLostBytes) {
  std::mt19937 random(2);
  FalconStream stream;
  for (std::int16_t i = 0; i < 500; ++i) {
    std::vector<std::uint8_t> damaged = answer({i, i, i});
    const auto first = static_cast<std::ptrdiff_t>(random() % damaged.size());
    damaged.erase(damaged.begin() + first);
    EXPECT_FALSE(take_ftdi_packet(stream, with_status(damaged)));
    const auto read = take_ftdi_packet(stream, with_status(answer({i, i, i}, 1)));
    ASSERT_TRUE(read) << i << " after losing byte " << first;
    EXPECT_EQ(read->encoders[0], i);
    EXPECT_EQ(read->buttons, 1);
  }
}

TEST(FalconTest, TakesTheLastOfSeveralPackets) {
  std::vector<std::uint8_t> two = answer({1, 1, 1});
  const std::vector<std::uint8_t> second = answer({2, 2, 2});
  two.insert(two.end(), second.begin(), second.end());
  FalconStream stream;
  EXPECT_EQ(take_ftdi_packet(stream, with_status(two))->encoders[0], 2);
}

}  // namespace
}  // namespace torsion::engine
