// No vertex of a body turns farther about a contact's normal than the tools have turned since they
// touched it, with any models: what is drawn is no more than what is.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "app/session.hpp"
#include "ecs/model_names.hpp"
#include "systems/surface/surface_field.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/studies.hpp"

namespace torsion::engine::test {
namespace {

struct DrawnRun {
  const char* scene;
  ContactModel contact;
  BodyModel body;
};

/// How far each body's tools have turned since they touched it, the most, rad.
class TurnSinceTouch {
 public:
  TurnSinceTouch(std::size_t bodies, std::size_t tools)
      : tools_(tools),
        most_(bodies, 0.0),
        since_(bodies * tools),
        touches_(bodies * tools, false) {}
  void see(const World& world) {
    std::vector<bool> now(touches_.size(), false);
    for (const RegionIdentity& region : world.state.regions.column<RegionIdentity>()) {
      now[region.body * tools_ + region.tool] = true;
    }
    for (std::size_t pair = 0; pair < now.size(); ++pair) {
      const ToolPose& pose =
          world.state.tools.at<ToolPose>(static_cast<std::uint32_t>(pair % tools_));
      if (now[pair] && !touches_[pair]) {
        since_[pair] = pose.before.rotation;
        most_[pair / tools_] = 0.0;
      }
      if (now[pair]) {
        const glm::dquat turn = pose.now.rotation * glm::conjugate(since_[pair]);
        const double sine = glm::length(glm::dvec3(turn.x, turn.y, turn.z));
        most_[pair / tools_] =
            std::max(most_[pair / tools_], 2.0 * std::atan2(sine, std::abs(turn.w)));
      }
    }
    touches_ = now;
  }
  [[nodiscard]] double most(std::uint32_t body) const { return most_[body]; }

 private:
  std::size_t tools_;
  std::vector<double> most_;
  std::vector<glm::dquat> since_;
  std::vector<bool> touches_;
};

class DrawnTurnTest : public testing::TestWithParam<DrawnRun> {};

TEST_P(DrawnTurnTest, NoVertexTurnsFartherThanTheTools) {
  const DrawnRun& run = GetParam();
  // Each contact model once a scene, patch with the body model that moves the most, if that is
  // quick.
  const bool patch = run.contact == ContactModel::kPatch;
  const std::string_view scene = run.scene;
  const bool is_large = scene.find("many_regions") != scene.npos ||
                        scene.find("two_bodies") != scene.npos ||
                        scene.find("compass") != scene.npos;
  if (test::is_left_out(patch == (run.body == BodyModel::kCompliance) && !(patch && is_large))) {
    GTEST_SKIP() << test::kLeftOut;
  }
  PrepareOptions options;
  options.contact_model = run.contact;
  options.body_model = run.body;
  Result<Session> opened = open_session(source_folder() + "/" + run.scene, options, true);
  ASSERT_TRUE(opened) << opened.error().text;
  Session& session = opened.value();
  const World& world = session.simulation.world;
  FrameWorld frame = prepare_frame(session.scene, world.model, world.state);
  Snapshot snapshot;
  snapshot.reserve(world.model, world.state);
  TurnSinceTouch turn(frame.bodies.size(), world.model.tools.size());
  // What pressing alone turns of a body with an end, beside its planes of symmetry.
  const double by_pressing = run.body == BodyModel::kCompliance ? glm::radians(1.0) : 0.0;
  const std::uint64_t steps = steps_in(session, session.scene.duration);
  for (std::uint64_t step = 1; step <= steps; ++step) {
    step_scripted(session);
    turn.see(world);
    if (step % 50 != 0) {
      continue;
    }
    take_snapshot(session.simulation, snapshot);
    surface_field(world.model, snapshot, frame);
    for (std::uint32_t body = 0; body < frame.bodies.size(); ++body) {
      std::vector<glm::vec4> positions(frame.bodies.at<DrawRange>(body).vertices.count);
      deform_vertices(frame, body, positions);
      double farthest = 0.0;
      for (const glm::vec4& position : positions) {
        ASSERT_TRUE(std::isfinite(position.w)) << "body " << body << ", step " << step;
        farthest = std::max(farthest, std::abs(static_cast<double>(position.w)));
      }
      // Some regions' fields overlap: 2 % of the turn.
      EXPECT_LE(farthest, 1.02 * turn.most(body) + by_pressing + 1e-3)
          << "body " << body << ", step " << step;
    }
  }
}

std::vector<DrawnRun> drawn_runs() {
  constexpr std::array kScenes = {
      "scenes/ball_on_cube_soft.gltf",
      "scenes/compass_on_ellipsoid_soft.gltf",
      "scenes/mallet_on_ellipsoid_soft.gltf",
      "scenes/many_regions.gltf",
      "scenes/two_bodies.gltf",
      "scenes/blender/knob_on_pad.glb",
      "tests/cases/driver2.glb",
      "tests/cases/s2_plate.gltf",
  };
  std::vector<DrawnRun> runs;
  for (const char* const scene : kScenes) {
    for (const ContactModel contact :
         {ContactModel::kPaper, ContactModel::kMdr, ContactModel::kPatch}) {
      const BodyModel other =
          contact == ContactModel::kPaper ? BodyModel::kSkeleton : BodyModel::kNone;
      runs.push_back({scene, contact, other});
      runs.push_back({scene, contact, BodyModel::kCompliance});
    }
  }
  return runs;
}

std::string drawn_name(const testing::TestParamInfo<DrawnRun>& run) {
  std::string name = std::string(run.param.scene) + "_" + std::string(name_of(run.param.contact)) +
                     "_" + std::string(name_of(run.param.body));
  std::ranges::replace_if(
      name, [](unsigned char letter) { return std::isalnum(letter) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, DrawnTurnTest, testing::ValuesIn(drawn_runs()), drawn_name);

}  // namespace
}  // namespace torsion::engine::test
