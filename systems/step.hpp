#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ecs/result.hpp"
#include "ecs/scene_description.hpp"
#include "ecs/schedule.hpp"
#include "ecs/snapshot.hpp"
#include "ecs/world.hpp"
#include "systems/contact/step_context.hpp"
#include "systems/model/options.hpp"

namespace torsion::engine {

struct Scratch;         // systems/scratch.hpp: memory of the systems of one step
struct MdrTables;       // systems/mdr/places.hpp
struct SnapshotTables;  // systems/surface/take_snapshot.hpp
struct PreparedWorld;   // systems/model/prepare.hpp

/// The systems of one step in the order of the paper's Fig. 4.
std::vector<System<StepContext>> step_systems();

/// A scene at work, with what its steps need.
struct Simulation {
  Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  World world;
  std::unique_ptr<Scratch> scratch;
  std::unique_ptr<const SnapshotTables> snapshot_tables;  // null: no snapshots
  std::vector<ModelChoice> choices;                       // (bodies)
  std::vector<std::string> united_nodes;  // whose meshes overlap and count as one solid
};

/// What prepare_world (systems/model/prepare.hpp) makes of a scene, ready to step. Fails as that
/// does.
Result<Simulation> prepare(const SceneDescription& scene, const PrepareOptions& options);

/// A simulation of other materials than those prepared (world_of_materials), for runs that nobody
/// draws: it has no snapshot tables.
/// @param tables  contact model mdr's, which are the same for all scenes
Simulation simulation_of_materials(const PreparedWorld& unit, const SceneDescription& scene,
                                   const MdrTables& tables);

/// One step of Model::dt: reads one pose a tool (that of the time Clock::step * dt). Never throws,
/// never allocates; what went wrong is in Clock::faults. Different states, each with a scratch of
/// its own, may step in different threads.
/// @pre tool_poses.size() == tools; scratch.reserve() was called
void step(const Model& model, State& state, std::span<const Pose> tool_poses, Scratch& scratch);

void step(Simulation& simulation, std::span<const Pose> tool_poses);

/// What the last step has left, for those who draw it. Allocates nothing.
/// @pre snapshot.reserve was called with the simulation's model and state
void take_snapshot(const Simulation& simulation, Snapshot& snapshot);

}  // namespace torsion::engine
