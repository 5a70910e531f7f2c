#pragma once

#include <vector>

#include "ecs/scene_description.hpp"
#include "systems/step.hpp"

namespace torsion::engine::test {

// Scenes made in memory for tests of the step, so that a test shows all that it depends on.

/// A closed tessellation of `kind` with the given half extents (axis of cylinder and capsule along
/// y), outward faces.
/// @param fineness  faces along a quarter turn
SurfaceMesh tessellate(ShapeKind kind, const glm::dvec3& half_extent, std::uint32_t fineness = 12);

/// One part: an exact shape, or its tessellation as a mesh.
PartDescription make_part(ShapeKind kind, const glm::dvec3& half_extent, const Pose& pose = {},
                          bool as_mesh = false, std::uint32_t fineness = 12);

/// A tool of mass 1 kg with its mass centre at the origin of its frame.
ToolDescription make_tool(std::vector<PartDescription> parts);

/// A body held at the centre of its lowest face, with the paper's material and models.
BodyDescription make_body(std::vector<PartDescription> parts);

/// The paper's first experiment: a ball of radius 0.05 m over a cube of side 0.1 m whose top face
/// is y = 0.1 m.
SceneDescription ball_on_cube();

/// Holds the poses of a simulation's tools and steps it. Poses are those of the tool frames in the
/// world.
class Hand {
 public:
  /// @pre the scene prepares without an error
  explicit Hand(const SceneDescription& scene, const PrepareOptions& options = {});

  /// One step with these poses.
  void step_to(const std::vector<Pose>& poses);

  /// `steps` equal steps from the present pose of tool 0: shift [m] and turn about a world axis
  /// through its frame's origin [rad], in all.
  void move(const glm::dvec3& shift, const glm::dvec3& turn_axis, double turn, int steps);

  [[nodiscard]] const World& world() const { return simulation_.world; }
  [[nodiscard]] Simulation& simulation() { return simulation_; }
  [[nodiscard]] const Wrench& wrench(std::uint32_t tool = 0) const {
    return simulation_.world.state.tools.at<ToolWrench>(tool).total;
  }
  [[nodiscard]] const Clock& clock() const { return simulation_.world.state.clock; }
  std::vector<Pose> poses;

 private:
  Simulation simulation_;
};

}  // namespace torsion::engine::test
