#include "systems/contact/region_wrenches.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/region_grid.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/support/body_law.hpp"
#include "systems/contact/tool_motion.hpp"
#include "systems/contact/world_region.hpp"
#include "systems/geometry/distance.hpp"
#include "systems/math/finite.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/wrenches.hpp"

namespace torsion::engine {
std::string_view fault_text(Fault fault) {
  switch (fault) {
    case Fault::kPoseNotFinite:
      return "the tool's pose is not finite; check the device or the animation's keys";
    case Fault::kPoseJumped:
      return "the tool moved faster than 20 m/s or 500 rad/s; smooth the motion or raise --rate";
    case Fault::kTooDeep:
      return "half of the tool is inside the body, or it is deeper than half the body; press less "
             "or use a larger body";
    case Fault::kRegionsFull:
      return "more than 16 contact regions on one body; raise kMaxRegionsPerBody or "
             "torsion_region_threshold";
    case Fault::kResultNotFinite:
      return "a force came out as NaN or infinity; please report the scene";
    case Fault::kForceTooLarge:
      return "a contact's force came out beyond what its depth or the tools' work allow; please "
             "report the scene";
  }
  return "unknown fault";
}

std::string faults_text(std::uint32_t faults) {
  std::string text;
  for (const Fault fault : kAllFaults) {
    if (raised(faults, fault)) {
      text += std::string(fault_text(fault)) + "\n";
    }
  }
  return text;
}

namespace {

constexpr double kDeeper = 3.0;  // than the deepest sample, at most

/// What bounds the force of a region's contact.
struct RestOverlap {
  double depth = 0.0;   // m, the largest under the rest shape
  double radius = 0.0;  // m, of a disc
};

RestOverlap rest_overlap(const StepContext& context, std::uint32_t region) {
  const Model& model = context.model;
  const State& state = context.state;
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  const RegionPoints& contact = context.scratch.region_points[block_of(identity)];
  const std::span<const ContactPoint> points(context.scratch.points.data() + contact.points.first,
                                             contact.points.count);
  RestOverlap overlap;
  glm::dvec3 lowest(1e300);
  glm::dvec3 highest(-1e300);
  for (const ContactPoint& point : points) {
    if (point.cluster == contact.cluster) {
      overlap.depth = std::max(overlap.depth, point.depth);
      lowest = glm::min(lowest, point.position);
      highest = glm::max(highest, point.position);
    }
  }
  // Between samples the tool may be deeper, which the cells show. Where the body as a whole has
  // moved, however, the cells' depth is the one under the moved surface.
  const double of_cells = state.regions.at<Overlap>(region).largest_depth;
  overlap.depth = std::max(overlap.depth, body_law_of(model, identity.body).moves_as_a_whole
                                              ? std::min(of_cells, kDeeper * overlap.depth)
                                              : of_cells);
  // Samples lie within the overlap, which ends between them and their neighbours. Those are at most
  // as far away as two points of one region can be.
  const double threshold = model.bodies.at<BodyModels>(identity.body).region_threshold;
  const double by_samples = overlap.depth > 0.0 ? 0.5 * glm::length(highest - lowest) : 0.0;
  // A long narrow contact is about as stiff as a disc of its length, and its samples may be few.
  const glm::dvec2 extent = overlap_extent(state, region);
  const double by_contact = state.regions.at<Contact>(region).radius;
  overlap.radius = std::max({by_samples, by_contact, extent.x, extent.y}) + threshold;
  return overlap;
}

/// How deep the tool is under the rest surface at a region's cells, m: one distance query a cell.
double deepest_cell(StepContext& context, std::uint32_t region) {
  const Grid grid = grid_of(context, region);
  const Pose moved = moved_grid_in_body(grid.frame, grid.carrier, grid.support);
  const Range parts = grid.model.bodies.at<OwnedRows>(grid.identity.body).parts;
  double deepest = 0.0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i) {
      const CellGeometry& cell = grid.cells[std::size_t{j} * grid.side + i];
      if (cell.coverage > 0.0) {
        const glm::dvec2 center = cell_center(grid.frame, grid.side, i, j);
        const glm::dvec3 on_tool = to_outer(moved, glm::dvec3(center, cell.height));
        deepest = std::max(deepest, -signed_distance(grid.model, parts, on_tool).value);
      }
    }
  }
  return deepest;
}

/// Of all of a body's regions together, m.
double depth_by_cells(StepContext& context, std::uint32_t body) {
  double depth = 0.0;
  for (std::uint32_t region = 0; region < context.state.regions.size(); ++region) {
    if (context.state.regions.at<RegionIdentity>(region).body == body) {
      depth += deepest_cell(context, region);
    }
  }
  return depth;
}

