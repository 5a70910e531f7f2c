#include "device/protocols/moteus.hpp"

#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

TEST(MoteusTest, ATorqueIsAFrameOfPositionControlWithoutStiffness) {
  // By hand from can.md: mode 10; six floats from 0x20: NaN, 0, 0.5, 0, 0, 1; 0x27: 0.125; 0x2B: 0;
  // then the questions. 48 bytes, which is a length that CAN FD has.
  EXPECT_EQ(encode_moteus_step(0.5, 1.0, 0.125).view(),
            "can send 8001 01000A"
            "0C06200000C07F000000000000003F00000000000000000000803F"
            "0D270000003E0D2B0000000011001E01110F\n");
  EXPECT_EQ(encode_moteus_stop().view(), "can send 8001 01000011001E01110F505050\n");
}

TEST(MoteusTest, SendsNoMoreThanTheLargestAndNoneThatIsNotANumber) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(encode_moteus_step(7.0, 1.0, 0.1).view(), encode_moteus_step(1.0, 1.0, 0.1).view());
  EXPECT_EQ(encode_moteus_step(none, 1.0, 0.1).view(), encode_moteus_step(0.0, 1.0, 0.1).view());
}

TEST(MoteusTest, ReadsModePlaceAndFault) {
  const auto reply = decode_moteus_reply("rcv 100 21000A2E010000003E000080BF210F00505050 E B F");
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->mode, 10);
  EXPECT_EQ(reply->position, 0.125);
  EXPECT_EQ(reply->velocity, -1.0);
  EXPECT_EQ(reply->fault, 0);
  EXPECT_EQ(decode_moteus_reply("rcv 100 2100012E010000003E000080BF210F27")->fault, 39);
  EXPECT_EQ(decode_moteus_register_map("rcv 100 29820205000000"), 5U);
  EXPECT_FALSE(decode_moteus_register_map("rcv 100 29820305000000"));  // another register
}

TEST(MoteusTest, RefusesAnythingElse) {
  const std::string whole = "rcv 100 21000A2E010000003E000080BF210F00";
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto cut = decode_moteus_reply(std::string_view(whole).substr(0, size));
    // The pieces before the fault are whole by themselves.
    EXPECT_EQ(cut.has_value(), size == whole.size() - 6) << size;
  }
  for (const char* line : {"", "OK", "ERR", "rcv", "rcv 100", "rcv 100 ", "rcv 100 zz",
                           "rcv 100 21000A", "rcv 100 3001", "rcv 100 21000A2E010000C07F000080BF",
                           "snd 100 21000A2E010000003E000080BF"}) {
    EXPECT_FALSE(decode_moteus_reply(line)) << line;
  }
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::string noise = "rcv 100 ";
    for (auto length = random() % 60; length > 0; --length) {
      noise += "0123456789ABCDEFxyz "[random() % 20];
    }
    static_cast<void>(decode_moteus_reply(noise));
    static_cast<void>(decode_moteus_register_map(noise));
  }
}

TEST(MoteusTest, PutsLinesTogetherWhereverTheyAreCutAndSkipsOneThatIsTooLong) {
  const std::string text = "OK\r\nrcv 100 2100\r\n";
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    MoteusStream stream;
    std::string lines;
    const auto take = [&](std::string_view line) {
      lines += std::string(line) + "|";
    };
    take_moteus_bytes(stream, std::string(500, 'x') + "\n", take);
    take_moteus_bytes(stream, std::string_view(text).substr(0, cut), take);
    take_moteus_bytes(stream, std::string_view(text).substr(cut), take);
    EXPECT_EQ(lines, "OK|rcv 100 2100|") << cut;
  }
}

TEST(MoteusTest, NamesFaultsWithWhatToDo) {
  EXPECT_EQ(moteus_fault_text(38), "over temperature; let it cool down");
  EXPECT_EQ(moteus_fault_text(99), "fault 99; tview says more");
  EXPECT_EQ(moteus_fault_text(kMoteusUnfed), "it heard nothing for 50 ms");
}

}  // namespace
}  // namespace torsion::engine
