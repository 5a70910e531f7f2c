#include "device/protocols/odrive.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace torsion {
namespace {

TEST(OdriveTest, SendsTorqueAndAsksForPositionAtOnce) {
  EXPECT_EQ(encode_odrive_step(0, 0.05).view(), "c 0 0.050000\nf 0\n");
  EXPECT_EQ(encode_odrive_step(1, -1.25).view(), "c 1 -1.250000\nf 1\n");
}

TEST(OdriveTest, SendsNoTorqueThatIsNotANumberAndNoneThatIsBeyondAnyMotor) {
  EXPECT_EQ(encode_odrive_step(0, std::numeric_limits<double>::quiet_NaN()).view(),
            "c 0 0.000000\nf 0\n");
  EXPECT_EQ(encode_odrive_step(0, std::numeric_limits<double>::infinity()).view(),
            "c 0 0.000000\nf 0\n");
  EXPECT_EQ(encode_odrive_step(0, 1e300).view(), "c 0 1000.000000\nf 0\n");
}

TEST(OdriveTest, ReadsTurnsAndTurnsPerSecond) {
  const auto feedback = decode_odrive_feedback("-0.250000 3.5\r");
  ASSERT_TRUE(feedback);
  EXPECT_EQ(feedback->position, -0.25);
  EXPECT_EQ(feedback->velocity, 3.5);
}

TEST(OdriveTest, RefusesAnythingElse) {
  for (const char* line : {"", "1.0", "1.0 x", "1.0 2.0 3.0", "nan 1.0", "1.0 inf",
                           "unknown command", "invalid motor 0"}) {
    EXPECT_FALSE(decode_odrive_feedback(line)) << line;
  }
}

TEST(OdriveTest, PutsLinesTogetherWhereverTheyAreCut) {
  const std::string text = "1.5 0.25\r\n";
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    OdriveStream stream;
    const auto first = take_odrive_bytes(stream, std::string_view(text).substr(0, cut));
    const auto second = take_odrive_bytes(stream, std::string_view(text).substr(cut));
    ASSERT_NE(first.has_value(), second.has_value()) << cut;
    EXPECT_EQ((first ? first : second)->position, 1.5);
  }
}

TEST(OdriveTest, SkipsALineThatIsTooLongAndGoesOn) {
  OdriveStream stream;
  EXPECT_FALSE(take_odrive_bytes(stream, std::string(500, '1')));
  EXPECT_FALSE(take_odrive_bytes(stream, " 2\n"));
  EXPECT_EQ(take_odrive_bytes(stream, "3 4\n")->position, 3.0);
}

}  // namespace
}  // namespace torsion
