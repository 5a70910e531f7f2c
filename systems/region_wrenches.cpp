#include "systems/region_wrenches.hpp"

#include <algorithm>
#include <cmath>

#include "systems/fault.hpp"
#include "systems/finite.hpp"
#include "systems/frames.hpp"

namespace torsion {
namespace {

constexpr double kEventFade =
    0.01;  // s: shorter is felt as a click, longer drags an old force along
constexpr double kFaultFall = 0.01;  // s: from the last good wrench to zero
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

Wrench computed_wrench(const World& world, std::uint32_t region) {
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  const RegionFriction& friction = world.regions.at<RegionFriction>(region);
  const Pose& body = world.bodies.at<Pose>(identity.body);
  glm::dvec3 force = frame.normal * world.regions.at<RegionNormal>(region).force +
                     tangent_to_body(frame, friction.force);
  glm::dvec3 couple = frame.normal * friction.couple;
  glm::dvec3 point = world.regions.at<RegionGeometry>(region).equivalent_point;
  // The contact was found in the axes of the material under it, which has gone with the body.
  const RegionSupport& support = world.regions.at<RegionSupport>(region);
  const double turn = glm::length(support.rotation);
  if (turn > 0.0) {
    const glm::dquat rotation = glm::angleAxis(turn, support.rotation / turn);
    force = rotation * force;
    couple = rotation * couple;
    point = support.about + rotation * (point - support.about) + support.translation;
  }
  const glm::dvec3 arm =
      to_outer(body, point) - world.tools.at<ToolMotion>(identity.tool).mass_center;
  const glm::dvec3 force_in_world = body.rotation * force;
  return {force_in_world, glm::cross(arm, force_in_world) + body.rotation * couple};
}

/// Lets out what an event changed little by little.
/// @param foretold  of the last step's change, what this step's motion goes on by
/// @param faded     share that goes in this step
void fade_event(RegionWrench& wrench, const Wrench& computed, double foretold, double faded) {
  const Wrench before = wrench.on_tool;
  const auto event = static_cast<RegionEvent>(wrench.event_now);
  if (event == RegionEvent::kBegins || event == RegionEvent::kTakesOver ||
      event >= RegionEvent::kBodyFollows) {
    wrench.event_change = before - computed;
    wrench.event_share = 1.0;
  } else if (event == RegionEvent::kGridLaidAnew && wrench.event_share == 0.0) {
    // All that the last step does not foretell is the grid's; where the motion turns back, so does
    // what it foretells. Of grids that follow upon each other within the fade, while a tool is
    // pressed in fast, only the first: the force must not wait.
    wrench.event_change = before + wrench.event_change * foretold - computed;
    wrench.event_share = 1.0;
  } else {
    wrench.event_share = std::max(0.0, wrench.event_share - faded);
  }
  wrench.on_tool = computed + wrench.event_change * wrench.event_share;
  if (wrench.event_share == 0.0) {
    wrench.event_change = wrench.on_tool - before;
  }
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
  World& world = context.world;
  const double dt = world.clock.at<Clock>(0).dt;
  for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
    RegionWrench& wrench = world.regions.at<RegionWrench>(region);
    fade_event(wrench, computed_wrench(world, region),
               world.regions.at<PatchState>(region).along_last, dt / kEventFade);
  }
}

void sum_wrenches(StepContext& context) {
  World& world = context.world;
  Clock& clock = world.clock.at<Clock>(0);
  for (std::uint32_t tool = 0; tool < world.tools.size(); ++tool) {
    Wrench computed;
    for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
      if (world.regions.at<RegionIdentity>(region).tool == tool) {
        computed = computed + world.regions.at<RegionWrench>(region).on_tool;
      }
    }
    if (!finite(computed)) {
      raise(clock, Fault::kResultNotFinite);
      computed = Wrench{};
    }
    ToolWrench& wrench = world.tools.at<ToolWrench>(tool);
    const Wrench before = wrench.total;
    let_out(wrench, computed, clock.faults != 0, clock.dt);
    // The holder balances the contact: its work is minus the contact's, by the trapezoidal rule.
    const ToolMotion& motion = world.tools.at<ToolMotion>(tool);
    const Wrench mean = (before + wrench.total) * 0.5;
    wrench.work -=
        (glm::dot(mean.force, motion.velocity) + glm::dot(mean.torque, motion.angular_velocity)) *
        clock.dt;
  }
}

}  // namespace torsion
