#include "device/protocols/space_mouse.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/device/space_mouse_descriptor.hpp"

namespace torsion::engine {
namespace {

SpaceMouseLayout described() {
  return space_mouse_layout(*parse_hid_descriptor(test::kSpaceMouseDescriptor)).value();
}

/// Report 1 or 2 with three axes.
std::array<std::uint8_t, 7> axes(std::uint8_t id, std::int16_t x, std::int16_t y, std::int16_t z) {
  std::array<std::uint8_t, 7> report{id};
  put_int16(report, 1, x);
  put_int16(report, 3, y);
  put_int16(report, 5, z);
  return report;
}

TEST(SpaceMouseTest, TurnsDeflectionIntoSharesWithYUp) {
  for (const SpaceMouseLayout& layout : {described(), usual_space_mouse_layout()}) {
    SpaceMouseState state;
    ASSERT_TRUE(take_space_mouse_report(layout, axes(1, 350, 175, -70), state));
    EXPECT_EQ(state.translation, glm::dvec3(1.0, 0.2, 0.5));  // right, up, towards the user
    EXPECT_EQ(state.rotation, glm::dvec3(0.0));
    ASSERT_TRUE(take_space_mouse_report(layout, axes(2, -35, 0, 35), state));
    EXPECT_EQ(state.translation, glm::dvec3(1.0, 0.2, 0.5));  // stays
    EXPECT_EQ(state.rotation, glm::dvec3(-0.1, -0.1, 0.0));
  }
}

TEST(SpaceMouseTest, KeepsTheHandOfItsFrame) {
  // x cross y is z in what comes out when it is in the device's axes.
  const SpaceMouseLayout layout = usual_space_mouse_layout();
  const auto turned = [&](std::int16_t x, std::int16_t y, std::int16_t z) {
    SpaceMouseState state;
    take_space_mouse_report(layout, axes(1, x, y, z), state);
    return state.translation;
  };
  EXPECT_EQ(glm::cross(turned(350, 0, 0), turned(0, 350, 0)), turned(0, 0, 350));
}

TEST(SpaceMouseTest, TakesBothFromOneLongReport) {
  const SpaceMouseLayout layout = usual_space_mouse_layout();
  std::array<std::uint8_t, 13> report{1};
  for (std::size_t axis = 0; axis < 6; ++axis) {
    put_int16(report, 1 + 2 * axis, static_cast<std::int16_t>(35 * (axis + 1)));
  }
  SpaceMouseState state;
  ASSERT_TRUE(take_space_mouse_report(layout, report, state));
  EXPECT_LT(glm::distance(state.translation, glm::dvec3(0.1, -0.3, 0.2)), 1e-12);
  EXPECT_LT(glm::distance(state.rotation, glm::dvec3(0.4, -0.6, 0.5)), 1e-12);
}

TEST(SpaceMouseTest, ClampsWhatIsBeyondFullDeflection) {
  SpaceMouseState state;
  take_space_mouse_report(usual_space_mouse_layout(), axes(1, 32767, -32768, 0), state);
  EXPECT_EQ(state.translation, glm::dvec3(1.0, 0.0, -1.0));
}

TEST(SpaceMouseTest, HoldsButtonsUntilTheyAreLetGo) {
  SpaceMouseState state;
  const SpaceMouseLayout layout = described();
  ASSERT_EQ(layout.button_count, 2U);
  ASSERT_TRUE(take_space_mouse_report(layout, std::array<std::uint8_t, 3>{3, 2, 0}, state));
  EXPECT_EQ(state.buttons, 2U);
  take_space_mouse_report(layout, axes(1, 0, 0, 0), state);
  EXPECT_EQ(state.buttons, 2U);
  take_space_mouse_report(layout, std::array<std::uint8_t, 3>{3, 0, 0}, state);
  EXPECT_EQ(state.buttons, 0U);
}

TEST(SpaceMouseTest, IgnoresReportsThatAreCutOff) {
  for (const SpaceMouseLayout& layout : {described(), usual_space_mouse_layout()}) {
    SpaceMouseState state;
    for (std::size_t size = 1; size < 7; ++size) {
      EXPECT_FALSE(take_space_mouse_report(layout, Bytes(axes(1, 9, 9, 9)).first(size), state));
      EXPECT_EQ(state.translation, glm::dvec3(0.0));
    }
  }
}

TEST(SpaceMouseTest, IgnoresReportsItDoesNotKnow) {
  SpaceMouseState state;
  state.buttons = 1;
  for (const SpaceMouseLayout& layout : {described(), usual_space_mouse_layout()}) {
    EXPECT_FALSE(take_space_mouse_report(layout, std::array<std::uint8_t, 2>{23, 90}, state));
    EXPECT_FALSE(take_space_mouse_report(layout, std::array<std::uint8_t, 1>{1}, state));
    EXPECT_FALSE(take_space_mouse_report(layout, {}, state));
    EXPECT_EQ(state.buttons, 1U);
  }
}

TEST(SpaceMouseTest, HasNoLayoutForAMouse) {
  // generic desktop, mouse, application collection; X and Y
  const std::array<std::uint8_t, 19> mouse = {0x05, 0x01, 0x09, 0x02, 0xA1, 0x01, 0x09,
                                              0x30, 0x09, 0x31, 0x15, 0x81, 0x75, 0x08,
                                              0x95, 0x02, 0x81, 0x06, 0xC0};
  const auto reports = parse_hid_descriptor(mouse);
  ASSERT_TRUE(reports);
  EXPECT_FALSE(space_mouse_layout(*reports));
}

TEST(SpaceMouseTest, KnowsTheFamilyAndWhatIsNotOfIt) {
  EXPECT_TRUE(is_space_mouse(0x046D, 0xC626));   // SpaceNavigator
  EXPECT_TRUE(is_space_mouse(0x256F, 0xC635));   // Compact
  EXPECT_FALSE(is_space_mouse(0x046D, 0xC635));  // Compact's id under another vendor
  EXPECT_FALSE(is_space_mouse(0x256F, 0xC650));  // CadMouse
  EXPECT_TRUE(is_not_a_space_mouse(0x256F, 0xC650));
  EXPECT_FALSE(is_not_a_space_mouse(0x256F, 0xC6FF));  // unknown: its descriptor decides
}

TEST(SpaceMouseTest, TheOldestHaveYUp) {
  SpaceMouseLayout layout = usual_space_mouse_layout();
  layout.oldest_axes = has_oldest_axes(0x046D, 0xC603);
  EXPECT_FALSE(has_oldest_axes(0x046D, 0xC626));
  SpaceMouseState state;
  // Twice: what a report leaves alone stays as it was.
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(take_space_mouse_report(
        layout, std::array<std::uint8_t, 7>{1, 35, 0, 70, 0, 105, 0}, state));
    EXPECT_NEAR(state.translation.x, 0.1, 1e-12);
    EXPECT_NEAR(state.translation.y, 0.2, 1e-12);
    EXPECT_NEAR(state.translation.z, -0.3, 1e-12);
    ASSERT_TRUE(
        take_space_mouse_report(layout, std::array<std::uint8_t, 7>{2, 0, 0, 0, 0, 35, 0}, state));
    EXPECT_NEAR(state.rotation.z, -0.1, 1e-12);
  }
}

}  // namespace
}  // namespace torsion::engine
