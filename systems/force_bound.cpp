#include "systems/force_bound.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/distance.hpp"
#include "systems/fault.hpp"
#include "systems/frames.hpp"
#include "systems/grid_cells.hpp"
#include "systems/scratch.hpp"

namespace torsion {
namespace {

/// A region's overlap with the body's rest shape.
struct RestOverlap {
  double depth = 0.0;   // m, the largest
  double radius = 0.0;  // m, of a disc that holds it
};

constexpr double kDeeper = 3.0;  // than the deepest sample, at most

bool moves_as_a_whole(const World& world, std::uint32_t body) {
  return world.bodies.at<BodyModels>(body).body == BodyModel::kCompliance;
}

RestOverlap rest_overlap(const StepContext& context, std::uint32_t region) {
  const World& world = context.world;
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
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
  const double of_cells = world.regions.at<RegionGeometry>(region).largest_depth;
  overlap.depth = std::max(overlap.depth, moves_as_a_whole(world, identity.body)
                                              ? std::min(of_cells, kDeeper * overlap.depth)
                                              : of_cells);
  // Samples lie within the overlap; it ends between them and their neighbours, which are at most as
  // far away as what makes two points one region.
  const double threshold = world.bodies.at<BodyModels>(identity.body).region_threshold;
  overlap.radius = (overlap.depth > 0.0 ? 0.5 * glm::length(highest - lowest) : 0.0) + threshold;
  return overlap;
}

/// How deep the tool is under the rest surface at the cells of a region of a body that moves as a
/// whole, m: a distance a cell, so only where the samples have not settled it.
double deepest_cell(StepContext& context, std::uint32_t region) {
  const Grid grid = grid_of(context, region);
  const Pose moved = moved_grid_in_body(grid.frame, grid.carrier, grid.support);
  const Range parts = grid.world.bodies.at<OwnedRows>(grid.identity.body).parts;
  double deepest = 0.0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i) {
      const CellGeometry& cell = grid.cells[std::size_t{j} * grid.side + i];
      if (cell.coverage > 0.0) {
        const glm::dvec2 center = cell_center(grid.frame, grid.side, i, j);
        const glm::dvec3 on_tool = to_outer(moved, glm::dvec3(center, cell.height));
        deepest = std::max(deepest, -signed_distance(grid.world, parts, on_tool).value);
      }
    }
  }
  return deepest;
}

/// A punch of radius a takes 2 E* a d on a half-space and 3 pi G a^4 d / (2 h^3) on a thin bonded
/// layer without volume change (Johnson, Contact Mechanics, 1985, (3.36), 5.8); twice their sum is
/// for curved bodies and for cells that are too coarse.
double most_of_punch(const World& world, std::uint32_t body, double radius, double depth) {
  constexpr double kSafety = 2.0;
  constexpr double kLayer = 0.6;  // 3 pi / 16
  const Bounds& bounds = world.bodies.at<Bounds>(body);
  const glm::dvec3 extent = bounds.highest - bounds.lowest;
  const double thin = radius / std::min({extent.x, extent.y, extent.z});
  const double modulus = world.bodies.at<Elasticity>(body).contact_modulus();
  return kSafety * 2.0 * modulus * radius * depth * (1.0 + kLayer * thin * thin * thin);
}

void bound_forces_on(StepContext& context, std::uint32_t body) {
  World& world = context.world;
  double depth = 0.0;  // m, of all regions together, as samples show them
  double radius = 0.0;
  double largest = 0.0;  // N
  const auto is_on_it = [&](std::uint32_t region) {
    return world.regions.at<RegionIdentity>(region).body == body;
  };
  for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
    if (is_on_it(region)) {
      const RestOverlap overlap = rest_overlap(context, region);
      depth += overlap.depth;
      radius = std::max(radius, overlap.radius);
      largest = std::max(largest, world.regions.at<RegionNormal>(region).force);
    }
  }
  // Written so that NaN is left to who looks for that.
  if (largest > most_of_punch(world, body, radius, depth) && moves_as_a_whole(world, body)) {
    depth = 0.0;
    for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
      if (is_on_it(region)) {
        depth += std::max(rest_overlap(context, region).depth, deepest_cell(context, region));
      }
    }
  }
  if (largest > most_of_punch(world, body, radius, depth)) {
    raise(world.clock.at<Clock>(0), Fault::kForceTooLarge);
  }
}

}  // namespace

void bound_forces(StepContext& context) {
  for (std::uint32_t body = 0; body < context.world.bodies.size(); ++body) {
    // The force of `paper` is a formula of the depth, which stiffens without bound.
    if (context.world.bodies.at<BodyModels>(body).contact != ContactModel::kPaper) {
      bound_forces_on(context, body);
    }
  }
}

}  // namespace torsion
