// Every scene that ships loads without a problem, is prepared, and steps.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "device/scripted_motion.hpp"
#include "scenes/load_gltf.hpp"
#include "systems/math/frames.hpp"
#include "systems/step.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/test_cache.hpp"

namespace torsion::engine::test {
namespace {

/// Paths below scenes/, those exported from Blender included.
std::vector<std::string> shipped_scenes() {
  const std::filesystem::path folder = std::filesystem::path(source_folder()) / "scenes";
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".gltf" || extension == ".glb") {
      names.push_back(entry.path().lexically_relative(folder).string());
    }
  }
  std::ranges::sort(names);
  return names;
}

std::string test_name(const testing::TestParamInfo<std::string>& scene) {
  std::string name = scene.param.substr(0, scene.param.find('.'));
  std::ranges::replace(name, '/', '_');
  return name;
}

TEST(ShippedScenesTest, AllThatTheDesignNamesAreThere) {
  const std::vector<std::string> names = shipped_scenes();
  for (const char* name :
       {"ball_on_cube.gltf", "ball_on_cube_soft.gltf", "ball_on_cube_sticky.gltf",
        "compass_on_ellipsoid.gltf", "compass_on_ellipsoid_soft.gltf", "many_regions.gltf",
        "mallet_on_ellipsoid.gltf", "mallet_on_ellipsoid_soft.gltf", "two_bodies.gltf",
        "blender/knob_on_pad.glb"}) {
    EXPECT_TRUE(std::ranges::find(names, name) != names.end()) << name;
  }
}

class ShippedSceneTest : public testing::TestWithParam<std::string> {};

TEST_P(ShippedSceneTest, LoadsPreparesAndSteps) {
  const auto path = std::filesystem::path(source_folder()) / "scenes" / GetParam();
  const LoadedScene loaded = load_gltf(path);
  ASSERT_TRUE(loaded.scene.has_value()) << to_text(loaded.problems);
  EXPECT_GT(loaded.scene->duration, 0.0);
  PrepareOptions options;
  options.use_cache = has_test_cache();
#ifdef TORSION_SANITIZED
  // One body's finite elements will do, the smallest: those of all took as long as all other
  // sanitized tests.
  if (GetParam() != "compass_on_ellipsoid.gltf") {
    options.body_model = BodyModel::kNone;
  }
#endif
  Result<Simulation> prepared = prepare(*loaded.scene, options);
  ASSERT_TRUE(prepared.ok()) << prepared.error().text;
  Simulation& simulation = prepared.value();
  std::vector<Pose> poses(loaded.scene->tools.size());
  for (int i = 0; i < 10; ++i) {
    for (std::size_t tool = 0; tool < poses.size(); ++tool) {
      poses[tool] = scripted_pose(loaded.scene->tools[tool].script, 1e-3 * i);
    }
    step(simulation, poses);
  }
  const Clock& clock = simulation.world.state.clock;
  EXPECT_EQ(clock.step, 10U);
  EXPECT_EQ(clock.faults_ever, 0U);
}

/// A shipped scene on a body without a body model.
struct HalfSpaceScene {
  std::optional<SceneDescription> scene;
  std::optional<Simulation> simulation;
};

/// Nothing where it does not load or prepare, which is a failure.
HalfSpaceScene on_half_space(const std::string& name, ContactModel contact) {
  const LoadedScene loaded =
      load_gltf(std::filesystem::path(source_folder()) / "scenes" / (name + ".gltf"));
  HalfSpaceScene made;
  if (!loaded.scene) {
    ADD_FAILURE() << to_text(loaded.problems);
    return made;
  }
  PrepareOptions options;
  options.contact_model = contact;
  options.body_model = BodyModel::kNone;
  Result<Simulation> prepared = prepare(*loaded.scene, options);
  if (!prepared.ok()) {
    ADD_FAILURE() << prepared.error().text;
    return made;
  }
  made.scene = loaded.scene;
  made.simulation.emplace(std::move(prepared.value()));
  return made;
}

TEST(ShippedScenesTest, AMalletThatJustTouchesHasOneContact) {
  // Two samples of its head that are no neighbours come into contact one after the other, 4.7 mm
  // apart: each stood for a contact of its own, with the whole force twice.
  HalfSpaceScene made = on_half_space("mallet_on_ellipsoid", ContactModel::kMdr);
  ASSERT_TRUE(made.simulation.has_value());
  Simulation& simulation = *made.simulation;
  const World& world = simulation.world;
  double before = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double depth = 5e-7 * (i + 0.5) - 1e-5;  // m: of its lowest point
    const std::array<Pose, 1> poses = {{{{0.0, 0.1 - depth, 0.0}, {1.0, 0.0, 0.0, 0.0}}}};
    step(simulation, poses);
    ASSERT_EQ(world.state.regions.size(), depth > 0.0 ? 1U : 0U) << depth << " m deep";
    const double force = world.state.tools.at<ToolWrench>(0).total.force.y;
    EXPECT_GE(force, before);
    before = force;
  }
  EXPECT_GT(before, 1.0);
}

TEST(ShippedScenesTest, ANewGridHoldsALopsidedContactAroundItsMiddle) {
  // The compass's tips are faceted and lean: the overlap's middle, by depth, is not half-way
  // between its ends, and a grid as wide as the overlap would cut one off.
  HalfSpaceScene made = on_half_space("compass_on_ellipsoid", ContactModel::kPatch);
  ASSERT_TRUE(made.simulation.has_value());
  Simulation& simulation = *made.simulation;
  const World& world = simulation.world;
  const Clock& clock = world.state.clock;
  std::uint32_t region = 0;
  const auto is_loaded = [&world](std::uint32_t row) {
    return world.state.regions.at<RegionNormal>(row).force > 0.0;
  };
  for (region = 0; clock.time < 1.0; region = 0) {
    const std::array<Pose, 1> poses = {scripted_pose(made.scene->tools[0].script, clock.time)};
    step(simulation, poses);
    while (region < world.state.regions.size() && !is_loaded(region)) {
      ++region;
    }
    if (region < world.state.regions.size()) {
      break;
    }
  }
  ASSERT_LT(region, world.state.regions.size());
  const std::uint32_t side = world.model.settings.grid_side;
  const auto cells =
      world.state.cells.rows<CellGeometry>(world.state.regions.at<RegionIdentity>(region).cells);
  const RegionFrame& frame = world.state.regions.at<RegionFrame>(region);
  glm::dvec2 middle(0.0);
  double sum = 0.0;
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      const CellGeometry& cell = cells[j * side + i];
      if (i <= 1 || i + 1 == side || j == 0 || j + 1 == side) {  // the first column is spare
        EXPECT_LT(cell.coverage, 1.0) << i << " " << j;
      }
      const double weight = cell.coverage * std::max(cell.depth, 0.0);
      middle += weight * cell_center(frame, side, i, j);
      sum += weight;
    }
  }
  // In the middle of a column, between two rows; distances to a mesh say that to 1e-5.
  const glm::dvec2 off = middle / sum / frame.half_size - glm::dvec2(1.0 / side, 0.0);
  EXPECT_LT(std::max(std::abs(off.x), std::abs(off.y)), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShippedSceneTest, testing::ValuesIn(shipped_scenes()), test_name);

}  // namespace
}  // namespace torsion::engine::test