/// A rigid punch of radius a has the stiffness 2 E* a on a half-space and 3 pi G a^4 / (2 h^3) on a
/// thin bonded layer without volume change (Johnson, Contact Mechanics, 1985, (3.36), 5.8), N/m.
/// Twice their sum allows for curved bodies and for cells that are too coarse.
double stiffness_of_punch(const Model& model, std::uint32_t body, double radius) {
  constexpr double kSafety = 2.0;
  constexpr double kLayer = 0.6;  // 3 pi / 16
  const Bounds& bounds = model.bodies.at<Bounds>(body);
  const glm::dvec3 extent = bounds.highest - bounds.lowest;
  const double thin = radius / std::min({extent.x, extent.y, extent.z});
  const double modulus = model.bodies.at<Elasticity>(body).contact_modulus();
  return kSafety * 2.0 * modulus * radius * (1.0 + kLayer * thin * thin * thin);
}

/// All regions of a body together.
struct Regions {
  std::uint32_t count = 0;
  RestOverlap overlap;       // all depths, and the largest radius
  double force = 0.0;        // N, the largest
  bool unannounced = false;  // whether any has come up or has changed without the tool's motion
  bool regridded = false;    // whether any has
};

bool unannounced(std::uint32_t event) {
  return event != static_cast<std::uint32_t>(RegionEvent::kNone) &&
         event != static_cast<std::uint32_t>(RegionEvent::kRegridded);
}

Regions regions_on(const StepContext& context, std::uint32_t body) {
  const State& state = context.state;
  Regions regions;
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    if (state.regions.at<RegionIdentity>(region).body == body) {
      const RestOverlap overlap = rest_overlap(context, region);
      regions.count += 1;
      regions.overlap.depth += overlap.depth;
      regions.overlap.radius = std::max(regions.overlap.radius, overlap.radius);
      regions.force = std::max(regions.force, state.regions.at<RegionNormal>(region).force);
      const std::uint32_t event = state.regions.at<RegionWrench>(region).event_now;
      regions.unannounced |= unannounced(event);
      regions.regridded |= event == static_cast<std::uint32_t>(RegionEvent::kRegridded);
    }
  }
  return regions;
}

void bound_forces_on(StepContext& context, std::uint32_t body) {
  constexpr double kSameSize = 1.1;  // the contact's, as samples and cells show it step by step
  constexpr double kNewCells = 1.5;  // likewise where its cells are new, of 22 % more force
  constexpr double kDrift = 0.02;  // of the peak: a closed path may give 1 % (scene_properties.cpp)
  const Model& model = context.model;
  State& state = context.state;
  StoredEnergy& energy = state.bodies.at<StoredEnergy>(body);
  const Regions regions = regions_on(context, body);
  if (regions.count == 0) {
    energy = {};
    return;
  }
  const double stiffness = stiffness_of_punch(model, body, regions.overlap.radius);
  // A wrong force has done no work, neither in its own step nor in the next.
  const double work = energy.faulty == 0 && std::isfinite(energy.work) ? energy.work : 0.0;
  // The sum of the work drifts by what steps leave unsolved; but the energy that the last force
  // needs must have been put in.
  const double needed = 0.5 * energy.force * energy.force / stiffness;
  const double size = regions.regridded ? kNewCells : kSameSize;
  double most = std::max(energy.most + work, size * needed + std::max(work, 0.0));
  if (regions.unannounced) {
    const double depth = body_law_of(model, body).moves_as_a_whole
                             ? std::max(regions.overlap.depth, depth_by_cells(context, body))
                             : regions.overlap.depth;
    most = std::max(most, 0.5 * stiffness * depth * depth);
  }
  // Written so that NaN passes: another check finds it.
  const double allowed = std::max(most, kDrift * energy.peak);
  const bool too_much = regions.force * regions.force > 2.0 * stiffness * allowed;
  const bool too_hard = regions.force > stiffness * regions.overlap.depth;
  if (too_much || (too_hard && !body_law_of(model, body).moves_as_a_whole)) {
    raise(state.clock, Fault::kForceTooLarge);
    energy.faulty = 1;
    return;
  }
  energy = {most, std::max(energy.peak, most), energy.work, regions.force};
}

}  // namespace

void bound_forces(StepContext& context) {
  for (std::uint32_t body = 0; body < context.model.bodies.size(); ++body) {
    if (law_of(context.model, body).is_bounded) {
      bound_forces_on(context, body);
    }
  }
}

namespace {

constexpr double kEventFade =
    0.01;  // s: shorter is felt as a click, longer drags an old force along
constexpr double kMostByGrid = 0.05;  // of a force: what regridding may change of it
constexpr double kFaultFall = 0.01;   // s: from the last good wrench to zero
constexpr double kFaultRise =
    0.05;  // s: back again; slower, so that a flickering fault does not rattle the hand

/// Where the region's material is now, by the motion of the body as a whole.
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
  const State& state = context.state;
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const RegionFriction& friction = state.regions.at<RegionFriction>(region);
  const WorldRegion seen(state, region, support_now(context, region));
  const glm::dvec3 force =
      seen.direction(frame.normal * state.regions.at<RegionNormal>(region).force +
                     tangent_to_body(frame, friction.force));
  const std::uint32_t tool = state.regions.at<RegionIdentity>(region).tool;
  const glm::dvec3 arm = seen.place(state.regions.at<Contact>(region).equivalent_point) -
                         state.tools.at<ToolMotion>(tool).mass_center;
  return {force, glm::cross(arm, force) + seen.direction(frame.normal * friction.couple)};
}

