#include "scenes/fixed_regions.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace torsion::engine {
namespace {

/// A vertex this near to the bottom, as a share of the body's height, belongs to the bottom face.
constexpr double kBottomShare = 1e-3;

struct Extent {
  glm::dvec3 center{0.0};  // m, of the bounding box
  double lowest = 0.0;     // m along `up`, from the centre
  double height = 0.0;     // m along `up`
};

Extent extent_of(const BodyDescription& body, const glm::dvec3& up) {
  glm::dvec3 low(1e300);
  glm::dvec3 high(-1e300);
  for (const PartDescription& part : body.parts) {
    for (const glm::dvec3& position : part.surface.positions) {
      low = glm::min(low, position);
      high = glm::max(high, position);
    }
  }
  Extent extent;
  extent.center = 0.5 * (low + high);
  double highest = -1e300;
  extent.lowest = 1e300;
  for (const PartDescription& part : body.parts) {
    for (const glm::dvec3& position : part.surface.positions) {
      const double along = glm::dot(position - extent.center, up);
      extent.lowest = std::min(extent.lowest, along);
      highest = std::max(highest, along);
    }
  }
  extent.height = highest - extent.lowest;
  return extent;
}

void fix_bottom(bool face, const glm::dvec3& up, BodyDescription& body) {
  const Extent extent = extent_of(body, up);
  body.fixed.point = extent.center + up * extent.lowest;
  if (!face) {
    body.fixed.kind = FixedKind::kPoint;
    return;
  }
  body.fixed.kind = FixedKind::kFace;
  body.fixed.normal = up;
  for (std::size_t i = 0; i < body.draw.positions.size(); ++i) {
    const double above = glm::dot(glm::dvec3(body.draw.positions[i]) - body.fixed.point, up);
    body.draw.fixed[i] = above < kBottomShare * extent.height;
  }
}

FixedVolume volume_of(const FixedNode& node) {
  FixedVolume volume;
  volume.kind = node.role == Role::kFixedBox ? VolumeKind::kBox : VolumeKind::kSphere;
  volume.center = glm::dvec3(node.to_body[3]);
  volume.to_unit = glm::inverse(glm::dmat3(node.to_body));
  return volume;
}

/// False where the image of the unit box is flat, however small the box may be.
bool has_extent(const glm::dmat3& axes) {
  const glm::dvec3 lengths(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
  return std::min({lengths.x, lengths.y, lengths.z}) > 1e-9 &&
         std::abs(glm::determinant(axes)) > 1e-6 * lengths.x * lengths.y * lengths.z;
}

bool holds(const FixedVolume& volume, const glm::dvec3& point) {
  const glm::dvec3 unit = volume.to_unit * (point - volume.center);
  return volume.kind == VolumeKind::kSphere
             ? glm::dot(unit, unit) <= 1.0
             : std::max({std::abs(unit.x), std::abs(unit.y), std::abs(unit.z)}) <= 1.0;
}

/// Puts what lies in the volumes at rest, and q_f at the middle of the vertices that they hold.
void fix_volumes(const std::string& where, BodyDescription& body, const ProblemList& problems) {
  body.fixed.kind = FixedKind::kVolumes;
  body.fixed.volumes = {0, static_cast<std::uint32_t>(body.fixed_volumes.size())};
  glm::dvec3 sum(0.0);
  double count = 0.0;
  for (std::size_t i = 0; i < body.draw.positions.size(); ++i) {
    const glm::dvec3 position(body.draw.positions[i]);
    const bool held = std::ranges::any_of(
        body.fixed_volumes, [&](const FixedVolume& volume) { return holds(volume, position); });
    body.draw.fixed[i] = held;
    sum += held ? position : glm::dvec3(0.0);
    count += held ? 1.0 : 0.0;
  }
  if (count == 0.0) {
    problems.add(where, "fixed_box, fixed_sphere", "", "hold no vertex of the body",
                 "move or scale them so that they reach into it; they need no mesh, and their "
                 "size is their scale");
    return;
  }
  body.fixed.point = sum / count;
}

/// The box around the vertices that the attribute marks.
void fix_marked(const std::string& where, BodyDescription& body, const ProblemList& problems) {
  glm::dvec3 low(1e300);
  glm::dvec3 high(-1e300);
  for (std::size_t i = 0; i < body.draw.positions.size(); ++i) {
    if (body.draw.fixed[i]) {
      low = glm::min(low, glm::dvec3(body.draw.positions[i]));
      high = glm::max(high, glm::dvec3(body.draw.positions[i]));
    }
  }
  if (low.x > high.x) {
    problems.add(where, "torsion_fixed", "\"attribute\"",
                 "expected vertices whose attribute _FIXED is above 0.5",
                 "name a float point attribute _FIXED and export attributes; vertex groups are "
                 "not exported");
    return;
  }
  const glm::dvec3 half = 0.5 * (high - low);
  const double least = 1e-3 * std::max({half.x, half.y, half.z, 1e-6});
  FixedVolume volume;
  volume.center = 0.5 * (low + high);
  for (int i = 0; i < 3; ++i) {
    volume.to_unit[i][i] = 1.0 / (half[i] * 1.001 + least);
  }
  body.fixed_volumes = {volume};
  body.fixed.kind = FixedKind::kVolumes;
  body.fixed.volumes = {0, 1};
  body.fixed.point = volume.center;
}

void fix_by_nodes(std::span<const FixedNode> nodes, const std::string& where, BodyDescription& body,
                  const ProblemList& problems) {
  const FixedNode* point = nullptr;
  for (const FixedNode& node : nodes) {
    if (node.role != Role::kFixedPoint) {
      if (!has_extent(glm::dmat3(node.to_body))) {
        problems.add(node.where, "scale", "", "has no extent along one axis", "scale it up");
        return;
      }
      body.fixed_volumes.push_back(volume_of(node));
    } else if (point != nullptr) {
      problems.add(node.where, "torsion_role", "\"fixed_point\"",
                   "expected one fixed_point a body, this is the second");
    } else {
      point = &node;
    }
  }
  if (!body.fixed_volumes.empty()) {
    fix_volumes(where, body, problems);
  }
  if (point != nullptr) {
    body.fixed.point = glm::dvec3(point->to_body[3]);
  }
}

}  // namespace

void set_fixed_region(const std::string& how, std::span<const FixedNode> nodes,
                      const glm::dvec3& up, const std::string& where, BodyDescription& body,
                      const ProblemList& problems) {
  const bool by_nodes = how.empty() ? !nodes.empty() : how == "children";
  if (how != "attribute") {
    body.draw.fixed.assign(body.draw.positions.size(), false);
  }
  if (!by_nodes && !nodes.empty()) {
    problems.add(where, "torsion_fixed", '"' + how + '"',
                 "but it has fixed_ nodes below, which would do nothing",
                 "set it to \"children\", or take the nodes out");
  } else if (by_nodes && nodes.empty()) {
    problems.add(where, "torsion_fixed", '"' + how + '"',
                 "expected a child with torsion_role fixed_point, fixed_box or fixed_sphere");
  } else if (by_nodes) {
    fix_by_nodes(nodes, where, body, problems);
  } else if (how == "attribute") {
    fix_marked(where, body, problems);
  } else {
    fix_bottom(how == "bottom_face", up, body);
  }
}

}  // namespace torsion::engine
