#pragma once

#include <vector>

#include "app/session.hpp"
#include "ecs/frame_world.hpp"
#include "ecs/snapshot.hpp"
#include "render/arrows.hpp"
#include "scenes/write_gltf.hpp"

namespace torsion::engine {

/// The bodies as they are deformed after the last step, and the tools where they are.
std::vector<WrittenMesh> deformed_scene(const Session& session);

/// A run at some of its moments, for a file of it.
class DeformedRun {
 public:
  /// @param session  at its start, or anywhere: bodies are at rest in what is kept
  explicit DeformedRun(const Session& session);

  /// Keeps the state after the last step. The session may have other models than at its start.
  void add(const Session& session, double time);

  [[nodiscard]] const std::vector<AnimatedMesh>& meshes() const { return meshes_; }
  [[nodiscard]] const std::vector<float>& times() const { return times_; }
  /// What a tool feels at one of the times, and where its mass centre is.
  struct Felt {
    Wrench wrench;           // on the tool about the centre, world
    glm::dvec3 center{0.0};  // m, world
  };
  /// What the longest arrows have to stand for.
  [[nodiscard]] const ArrowLimits& limits() const { return limits_; }
  /// (times) of (tools)
  [[nodiscard]] const std::vector<std::vector<Felt>>& felt() const { return felt_; }

 private:
  FrameWorld frame_;
  std::vector<BodyModel> frame_models_;  // (bodies): what the frame was prepared for
  Snapshot snapshot_;
  std::vector<AnimatedMesh> meshes_;  // bodies, then tools
  std::vector<float> times_;          // s
  std::vector<std::vector<Felt>> felt_;
  ArrowLimits limits_;
};

}  // namespace torsion::engine
