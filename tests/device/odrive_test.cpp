#include "device/protocols/odrive.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace torsion::engine {
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

TEST(OdriveTest, AsksForErrorsAndStateInTheSameTransfer) {
  const OdriveLine line = encode_odrive_step(0, -1000.0, OdriveQuestion::kPlaceAndStatus);
  EXPECT_EQ(line.view(), "c 0 -1000.000000\nf 0\nr axis0.error\nr axis0.current_state\n");
  EXPECT_LT(line.size, line.text.size());  // the longest that is sent, and whole
}

TEST(OdriveTest, ReadsAStatusWhereverItIsCutAndOnlyAWholeOne) {
  const std::string text = "1.5 0.25\r\n2048\r\n1\r\n";
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    OdriveStream stream;
    take_odrive_bytes(stream, std::string_view(text).substr(0, cut));
    EXPECT_EQ(stream.status.has_value(), cut == text.size()) << cut;
    take_odrive_bytes(stream, std::string_view(text).substr(cut));
    ASSERT_TRUE(stream.status) << cut;
    EXPECT_EQ(stream.status->errors, kOdriveWatchdog);
    EXPECT_EQ(stream.status->state, 1U);
  }
  // What a firmware without those properties says, and an answer that was lost.
  OdriveStream stream;
  take_odrive_bytes(stream, "1.5 0.25\r\ninvalid property\r\ninvalid property\r\n");
  take_odrive_bytes(stream, "1.5 0.25\r\n8\r\n1.5 0.25\r\n0\r\n");
  EXPECT_FALSE(stream.status);
  take_odrive_bytes(stream, "8\r\n");
  ASSERT_TRUE(stream.status);
  EXPECT_EQ(stream.status->errors, 0U);
  EXPECT_EQ(stream.status->state, kOdriveClosedLoop);
}

TEST(OdriveTest, NamesErrorsAsItsMakersToolsDo) {
  EXPECT_EQ(odrive_error_text(MotorKind::kOdrive5, kOdriveWatchdog),
            "WATCHDOG_TIMER_EXPIRED; it heard nothing for 50 ms");
  EXPECT_EQ(odrive_error_text(MotorKind::kOdrive5, 0x100 | 0x40000),
            "ENCODER_FAILED, OVER_TEMP; check its encoder's cable");
  EXPECT_EQ(odrive_error_text(MotorKind::kOdrive5, 0x80000000U),
            "error 0x80000000; odrivetool says more: dump_errors(odrv0)");
  EXPECT_EQ(odrive_error_text(MotorKind::kOdrive6, 0x2000 | 0x200),
            "DC_BUS_UNDER_VOLTAGE, MOTOR_OVER_TEMP; check its power supply");
  EXPECT_EQ(odrive_error_text(MotorKind::kOdrive6, kOdrive6Watchdog),
            "WATCHDOG_TIMER_EXPIRED; it heard nothing for 50 ms");
}

TEST(OdriveTest, SpeaksTheLanguageOfTheFirmware) {
  EXPECT_FALSE(language_of({0, 5, 3}));
  EXPECT_EQ(language_of({0, 5, 4}), MotorKind::kOdrive5);
  EXPECT_EQ(language_of({0, 6, 0}), MotorKind::kOdrive6);
  EXPECT_EQ(language_of({0, 6, 11}), MotorKind::kOdrive6);
  EXPECT_FALSE(language_of({0, 4, 12}));
  EXPECT_FALSE(language_of({0, 7, 0}));
  EXPECT_FALSE(language_of({1, 6, 0}));
  EXPECT_EQ(encode_odrive_step(0, 0.05, OdriveQuestion::kState).view(),
            "c 0 0.050000\nr axis0.current_state\n");
  EXPECT_EQ(encode_odrive_step(0, 0.0, OdriveQuestion::kReason).view(),
            "c 0 0.000000\nr axis0.disarm_reason\n");
}

TEST(OdriveTest, SkipsALineThatIsTooLongAndGoesOn) {
  OdriveStream stream;
  EXPECT_FALSE(take_odrive_bytes(stream, std::string(500, '1')));
  EXPECT_FALSE(take_odrive_bytes(stream, " 2\n"));
  EXPECT_EQ(take_odrive_bytes(stream, "3 4\n")->position, 3.0);
}

}  // namespace
}  // namespace torsion::engine
