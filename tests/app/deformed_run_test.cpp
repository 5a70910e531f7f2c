// A run at some of its moments: also where a recording switches models on the way.

#include <algorithm>

#include <gtest/gtest.h>

#include "app/deformed_scene.hpp"
#include "device/scripted_motion.hpp"
#include "tests/support/paths.hpp"

namespace torsion::engine {
namespace {

constexpr std::uint64_t kSteps = 1500;  // the ball is pressed in

Session session_with(BodyModel body) {
  PrepareOptions options;
  options.contact_model = ContactModel::kPatch;
  options.body_model = body;
  auto opened = open_session(test::shipped_scene("ball_on_cube_soft"), options, true);
  EXPECT_TRUE(opened.ok());
  return std::move(opened).value();
}

/// Where the first body's vertices are, less where they are at rest.
const std::vector<glm::vec3>& last_shifts(const DeformedRun& run) {
  return run.meshes().at(0).targets.back().positions;
}

TEST(DeformedRunTest, KeepsTheShapesOfTheModelsThatItIsSwitchedTo) {
  const std::vector<BodyModel> all = {BodyModel::kNone, BodyModel::kSkeleton,
                                      BodyModel::kCompliance};
  for (const BodyModel before : all) {
    Session session = session_with(before);
    DeformedRun run(session);
    step_scripted(session);
    run.add(session, 0.0);
    for (const BodyModel after : all) {
      Session other = session_with(after);
      for (std::uint64_t i = 0; i < kSteps; ++i) {
        step_scripted(other);
      }
      DeformedRun wanted(other);
      wanted.add(other, 0.0);
      session.simulation = std::move(other.simulation);  // as a recording that is replayed does
      run.add(session, 1.0);
      EXPECT_TRUE(last_shifts(run) == last_shifts(wanted))
          << static_cast<int>(before) << " to " << static_cast<int>(after);
      EXPECT_TRUE(std::ranges::any_of(
          last_shifts(run), [](const glm::vec3& shift) { return shift != glm::vec3(0.0F); }));
    }
  }
}

}  // namespace
}  // namespace torsion::engine
