#include "systems/contact/region_wrenches.hpp"

#include <algorithm>
#include <cmath>

#include "systems/contact/fault.hpp"
#include "systems/contact/force_bound.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/region_motion.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/math/finite.hpp"
#include "systems/math/frames.hpp"

namespace torsion {
namespace {

constexpr double kEventFade =
    0.01;  // s: shorter is felt as a click, longer drags an old force along
constexpr double kMostByGrid = 0.05;  // of a force: what a grid laid anew may change of it
constexpr double kFaultFall = 0.01;   // s: from the last good wrench to zero
constexpr double kFaultRise =
    0.05;  // s: back again; slower, so that a flickering fault does not rattle the hand

Wrench operator+(const Wrench& a, const Wrench& b) {
  return {a.force + b.force, a.torque + b.torque};
}
Wrench operator-(const Wrench& a, const Wrench& b) {
  return {a.force - b.force, a.torque - b.torque};
}
Wrench operator*(const Wrench& a, double share) {
  return {a.force * share, a.torque * share};
}

/// Where the body as a whole has the material under a region now.
RegionSupport support_now(const StepContext& context, std::uint32_t region) {
  const RegionIdentity& identity = context.state.regions.at<RegionIdentity>(region);
  RegionSupport support = context.state.regions.at<RegionSupport>(region);
  if (law_of(context.model, identity.body).moves_own_support) {
    const SupportAnswer& answer = context.scratch.support_answers[block_of(identity)];
    support.translation += answer.translation;
    support.rotation += answer.rotation;
  }
  return support;
}

Wrench computed_wrench(const StepContext& context, std::uint32_t region) {
  const Model& model = context.model;
  const State& state = context.state;
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const RegionFriction& friction = state.regions.at<RegionFriction>(region);
  const Pose& body = model.bodies.at<Pose>(identity.body);
  glm::dvec3 force = frame.normal * state.regions.at<RegionNormal>(region).force +
                     tangent_to_body(frame, friction.force);
  glm::dvec3 couple = frame.normal * friction.couple;
  glm::dvec3 point = state.regions.at<Contact>(region).equivalent_point;
  // The contact was found in the axes of the material under it, which has gone with the body.
  const RegionSupport support = support_now(context, region);
  const double turn = glm::length(support.rotation);
  if (turn > 0.0) {
    const glm::dquat rotation = glm::angleAxis(turn, support.rotation / turn);
    force = rotation * force;
    couple = rotation * couple;
    point = support.about + rotation * (point - support.about) + support.translation;
  }
  const glm::dvec3 arm =
      to_outer(body, point) - state.tools.at<ToolMotion>(identity.tool).mass_center;
  const glm::dvec3 force_in_world = body.rotation * force;
  return {force_in_world, glm::cross(arm, force_in_world) + body.rotation * couple};
}

/// Of a new region's force, what the tool's way in this step has made of it: all where it came to
/// the body within the step. What it finds there deeper than that did not come by the motion, but
/// when the run began or because samples had missed it. By Hertz' law, F ~ d^(3/2).
double share_by_motion(const Model& model, const State& state, std::uint32_t region) {
  constexpr double kMore = 1.2;  // times the way: depths are told by cells
  const glm::dvec3 shift = shift_at(motion_over_body(model, state, region),
                                    state.regions.at<Contact>(region).equivalent_point);
  const double way = -glm::dot(shift, state.regions.at<RegionFrame>(region).normal);
  const double share =
      kMore * way / std::max(state.regions.at<Overlap>(region).largest_depth, 1e-300);
  return share < 1.0 ? std::pow(std::max(share, 0.0), 1.5) : 1.0;
}

/// Lets out what an event changed little by little.
/// @param foretold  of the last step's change, what this step's motion goes on by
/// @param came      of a region that begins, the share that the tool's way has made
/// @param faded     share that goes in this step
void fade_event(RegionWrench& wrench, const Wrench& computed, double foretold, double came,
                double faded) {
  const Wrench before = wrench.on_tool;
  const auto event = static_cast<RegionEvent>(wrench.event_now);
  if (event == RegionEvent::kBegins) {
    wrench.event_change = (before - computed) * (1.0 - came);
    wrench.event_share = came < 1.0 ? 1.0 : 0.0;
  } else if (event == RegionEvent::kTakesOver || event >= RegionEvent::kBodyFollows) {
    wrench.event_change = before - computed;
    wrench.event_share = 1.0;
  } else if (event == RegionEvent::kGridLaidAnew && wrench.event_share == 0.0) {
    // All that the last step does not foretell is the grid's; where the motion turns back, so does
    // what it foretells. Of grids that follow upon each other within the fade, while a tool is
    // pressed in fast, only the first: the force must not wait.
    wrench.event_change = before + wrench.event_change * foretold - computed;
    // A quick tool's force bends away from what the last step foretells by more than any grid does.
    const double most = kMostByGrid * glm::length(computed.force);
    const double jump = glm::length(wrench.event_change.force);
    wrench.event_change = wrench.event_change * (jump > most ? most / jump : 1.0);
    wrench.event_share = 1.0;
  } else {
    wrench.event_share = std::max(0.0, wrench.event_share - faded);
  }
  wrench.on_tool = computed + wrench.event_change * wrench.event_share;
  if (wrench.event_share == 0.0) {
    wrench.event_change = wrench.on_tool - before;
  }
}

/// What a tool's holder, who balances the wrench, does in a step, J.
double work_against(const Wrench& wrench, const ToolMotion& motion, double dt) {
  return -dt * (glm::dot(wrench.force, motion.velocity) +
                glm::dot(wrench.torque, motion.angular_velocity));
}

/// What the computed wrench of a tool becomes, given whether this step had a fault.
void let_out(ToolWrench& wrench, const Wrench& computed, bool faulty, double dt) {
  if (faulty && wrench.state != WrenchState::kFalling) {
    wrench.state = WrenchState::kFalling;
    wrench.held = wrench.total;
    wrench.share = 1.0;
  }
  switch (wrench.state) {
    case WrenchState::kLive:
      wrench.total = computed;
      return;
    case WrenchState::kFalling:
      wrench.share = std::max(0.0, wrench.share - dt / kFaultFall);
      wrench.total = wrench.held * wrench.share;
      if (wrench.share == 0.0 && !faulty) {
        wrench.state = WrenchState::kRising;
      }
      return;
    case WrenchState::kRising:
      wrench.share = std::min(1.0, wrench.share + dt / kFaultRise);
      wrench.total = computed * wrench.share;
      if (wrench.share == 1.0) {
        wrench.state = WrenchState::kLive;
      }
      return;
  }
}

}  // namespace

void region_wrenches(StepContext& context) {
  const Model& model = context.model;
  State& state = context.state;
  const double dt = state.clock.dt;
  for (StoredEnergy& energy : state.bodies.column<StoredEnergy>()) {
    energy.work = 0.0;
  }
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    RegionWrench& wrench = state.regions.at<RegionWrench>(region);
    const bool begins = wrench.event_now == static_cast<std::uint32_t>(RegionEvent::kBegins);
    const Wrench before = wrench.on_tool;
    fade_event(wrench, computed_wrench(context, region),
               state.regions.at<PatchState>(region).along_last,
               begins ? share_by_motion(model, state, region) : 0.0, dt / kEventFade);
    const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
    state.bodies.at<StoredEnergy>(identity.body).work += work_against(
        (before + wrench.on_tool) * 0.5, state.tools.at<ToolMotion>(identity.tool), dt);
  }
  bound_forces(context);
}

void sum_wrenches(StepContext& context) {
  const Model& model = context.model;
  State& state = context.state;
  Clock& clock = state.clock;
  for (std::uint32_t tool = 0; tool < model.tools.size(); ++tool) {
    Wrench computed;
    for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
      if (state.regions.at<RegionIdentity>(region).tool == tool) {
        computed = computed + state.regions.at<RegionWrench>(region).on_tool;
      }
    }
    if (!finite(computed)) {
      raise(clock, Fault::kResultNotFinite);
      computed = Wrench{};
    }
    ToolWrench& wrench = state.tools.at<ToolWrench>(tool);
    const Wrench before = wrench.total;
    let_out(wrench, computed, clock.faults != 0, clock.dt);
    // By the trapezoidal rule.
    wrench.work +=
        work_against((before + wrench.total) * 0.5, state.tools.at<ToolMotion>(tool), clock.dt);
  }
}

}  // namespace torsion
