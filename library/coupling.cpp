#include "torsion/coupling.hpp"

#include <cmath>

#include "ecs/assert.hpp"
#include "library/convert.hpp"
#include "library/model_data.hpp"
#include "library/simulation_data.hpp"
#include "systems/hold/count_play.hpp"
#include "systems/hold/passivity.hpp"
#include "systems/hold/tool_hold.hpp"
#include "systems/math/finite.hpp"
#include "systems/math/frames.hpp"

namespace torsion {
namespace {

engine::DeviceTraits engine_traits(const DeviceTraits& traits) {
  engine::DeviceTraits made;
  made.damping = traits.damping;
  made.turn_damping = traits.turn_damping;
  made.mass = traits.mass;
  made.inertia = traits.inertia;
  made.encoder_step = traits.encoder_step;
  made.encoder_turn_step = traits.encoder_turn_step;
  made.period = traits.period;
  made.delay = traits.delay;
  made.largest_force = traits.largest_force;
  made.largest_torque = traits.largest_torque;
  made.largest_stiffness = traits.largest_stiffness;
  made.largest_turn_stiffness = traits.largest_turn_stiffness;
  return made;
}

engine::ToolHold engine_hold(Hold hold) {
  switch (hold) {
    case Hold::kMassless:
      return engine::ToolHold::kMassless;
    case Hold::kMass:
      return engine::ToolHold::kMass;
    case Hold::kDirect:
      break;
  }
  return engine::ToolHold::kDirect;
}

}  // namespace

struct Coupling::Data {
  std::uint32_t tool = 0;
  engine::ToolHold hold = engine::ToolHold::kMassless;
  engine::DeviceTraits traits;
  engine::VirtualCoupling springs;
  engine::PassivityLimits limits;
  engine::PassivityState books;
  engine::Pose handle;
  engine::Pose counted;  // the handle as far as its encoders' counts go
  engine::Pose felt_at;  // the handle when it last felt something
  bool begun = false;
};

Coupling::Coupling(const Model& model, std::size_t tool, const DeviceTraits& traits, Hold hold)
    : data_(std::make_unique<Data>()) {
  TORSION_ASSERT(tool < model.tool_count());
  data_->tool = static_cast<std::uint32_t>(tool);
  data_->hold = engine_hold(hold);
  data_->traits = engine_traits(traits);
  data_->springs = engine::choose_coupling(data_->traits).coupling;
  data_->limits = engine::choose_passivity(data_->traits);
}
Coupling::Coupling(const Coupling& other) : data_(std::make_unique<Data>(*other.data_)) {}
Coupling& Coupling::operator=(const Coupling& other) {
  *data_ = *other.data_;
  return *this;
}
Coupling::Coupling(Coupling&&) noexcept = default;
Coupling& Coupling::operator=(Coupling&&) noexcept = default;
Coupling::~Coupling() = default;

Pose Coupling::next(const Simulation& simulation, const Pose& handle) noexcept {
  TORSION_ASSERT(data_->tool < simulation.model().tool_count());
  engine::Pose now = to_engine(handle);
  const bool is_pose = engine::finite(now);
  now.rotation = glm::normalize(now.rotation);
  if (!is_pose) {
    now = data_->handle;
  }
  data_->handle = now;
  if (!data_->begun) {
    if (!is_pose) {
      return handle;  // a fault of the step, as without a coupling
    }
    data_->begun = true;
    data_->counted = now;
    data_->felt_at = now;
    if (simulation.step_count() == 0) {
      return handle;
    }
  }
  data_->counted = engine::follow_counts(data_->counted, now, data_->traits.encoder_step,
                                         data_->traits.encoder_turn_step, data_->traits.period);
  return from_engine(engine::next_held_pose(simulation.model().data().model(),
                                            simulation.data().state, data_->tool, data_->hold,
                                            data_->springs, data_->counted));
}

Wrench Coupling::felt(const Simulation& simulation) noexcept {
  TORSION_ASSERT(data_->tool < simulation.model().tool_count());
  if (!data_->begun) {
    return {};
  }
  const engine::State& state = simulation.data().state;
  const engine::Pose& tool = state.tools.at<engine::ToolPose>(data_->tool).now;
  const engine::Wrench wanted =
      engine::felt_wrench(data_->hold, data_->springs, data_->counted, tool,
                          engine::wrench_about_frame(state, data_->tool));
  const glm::dvec3 shift = data_->handle.position - data_->felt_at.position;
  const glm::dvec3 turn = engine::turn_between(data_->felt_at.rotation, data_->handle.rotation);
  data_->felt_at = data_->handle;
  // Poses as far apart as no workspace is: their books are not kept.
  if (!engine::finite(wanted) || !std::isfinite(glm::length(shift) + glm::length(turn))) {
    return {};
  }
  return from_engine(
      engine::keep_passive(data_->books, data_->limits, wanted, shift, turn, data_->traits.period));
}

double Coupling::stiffness() const noexcept {
  return data_->springs.stiffness;
}

double Coupling::turn_stiffness() const noexcept {
  return data_->springs.turn_stiffness;
}

double Coupling::dissipated() const noexcept {
  return data_->books.translation.dissipated + data_->books.rotation.dissipated;
}

}  // namespace torsion
