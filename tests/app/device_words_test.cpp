// What is said of a device, in the words that a person has to act on.

#include "app/live/device_words.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

DeviceView live_view(std::uint8_t actuated) {
  DeviceView view;
  view.sample.state = DeviceState::kLive;
  view.sample.sensed = kTranslationAxes;
  view.sample.actuated = actuated;
  view.sample.rate = 998.0;
  view.coupling = {450.0, 0.0, 0.5, 0.0, 3.0, 0.1};
  view.outcome.holds = true;
  view.guard = GuardState::kLive;
  view.reason = GuardReason::kNone;
  view.signs = SignVerdict::kRight;
  return view;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(DeviceWordsTest, TorqueThatIsNotDisplayedIsSaidAndTorqueThatIsNot) {
  EXPECT_TRUE(has(not_displayed(live_view(kTranslationAxes)), "torque is only drawn"));
  EXPECT_TRUE(has(not_displayed(live_view(kNoAxes)), "Force and torque are only drawn"));
  EXPECT_TRUE(has(not_displayed(live_view(kTurnAxis)), "force is only drawn"));
  EXPECT_TRUE(has(not_displayed(live_view(kTranslationAxes | kTurnAxis)), "turn axis"));
  EXPECT_EQ(not_displayed(live_view(kTranslationAxes | kRotationAxes)), "");
}

TEST(DeviceWordsTest, GainsAndRateAreStated) {
  std::string all;
  for (const std::string& line : device_lines(live_view(kTranslationAxes))) {
    all += line + "\n";
  }
  EXPECT_TRUE(has(all, "998 Hz")) << all;
  EXPECT_TRUE(has(all, "450 N/m (cautious")) << all;
  EXPECT_TRUE(has(all, "up to 3 N")) << all;
  EXPECT_TRUE(has(all, "0.5 N m/rad (cautious")) << all;
  EXPECT_TRUE(has(all, "up to 0.1 N m")) << all;
}

TEST(DeviceWordsTest, HowTheToolIsHeldIsStatedAndWhatSetItsStiffness) {
  DeviceView view = live_view(kTranslationAxes);
  view.sample.traits.damping = 0.25;  // 450 N/m at 1 kHz
  EXPECT_TRUE(has(describe(view), "450 N/m (0.9 b / (T / 2 + t_d), so that it stays passive)"));
  view.hold = ToolHold::kMass;
  EXPECT_TRUE(has(describe(view), "the tool has its mass")) << describe(view);
  view.hold = ToolHold::kDirect;
  EXPECT_TRUE(has(describe(view), "held directly")) << describe(view);
  EXPECT_TRUE(has(describe(view), "stiffer than 450 N/m may shake")) << describe(view);
}

TEST(DeviceWordsTest, ABannerWhereThereIsNoForceAndNoneWhereAllIsWell) {
  constexpr bool kStepsGoOn = true;
  DeviceView view = live_view(kTranslationAxes);
  EXPECT_EQ(device_banner(view, kStepsGoOn).text, "");
  EXPECT_TRUE(has(device_banner(view, !kStepsGoOn).text, "No force in a pause"));
  view.outcome.holds = false;
  view.guard = GuardState::kWaiting;
  view.reason = GuardReason::kFar;
  view.outcome.distance = 0.023;
  EXPECT_TRUE(has(device_banner(view, kStepsGoOn).text, "23 mm to go"));
  EXPECT_FALSE(device_banner(view, kStepsGoOn).failed);
  view.sample.trouble = DeviceTrouble::kNoAccess;
  view.sample.state = DeviceState::kStarting;
  EXPECT_TRUE(device_banner(view, kStepsGoOn).failed);
  view.sample.trouble = DeviceTrouble::kNone;
  view.sample.state = DeviceState::kAbsent;
  EXPECT_FALSE(device_banner(view, kStepsGoOn).failed);  // there never was one
  view.losses = 1;
  EXPECT_TRUE(device_banner(view, kStepsGoOn).failed);
  EXPECT_TRUE(has(device_banner(view, kStepsGoOn).text, "gone"));
}

TEST(DeviceWordsTest, WhatTakesAForceAwayIsSaidWithWhatToDo) {
  DeviceView view = live_view(kTranslationAxes);
  view.guard = GuardState::kChecking;
  EXPECT_TRUE(has(device_banner(view, true).text, "goes where it is pushed"));
  view.guard = GuardState::kOff;
  view.reason = GuardReason::kReversed;
  view.reversed_axes = 1U << 2U | 1U << 4U;
  EXPECT_TRUE(device_banner(view, true).failed);
  const std::string reversed = device_banner(view, true).text;
  EXPECT_TRUE(has(reversed, "(z, turning about y)") && has(reversed, "plug it in again"))
      << reversed;
  EXPECT_TRUE(has(describe(view), "Mend the signs of its motors or encoders"));
  view.reason = GuardReason::kRanAway;
  EXPECT_TRUE(has(device_banner(view, true).text, "hold it firmly"));
  view.guard = GuardState::kWaiting;
  view.reason = GuardReason::kLetGo;
  EXPECT_TRUE(has(device_banner(view, true).text, "hold the button"));
  view.reason = GuardReason::kFar;
  view.stopped_by = GuardReason::kTooFast;
  EXPECT_TRUE(has(device_banner(view, true).text, "1.2 m/s")) << device_banner(view, true).text;
  view.guard = GuardState::kLive;
  view.stopped_by = GuardReason::kNone;
  view.is_warm = true;
  EXPECT_TRUE(has(device_banner(view, true).text, "warm"));
  view.is_warm = false;
  view.signs = SignVerdict::kUnresolved;
  EXPECT_TRUE(has(describe(view), "could not be seen"));
}

TEST(DeviceWordsTest, AMotorsErrorIsNamedWithWhatToDoInBannerAndSummary) {
  DeviceView view = live_view(kTurnAxis);
  view.sample.state = DeviceState::kStarting;
  view.sample.trouble = DeviceTrouble::kMotorError;
  view.sample.motor_errors = 0x40000;
  const std::string expected =
      "its motor has no force (OVER_TEMP; let it cool down). Then unplug it and plug it in";
  EXPECT_TRUE(device_banner(view, true).failed);
  EXPECT_TRUE(has(device_banner(view, true).text, expected)) << device_banner(view, true).text;
  EXPECT_TRUE(has(device_summary(view), expected)) << device_summary(view);
  view.sample.motor_errors = 0x800;
  EXPECT_TRUE(has(device_banner(view, true).text, "It is set up anew"));
}

}  // namespace
}  // namespace torsion::engine
