#include "systems/contact/force_bound.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/contact/fault.hpp"
#include "systems/contact/grid_cells.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/region_wrenches.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/support/body_law.hpp"
#include "systems/geometry/distance.hpp"
#include "systems/math/frames.hpp"

namespace torsion {
namespace {

constexpr double kDeeper = 3.0;  // than the deepest sample, at most

/// What holds a region's contact.
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
  // Between samples it may be deeper, as cells show it; but where the body as a whole has moved,
  // theirs is the depth under the moved surface.
  const double of_cells = state.regions.at<Overlap>(region).largest_depth;
  overlap.depth = std::max(overlap.depth, body_law_of(model, identity.body).moves_as_a_whole
                                              ? std::min(of_cells, kDeeper * overlap.depth)
                                              : of_cells);
  // Samples lie within the overlap; it ends between them and their neighbours, which are at most as
  // far away as what makes two points one region.
  const double threshold = model.bodies.at<BodyModels>(identity.body).region_threshold;
  const double by_samples = overlap.depth > 0.0 ? 0.5 * glm::length(highest - lowest) : 0.0;
  overlap.radius = std::max(by_samples, state.regions.at<Contact>(region).radius) + threshold;
  return overlap;
}

/// How deep the tool is under the rest surface at a region's cells, m: a distance a cell.
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

/// A punch of radius a has 2 E* a on a half-space and 3 pi G a^4 / (2 h^3) on a thin bonded layer
/// without volume change (Johnson, Contact Mechanics, 1985, (3.36), 5.8), N/m; twice their sum is
/// for curved bodies and for cells that are too coarse.
double stiffness_of_punch(const Model& model, std::uint32_t body, double radius) {
  constexpr double kSafety = 2.0;
  constexpr double kLayer = 0.6;  // 3 pi / 16
  const Bounds& bounds = model.bodies.at<Bounds>(body);
  const glm::dvec3 extent = bounds.highest - bounds.lowest;
  const double thin = radius / std::min({extent.x, extent.y, extent.z});
  const double modulus = model.bodies.at<Elasticity>(body).contact_modulus();
  return kSafety * 2.0 * modulus * radius * (1.0 + kLayer * thin * thin * thin);
}

/// What a body's regions are together.
struct Regions {
  std::uint32_t count = 0;
  RestOverlap overlap;       // all depths, and the largest radius
  double force = 0.0;        // N, the largest
  bool unannounced = false;  // whether any has come up or has changed without the tool's motion
};

bool unannounced(std::uint32_t event) {
  return event != static_cast<std::uint32_t>(RegionEvent::kNone) &&
         event != static_cast<std::uint32_t>(RegionEvent::kGridLaidAnew);
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
      regions.unannounced |= unannounced(state.regions.at<RegionWrench>(region).event_now);
    }
  }
  return regions;
}

void bound_forces_on(StepContext& context, std::uint32_t body) {
  constexpr double kSameSize = 1.1;  // the contact's, as samples and cells show it step by step
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
  // A force that is wrong has done no work, neither in its own step nor in the next.
  const double work = energy.faulty == 0 && std::isfinite(energy.work) ? energy.work : 0.0;
  // The sum of the work drifts by what steps leave unsolved, but what the last force needs has been
  // there.
  const double needed = 0.5 * energy.force * energy.force / stiffness;
  double most = std::max(energy.most + work, kSameSize * needed + std::max(work, 0.0));
  if (regions.unannounced) {
    const double depth = body_law_of(model, body).moves_as_a_whole
                             ? std::max(regions.overlap.depth, depth_by_cells(context, body))
                             : regions.overlap.depth;
    most = std::max(most, 0.5 * stiffness * depth * depth);
  }
  // Written so that NaN is left to who looks for that.
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

}  // namespace torsion