/// The way into the body in this step, over the depth; 0 out of it.
double way_over_depth(const State& state, std::uint32_t region) {
  return std::max(way_into_body(state, region), 0.0) /
         std::max(state.regions.at<Overlap>(region).largest_depth, 1e-300);
}

/// The share of a new region's force that comes from the tool's motion in this step: all of it if
/// the tool reached the body within the step. A greater depth was there when the run began, or
/// samples had missed it. By Hertz, F ~ d^(3/2).
double share_by_motion(const State& state, std::uint32_t region) {
  constexpr double kMore = 1.2;  // times the way: depths are told by cells
  return std::pow(std::min(kMore * way_over_depth(state, region), 1.0), 1.5);
}

/// Likewise, of one that goes on from another: what the motion has added to what was there, if that
/// is most of it. A slower motion's part is little, and a body that gives way takes some of it.
double share_added(const State& state, std::uint32_t region) {
  constexpr double kMost = 0.5;
  const double way = std::min(way_over_depth(state, region), 1.0);
  return way > kMost ? 1.0 - std::pow(1.0 - way, 1.5) : 0.0;
}

/// Fades the part of the wrench that an event has changed.
/// @param extrapolated  share of the last step's change that this step's motion repeats
/// @param came          of a region that begins or goes on from another: the share of its force
/// that the tool's motion has made in this step
/// @param faded         share of the change that is faded out in this step
void fade_event(RegionWrench& wrench, const Wrench& computed, double extrapolated, double came,
                double faded) {
  const Wrench before = wrench.on_tool;
  const auto event = static_cast<RegionEvent>(wrench.event_now);
  if (event == RegionEvent::kBegins) {
    wrench.event_change = (before - computed) * (1.0 - came);
    wrench.event_share = came < 1.0 ? 1.0 : 0.0;
  } else if (event == RegionEvent::kTakesOver || event >= RegionEvent::kBodyFollows) {
    wrench.event_change = before - computed * (1.0 - came);
    wrench.event_share = 1.0;
  } else if (event == RegionEvent::kRegridded && wrench.event_share == 0.0) {
    // What the extrapolation of the last step does not explain is the regrid's change; where the
    // motion turns back, so is what it explains. While a tool is pressed in fast and one regrid
    // follows another within the fade, only the first is faded: the force must not wait.
    wrench.event_change = before + wrench.event_change * extrapolated - computed;
    // The force of a fast tool deviates from the extrapolation by more than any regrid changes it.
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

/// Turns what a region keeps from the last step with its body.
void carry(RegionWrench& wrench, const BodyPose& body) {
  const glm::dquat turn = body.now.rotation * glm::conjugate(body.before.rotation);
  for (Wrench* kept : {&wrench.on_tool, &wrench.event_change}) {
    *kept = {turn * kept->force, turn * kept->torque};
  }
}

/// Work that the tool's holder, who balances the wrench, does in a step, J.
double work_against(const Wrench& wrench, const ToolMotion& motion, double dt) {
  return -dt * (glm::dot(wrench.force, motion.velocity) +
                glm::dot(wrench.torque, motion.angular_velocity));
}

/// The same as far as it is done on a body, J: one that moves does some of it itself.
double work_on_body(const Model& model, const State& state, const RegionIdentity& region,
                    const Wrench& wrench) {
  if (!model.moves(region.body)) {
    return work_against(wrench, state.tools.at<ToolMotion>(region.tool), model.dt);
  }
  const glm::dquat& to_world = state.bodies.at<BodyPose>(region.body).now.rotation;
  const ToolOverBody& over = state.over(region.tool, region.body);
  return -glm::dot(wrench.force, to_world * over.shift) -
         glm::dot(wrench.torque, to_world * over.turn);
}

/// The output for a computed wrench of a tool, given whether this step had a fault.
void output_wrench(ToolWrench& wrench, const Wrench& computed, bool faulty, double dt) {
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
  const double dt = model.dt;
  for (StoredEnergy& energy : state.bodies.column<StoredEnergy>()) {
    energy.work = 0.0;
  }
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    RegionWrench& wrench = state.regions.at<RegionWrench>(region);
    const bool begins = wrench.event_now == static_cast<std::uint32_t>(RegionEvent::kBegins);
    const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
    if (model.moves(identity.body)) {
      carry(wrench, state.bodies.at<BodyPose>(identity.body));
    }
    const Wrench before = wrench.on_tool;
    fade_event(
        wrench, computed_wrench(context, region), state.regions.at<PatchState>(region).along_last,
        begins ? share_by_motion(state, region) : share_added(state, region), dt / kEventFade);
    state.bodies.at<StoredEnergy>(identity.body).work +=
        work_on_body(model, state, identity, (before + wrench.on_tool) * 0.5);
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
    output_wrench(wrench, computed, clock.faults != 0, model.dt);
    // By the trapezoidal rule.
    wrench.work +=
        work_against((before + wrench.total) * 0.5, state.tools.at<ToolMotion>(tool), model.dt);
  }
}

}  // namespace torsion::engine
