#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ecs/result.hpp"
#include "ecs/scene_description.hpp"
#include "ecs/schedule.hpp"
#include "ecs/world.hpp"
#include "systems/model/expected_place.hpp"

namespace torsion {

struct Scratch;  // systems/scratch.hpp: memory that systems share within one step

/// What a system of the physics step may touch.
struct StepContext {
  World& world;
  std::span<const Pose> tool_poses;  // (tools) the tool frames in the world at the end of this step
  Scratch& scratch;
};

/// The systems of one step in the order of the paper's Fig. 4. What is made for those who draw is
/// made every 8 ms, or in every step where those are longer.
/// @param dt  s
std::vector<System<StepContext>> step_systems(double dt);

/// Models of one body and why these, in words that follow "contact model patch (".
struct ModelChoice {
  BodyModels models;  // never kAuto
  std::string contact_why;
  std::string body_why;
  bool body_is_auto = false;
  bool long_contact = false;  // with edges, expected: contact model patch needs more cells for it
  ExpectedPlace place;        // of its contacts
};

/// A world with the schedule that moves it and the memory that the schedule needs.
struct Simulation {
  Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  World world;
  std::unique_ptr<Scratch> scratch;
  Schedule<StepContext> schedule;
  std::vector<ModelChoice> choices;       // (bodies)
  std::vector<std::string> united_nodes;  // whose meshes overlap and count as one solid
};

/// What may be chosen for a run besides what the scene says; kAuto: as the scene says.
struct PrepareOptions {
  ContactModel contact_model = ContactModel::kAuto;
  BodyModel body_model = BodyModel::kAuto;
  double rate = 1000.0;                           // Hz
  Settings settings;                              // grid_side 0: as the chosen models need
  std::vector<std::vector<Pose>> expected_poses;  // (times) of (tools): what the run will bring as
                                                  // far as that is known, for kAuto; empty: unknown
  bool use_cache = true;  // distance fields and beam sections from the user's cache folder
  // Called with 0 to 1, never falling, while bodies' compliances are found that no cache has; if
  // set.
  std::function<void(double)> progress;
};

/// Load-time work: distance fields, surface samples, anchors, beam sections; then all tables,
/// filled. Bodies and tools get the rows that they have in `scene`. Fails with a message that names
/// the node.
Result<Simulation> prepare(const SceneDescription& scene, const PrepareOptions& options);

/// One step of world.clock's dt: reads one pose a tool (that of the time clock.step * dt), writes
/// every table that changes. Never throws, never allocates; what went wrong is in Clock::faults.
/// @pre tool_poses.size() == tools
void step(Simulation& simulation, std::span<const Pose> tool_poses);

}  // namespace torsion
