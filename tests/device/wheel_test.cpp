// What is read of a wheel's report descriptor, and what is made of it.

#include "device/protocols/wheel.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/device/space_mouse_descriptor.hpp"
#include "tests/device/wheel_descriptors.hpp"

namespace torsion::engine {
namespace {

using test::kOpenFfbDescriptor;
using test::kOtherWheelDescriptor;
using Packet = std::vector<std::uint8_t>;

WheelLayout layout_of(Bytes descriptor) {
  return wheel_layout(*parse_hid_descriptor(descriptor)).value();
}

Packet bytes_of(const WheelPacket& packet) {
  return {packet.data().begin(), packet.data().end()};
}

// Written down from the firmware's structs (OpenFFBoard, ffb_defs.h).
TEST(WheelTest, SaysWhatAnOpenFfbBoardReads) {
  const WheelLayout layout = layout_of(kOpenFfbDescriptor);
  EXPECT_EQ(bytes_of(encode_wheel_effect(layout, 3, 0.05)),
            (Packet{0x01, 3, 1, 50, 0, 0, 0, 0, 0, 0, 0, 255, 0, 0x02, 0x28, 0x23}));  // 9000
  EXPECT_EQ(bytes_of(encode_wheel_torque(layout, 3, 1.0)), (Packet{0x05, 3, 0xFF, 0x7F}));
  EXPECT_EQ(bytes_of(encode_wheel_torque(layout, 3, -2.0)), (Packet{0x05, 3, 0x01, 0x80}));
  EXPECT_EQ(bytes_of(encode_wheel_torque(layout, 3, 1e-9)), (Packet{0x05, 3, 0, 0}));
  EXPECT_EQ(bytes_of(encode_wheel_torque(layout, 3, std::nan(""))), (Packet{0x05, 3, 0, 0}));
  EXPECT_EQ(bytes_of(encode_wheel_start(layout, 3)), (Packet{0x0A, 3, 1, 1}));
  EXPECT_EQ(bytes_of(encode_wheel_stop(layout, 3)), (Packet{0x0A, 3, 3, 0}));
  EXPECT_EQ(bytes_of(encode_wheel_enable(layout)), (Packet{0x0C, 1}));
  EXPECT_EQ(bytes_of(encode_wheel_reset(layout)), (Packet{0x0C, 8}));
  EXPECT_EQ(bytes_of(encode_wheel_gain(layout)), (Packet{0x0D, 255}));
  EXPECT_EQ(bytes_of(encode_wheel_create(layout)), (Packet{0x11, 1, 0, 0}));
  EXPECT_EQ(decode_wheel_load(layout, Packet{0x12, 7, 1, 0, 0}), 7);
  EXPECT_FALSE(decode_wheel_load(layout, Packet{0x12, 7, 2, 0, 0}));  // it is full
  EXPECT_FALSE(decode_wheel_load(layout, Packet{0x12, 0, 1, 0, 0}));
  EXPECT_FALSE(decode_wheel_load(layout, Packet{0x12}));
}

TEST(WheelTest, SaysItOtherwiseWhereTheDescriptorDoes) {
  const WheelLayout layout = layout_of(kOtherWheelDescriptor);
  // Five units of 10 ms; X in place of a direction.
  EXPECT_EQ(bytes_of(encode_wheel_effect(layout, 3, 0.05)), (Packet{0x32, 3, 3, 1, 5, 0}));
  EXPECT_EQ(bytes_of(encode_wheel_torque(layout, 3, -1.0)), (Packet{0x33, 0x81, 3}));
  EXPECT_EQ(bytes_of(encode_wheel_start(layout, 3)), (Packet{0x34, 1, 3}));
  EXPECT_EQ(bytes_of(encode_wheel_stop(layout, 3)), (Packet{0x34, 0, 3}));
  EXPECT_EQ(bytes_of(encode_wheel_enable(layout)), (Packet{0x35, 2}));
  EXPECT_EQ(bytes_of(encode_wheel_reset(layout)), (Packet{0x35, 3}));
  EXPECT_TRUE(bytes_of(encode_wheel_gain(layout)).empty());
  EXPECT_EQ(bytes_of(encode_wheel_create(layout)), (Packet{0x36, 3}));
  EXPECT_EQ(decode_wheel_load(layout, Packet{0x37, 3, 9}), 9);
}

TEST(WheelTest, ReadsTurnButtonsAndState) {
  const WheelLayout layout = layout_of(kOpenFfbDescriptor);
  WheelState state;
  Packet report(25);
  report[0] = 1;
  report[1] = 0x05;
  report[9] = 0x01;  // X, -32767
  report[10] = 0x80;
  ASSERT_TRUE(take_wheel_report(layout, report, state));
  EXPECT_DOUBLE_EQ(state.turn, -1.0);
  EXPECT_EQ(state.buttons, 5U);
  EXPECT_FALSE(take_wheel_report(layout, Bytes(report).first(24), state));  // cut off
  EXPECT_TRUE(take_wheel_report(layout, Packet{2, 0x12, 0}, state));
  EXPECT_TRUE(state.enabled && state.powered);
  EXPECT_DOUBLE_EQ(state.turn, -1.0);
  const WheelLayout other = layout_of(kOtherWheelDescriptor);
  ASSERT_TRUE(take_wheel_report(other, Packet{0x31, 0, 0, 77, 0xFF, 0xFF}, state));
  EXPECT_DOUBLE_EQ(state.turn, 1.0);  // steering, and not the pedal on X
}

TEST(WheelTest, KnowsWhatPlaysNoEffects) {
  const auto mouse = parse_hid_descriptor(test::kSpaceMouseDescriptor);
  EXPECT_FALSE(has_effects(*mouse));
  EXPECT_FALSE(wheel_layout(*mouse));
  EXPECT_TRUE(has_effects(*parse_hid_descriptor(kOpenFfbDescriptor)));
}

// Its duration is in another report than the effect that it is of: no packet can say both.
TEST(WheelTest, DoesNotUnderstandAnEffectInTwoReports) {
  Packet descriptor(kOpenFfbDescriptor.begin(), kOpenFfbDescriptor.end());
  const std::array<std::uint8_t, 4> duration = {0x09, 0x50, 0x09, 0x54};
  const auto at =
      std::search(descriptor.begin(), descriptor.end(), duration.begin(), duration.end());
  ASSERT_NE(at, descriptor.end());
  descriptor.insert(at, {0x85, 0x2A});  // report id 42 from here on
  const auto reports = parse_hid_descriptor(descriptor);
  ASSERT_TRUE(reports);
  EXPECT_FALSE(wheel_layout(*reports));
}

/// Whatever a descriptor says, nothing is written beyond a packet and nothing is read beyond a
/// report.
TEST(WheelTest, SurvivesAnyDescriptor) {
  std::mt19937 random(1);
  int understood = 0;
  for (int i = 0; i < 20000; ++i) {
    Packet descriptor(kOpenFfbDescriptor.begin(), kOpenFfbDescriptor.end());
    const auto changes = random() % 6;
    for (unsigned change = 0; change < changes; ++change) {
      descriptor[random() % descriptor.size()] = static_cast<std::uint8_t>(random());
    }
    const auto reports = parse_hid_descriptor(descriptor);
    const auto layout = reports ? wheel_layout(*reports) : std::nullopt;
    if (!layout) {
      continue;
    }
    understood += 1;
    WheelState state;
    take_wheel_report(*layout, Packet(random() % 30, 0x01), state);
    EXPECT_GE(state.turn, -1.0);
    EXPECT_LE(state.turn, 1.0);
    for (const WheelPacket& packet :
         {encode_wheel_effect(*layout, 3, 0.05), encode_wheel_torque(*layout, 3, 1.0),
          encode_wheel_start(*layout, 3), encode_wheel_stop(*layout, 3),
          encode_wheel_enable(*layout), encode_wheel_reset(*layout), encode_wheel_gain(*layout),
          encode_wheel_create(*layout)}) {
      EXPECT_LE(packet.size, kLargestWheelReport);
    }
  }
  EXPECT_GT(understood, 2000);
}

}  // namespace
}  // namespace torsion::engine
