#include "ecs/check_world.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace torsion {
namespace {

// Collects the first thing that is wrong; further calls change nothing.
struct Findings {
  std::string first;

  void require(bool holds, std::string_view table, std::uint32_t row, std::string_view what) {
    if (!holds && first.empty()) {
      first.append(table).append(" row ").append(std::to_string(row)).append(": ").append(what);
    }
  }
};

bool inside(Range range, std::uint32_t size) {
  return range.first <= size && range.count <= size - range.first;
}

std::uint64_t product(glm::uvec3 counts) {
  constexpr std::uint32_t kMany = 1U << 20U;  // keeps the product of three within 64 bits
  if (counts.x > kMany || counts.y > kMany || counts.z > kMany) {
    return UINT64_MAX;
  }
  return std::uint64_t{counts.x} * counts.y * counts.z;
}

void check_sizes(const World& world, Findings& findings) {
  findings.require(world.settings.size() == 1, "settings", 0, "must be the only row");
  findings.require(world.clock.size() == 1, "clock", 0, "must be the only row");
  findings.require(world.sections.size() == std::uint64_t{world.anchors.size()} * kBeamStations,
                   "sections", 0, "their number must be that of the anchors times the stations");
  if (!findings.first.empty()) {
    return;
  }
  const std::uint64_t side = world.settings.at<Settings>(0).grid_side;
  findings.require(side >= 1 && side <= kMaxGridSide, "settings", 0, "grid_side must be 1 to 64");
  findings.require(world.cells.capacity() >= world.regions.capacity() * side * side, "cells", 0,
                   "there must be room for one grid a region");
  findings.require(world.patch_cells.size() == 0 || world.patch_cells.size() == world.cells.size(),
                   "patch_cells", 0, "there must be as many as cells, or none");
  const std::uint64_t layers = std::uint64_t{world.regions.capacity()} * kMdrLayers;
  findings.require(world.mdr_layers.empty() || world.mdr_layers.size() == layers, "mdr_layers", 0,
                   "there must be a row for each layer of each region, or none");
  const std::uint64_t tables = 16 * side * (2 * side - 1);  // kInfluenceKinds tables of one grid
  findings.require(world.layer_influences.empty() ||
                       world.layer_influences.size() == world.regions.capacity() * tables,
                   "layer_influences", 0, "there must be one grid's for each region, or none");
  const std::uint64_t footings = world.footings.size();
  findings.require(footings == 0 || footings == world.regions.capacity(), "footings", 0,
                   "there must be one for each region, or none");
  findings.require(world.couplings.size() == (footings == 0 ? 0 : footings * (footings - 1) / 2),
                   "couplings", 0, "there must be one for each two regions, or none");
}

void check_fields(const World& world, Findings& findings) {
  for (std::uint32_t row = 0; row < world.parts.size(); ++row) {
    const auto& part = world.parts.at<ShapePart>(row);
    findings.require(part.kind <= ShapeKind::kMesh, "parts", row, "unknown kind of shape");
    findings.require(part.kind != ShapeKind::kMesh || part.field < world.fields.size(), "parts",
                     row, "its distance field is not there");
  }
  for (std::uint32_t row = 0; row < world.fields.size(); ++row) {
    const auto& field = world.fields.at<DistanceField>(row);
    findings.require(inside(field.coarse_nodes, world.field_nodes.size()) &&
                         product(field.cells + 1U) == field.coarse_nodes.count,
                     "fields", row, "its coarse nodes are not there");
    findings.require(inside(field.bricks, world.field_bricks.size()) &&
                         product(field.cells) == field.bricks.count,
                     "fields", row, "its bricks are not there");
    if (!findings.first.empty()) {
      return;
    }
    const std::uint64_t brick_nodes = product(glm::uvec3(field.subdivision + 1U));
    for (const DistanceBrick& brick : world.field_bricks.rows<DistanceBrick>(field.bricks)) {
      findings.require(brick.first_node == kNoRow ||
                           (brick_nodes <= world.field_nodes.size() &&
                            brick.first_node <= world.field_nodes.size() - brick_nodes),
                       "fields", row, "the fine nodes of a brick are not there");
    }
  }
}

void check_surface(const World& world, const OwnedRows& owned, std::uint32_t tool,
                   Findings& findings) {
  for (const SurfaceSample& sample : world.samples.rows<SurfaceSample>(owned.samples)) {
    for (const std::uint32_t neighbour : sample.neighbours) {
      findings.require(neighbour == kNoRow || neighbour < owned.samples.count, "tools", tool,
                       "the neighbour of a surface sample is not there");
    }
  }
  std::uint32_t ball_row = 0;
  for (const SurfaceBall& ball : world.balls.rows<SurfaceBall>(owned.balls)) {
    // A link that does not lead on would make the walk through the tree endless.
    findings.require(ball.skip > ball_row && ball.skip <= owned.balls.count, "tools", tool,
                     "a link of its sphere tree leads nowhere");
    findings.require(ball.sample == kNoRow || ball.sample < owned.samples.count, "tools", tool,
                     "the sample of a surface ball is not there");
    ++ball_row;
  }
}

void check_owned_rows(const World& world, std::string_view table, const OwnedRows& owned,
                      std::uint32_t row, Findings& findings) {
  findings.require(inside(owned.parts, world.parts.size()), table, row, "its parts are not there");
  findings.require(inside(owned.samples, world.samples.size()), table, row,
                   "its samples are not there");
  findings.require(inside(owned.balls, world.balls.size()), table, row, "its balls are not there");
  findings.require(inside(owned.anchors, world.anchors.size()), table, row,
                   "its anchors are not there");
  findings.require(owned.anchors.count <= kAnchorsPerBody, table, row, "it has too many anchors");
  findings.require(inside(owned.influences, world.influences.size()), table, row,
                   "its influence tables are not there");
  findings.require(inside(owned.ports, world.ports.size()), table, row, "its ports are not there");
  findings.require(owned.ports.count == 0 || owned.anchors.count <= owned.ports.count, table, row,
                   "its anchors are the first of its ports");
  const std::uint64_t side = 3ULL * owned.ports.count;
  const std::uint64_t rows = side + 3ULL * owned.anchors.count;
  findings.require(
      inside(owned.compliance, world.compliance.size()) && owned.compliance.count == side * rows,
      table, row, "its compliance is not that of its ports");
}

/// Of a region that is otherwise sound.
void check_footing(const World& world, const RegionIdentity& region, std::uint32_t row,
                   Findings& findings) {
  const std::uint32_t block = region.cells.first / std::max(region.cells.count, 1U);
  if (block >= world.footings.size()) {
    findings.require(false, "regions", row, "its footing is not there");
    return;
  }
  const Footing& footing = world.footings.at<Footing>(block);
  const std::uint32_t ports = world.bodies.at<OwnedRows>(region.body).ports.count;
  const bool few = footing.count <= kFootingPorts;
  findings.require(few && std::all_of(footing.ports.begin(), footing.ports.begin() + footing.count,
                                      [ports](std::uint32_t port) { return port < ports; }),
                   "footings", block, "the ports that it stands on are not there");
}

void check_owners(const World& world, Findings& findings) {
  for (std::uint32_t row = 0; row < world.bodies.size(); ++row) {
    check_owned_rows(world, "bodies", world.bodies.at<OwnedRows>(row), row, findings);
    findings.require(inside(world.bodies.at<FixedRegion>(row).volumes, world.fixed_volumes.size()),
                     "bodies", row, "its fixed volumes are not there");
  }
  for (std::uint32_t row = 0; row < world.tools.size(); ++row) {
    check_owned_rows(world, "tools", world.tools.at<OwnedRows>(row), row, findings);
    if (findings.first.empty()) {
      check_surface(world, world.tools.at<OwnedRows>(row), row, findings);
    }
  }
  for (std::uint32_t row = 0; row < world.regions.size(); ++row) {
    const auto& region = world.regions.at<RegionIdentity>(row);
    findings.require(region.body < world.bodies.size(), "regions", row, "its body is not there");
    findings.require(region.tool < world.tools.size(), "regions", row, "its tool is not there");
    findings.require(inside(region.cells, world.cells.size()), "regions", row,
                     "its cells are not there");
    if (findings.first.empty() && !world.footings.empty()) {
      check_footing(world, region, row, findings);
    }
  }
}

}  // namespace

Result<Done> check_world(const World& world) {
  Findings findings;
  check_sizes(world, findings);
  if (findings.first.empty()) {
    check_fields(world, findings);
    check_owners(world, findings);
  }
  if (!findings.first.empty()) {
    return Error{findings.first};
  }
  return Done{};
}

}  // namespace torsion
