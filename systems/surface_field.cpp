#include "systems/surface_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "systems/anchor_interpolation.hpp"
#include "systems/distance.hpp"
#include "systems/frames.hpp"
#include "systems/region_field.hpp"
#include "systems/turn_vertex.hpp"

namespace torsion {
namespace {

constexpr double kHeldBand =
    0.03;  // of the body's size: over this width beside what is fixed motion fades to zero

double smooth_step(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// A region of the body at work, in its slot.
struct Slot {
  RegionTwist twist;
  RegionDent dent;
  std::uint32_t tool = 0;
  double depth = 0.0;  // m
};

/// A tool that touches the body.
struct Toucher {
  std::uint32_t tool = 0;
  Range parts;
  Bounds bounds;
  Pose in_body;  // tool frame in the body's
};

/// All that the vertices of one body need.
struct BodyField {
  const World& world;
  std::uint32_t body = 0;
  FixedRegion fixed;
  std::span<const FixedVolume> volumes;
  double held_band = 0.0;  // m
  InterpolationWeights weights;
  bool has_weights = false;
  std::vector<Slot> slots;
  std::vector<Toucher> touchers;
};

// ------------------------------------------------------------------------------------------ what
// is set up per body

double distance_share_from_volume(const FixedVolume& volume, const glm::dvec3& point) {
  constexpr double kBand = 0.1;  // of the volume's half size
  const glm::dvec3 unit = volume.to_unit * (point - volume.center);
  const double away = volume.kind == VolumeKind::kSphere
                          ? glm::length(unit)
                          : std::max({std::abs(unit.x), std::abs(unit.y), std::abs(unit.z)});
  return smooth_step((away - 1.0) / kBand);
}

/// How freely a point moves: 0 on the fixed region, 1 a little away from it.
double freedom(const BodyField& field, const glm::dvec3& point) {
  const glm::dvec3 away = point - field.fixed.point;
  switch (field.fixed.kind) {
    case FixedKind::kFace:
      return smooth_step(glm::dot(away, field.fixed.normal) / field.held_band);
    case FixedKind::kPoint:
      return smooth_step(glm::length(away) / field.held_band);
    case FixedKind::kVolumes:
      break;
  }
  double share = 1.0;
  for (const FixedVolume& volume : field.volumes) {
    share = std::min(share, distance_share_from_volume(volume, point));
  }
  return share;
}

/// Displacements at the interpolation's centers: what the body model says, and zero at the held
/// points. Where a dent's far field would add to them it is taken out, so that the sum still goes
/// through the anchors.
std::vector<glm::dvec3> center_values(const Snapshot& snapshot, const FrameBody& data,
                                      std::span<const Slot> slots,
                                      std::span<const glm::dvec3> centers) {
  std::vector<glm::dvec3> values(centers.size(), glm::dvec3(0.0));
  for (std::uint32_t j = 0; j < data.anchors.count; ++j) {
    values[j] = snapshot.anchors.at<AnchorMotion>(data.anchors.first + j).displacement;
  }
  for (std::size_t j = 0; j < centers.size(); ++j) {
    for (const Slot& slot : slots) {
      values[j] -= slot.dent.displacement(centers[j]) * slot.dent.far_share(centers[j]);
    }
  }
  return values;
}

/// Regions in their order of formation: each one's dent is what the skeleton and the dents before
/// it leave of its overlap.
void fill_slots(const Snapshot& snapshot, BodyField& field) {
  for (std::uint32_t region = 0; region < snapshot.regions.size(); ++region) {
    const RegionIdentity& identity = snapshot.regions.at<RegionIdentity>(region);
    if (identity.body != field.body || field.slots.size() == kMaxRegionsPerBody) {
      continue;
    }
    const RegionGeometry& geometry = snapshot.regions.at<RegionGeometry>(region);
    glm::dvec3 moved =
        field.has_weights ? interpolate(field.weights, geometry.rest_point) : glm::dvec3(0.0);
    for (const Slot& before : field.slots) {
      moved += before.dent.displacement(geometry.rest_point);
    }
    const RegionDent dent = region_dent(field.world, snapshot, region, moved);
    field.slots.push_back({region_twist(field.world, snapshot, region), dent, identity.tool,
                           dent.radius > 0.0 ? geometry.largest_depth : 0.0});
  }
}

void fill_touchers(const Snapshot& snapshot, BodyField& field) {
  const Pose& pose = field.world.bodies.at<Pose>(field.body);
  for (const Slot& slot : field.slots) {
    const bool known =
        std::any_of(field.touchers.begin(), field.touchers.end(),
                    [&](const Toucher& toucher) { return toucher.tool == slot.tool; });
    if (!known && slot.depth > 0.0) {
      field.touchers.push_back({slot.tool, field.world.tools.at<OwnedRows>(slot.tool).parts,
                                field.world.tools.at<Bounds>(slot.tool),
                                relative(pose, snapshot.tools.at<ToolPose>(slot.tool).now)});
    }
  }
}

BodyField body_field(const World& world, const Snapshot& snapshot, const FrameWorld& frame,
                     std::uint32_t body) {
  const FrameBody& data = frame.bodies.at<FrameBody>(body);
  const Bounds& bounds = world.bodies.at<Bounds>(body);
  BodyField field{world, body, world.bodies.at<FixedRegion>(body), {}, 0.0, {}, false, {}, {}};
  field.volumes = world.fixed_volumes.rows<FixedVolume>(field.fixed.volumes);
  field.held_band = kHeldBand * glm::length(bounds.highest - bounds.lowest);
  std::vector<glm::dvec3> centers;
  for (const AnchorRest& anchor : frame.anchor_rest.rows<AnchorRest>(data.anchors)) {
    centers.push_back(anchor.position);
  }
  for (const AnchorRest& held : frame.anchor_rest.rows<AnchorRest>(data.held_points)) {
    centers.push_back(held.position);
  }
  const auto inverse = frame.interpolation.rows<InterpolationRow>(data.interpolation);
  field.has_weights = !inverse.empty();
  if (field.has_weights) {
    solve_interpolation(inverse, centers, center_values(snapshot, data, {}, centers),
                        field.weights);
  }
  fill_slots(snapshot, field);
  fill_touchers(snapshot, field);
  // A body with compliance has what its contacts do to the half-space in the dents alone.
  const bool anchors_have_dents = world.bodies.at<BodyModels>(body).body == BodyModel::kSkeleton;
  if (field.has_weights && !field.slots.empty() && anchors_have_dents) {
    solve_interpolation(inverse, centers, center_values(snapshot, data, field.slots, centers),
                        field.weights);
  }
  return field;
}

// ---------------------------------------------------------------------------------------- what is
// done per vertex

bool inside_box(const Bounds& bounds, const glm::dvec3& point) {
  return glm::all(glm::greaterThan(point, bounds.lowest)) &&
         glm::all(glm::lessThan(point, bounds.highest));
}

/// The slot of this tool whose region is nearest, measured in its radius.
const Slot& nearest_slot(std::span<const Slot> slots, std::uint32_t tool, const glm::dvec3& point) {
  const Slot* nearest = nullptr;
  double least = 0.0;
  for (const Slot& slot : slots) {
    if (slot.tool != tool || slot.depth <= 0.0) {
      continue;
    }
    const double distance = glm::distance(point, slot.dent.center) / slot.dent.radius;
    if (nearest == nullptr || distance < least) {
      nearest = &slot;
      least = distance;
    }
  }
  return *nearest;
}

/// How far a point inside the tool must go along `direction` (tool frame) to come out: Newton's
/// method on the distance, bracketed, because interior distances of tools that are not convex are
/// not monotone; where the distance hardly changes on the way, steps that double.
double way_out(const World& world, const Toucher& toucher, const glm::dvec3& start,
               const glm::dvec3& direction, Distance distance) {
  const double tolerance = 1e-7 * glm::length(toucher.bounds.highest - toucher.bounds.lowest);
  constexpr double kSlopeOfNewton = 0.1;
  double inside = 0.0;
  double outside = std::numeric_limits<double>::infinity();
  double stride = tolerance;
  double t = 0.0;
  for (int i = 0; i < 60 && (distance.value < 0.0 || distance.value > tolerance); ++i) {
    (distance.value < 0.0 ? inside : outside) = t;
    const double slope = glm::dot(distance.gradient, direction);
    if (slope > kSlopeOfNewton) {
      // Aim for half the tolerance outside, so that rounding to float leaves the point out.
      t += (0.5 * tolerance - distance.value) / slope;
    } else {
      stride = std::max(2.0 * stride, std::abs(distance.value));
      t += stride;
    }
    if (t <= inside || t >= outside) {
      t = 0.5 * (inside + std::min(outside, 2.0 * inside + stride));
    }
    distance = signed_distance(world, toucher.parts, start + direction * t);
  }
  return distance.value < 0.0 && std::isfinite(outside) ? outside : t;
}

/// Which way the body yields to a tool at a point: against the outward normals of the tool's
/// regions, weighted by the fourth power of how near they are, so that the nearest counts and
/// nothing jumps between two of them. Body frame, unit.
glm::dvec3 way_into_body(const BodyField& field, std::uint32_t tool, const glm::dvec3& point) {
  glm::dvec3 sum(0.0);
  for (const Slot& slot : field.slots) {
    if (slot.tool == tool && slot.depth > 0.0) {
      const glm::dvec3 away = (point - slot.dent.center) / slot.dent.radius;
      const double square = glm::dot(away, away) + 1e-6;
      sum -= slot.dent.normal / (square * square);
    }
  }
  const double length = glm::length(sum);
  return length > 0.0 ? sum / length : -nearest_slot(field.slots, tool, point).dent.normal;
}

/// Pushes a point that is still inside a tool out of it: half-way between into the body and the
/// nearest way out, so that a point beside a steep wall goes to the wall, not down all of it.
glm::dvec3 push_out(const BodyField& field, const glm::dvec3& rest_place, const glm::dvec3& place) {
  glm::dvec3 pushed = place;
  for (const Toucher& toucher : field.touchers) {
    const glm::dvec3 in_tool = to_inner(toucher.in_body, pushed);
    if (!inside_box(toucher.bounds, in_tool)) {
      continue;
    }
    const Distance distance = signed_distance(field.world, toucher.parts, in_tool);
    if (!(distance.value < 0.0)) {
      continue;
    }
    const glm::dvec3 inward = way_into_body(field, toucher.tool, rest_place);
    const glm::dvec3 both = inward + toucher.in_body.rotation * distance.gradient;
    const double length = glm::length(both);
    const glm::dvec3 way = length > 0.1 ? both / length : inward;
    const glm::dvec3 in_tool_way = glm::conjugate(toucher.in_body.rotation) * way;
    pushed += way * way_out(field.world, toucher, in_tool, in_tool_way, distance);
  }
  return pushed;
}

/// Contact pressure at a point, from how deep the tool would be in the body were it not dented
/// there.
double pressure_at(const BodyField& field, const glm::dvec3& turned, const glm::dvec3& undented) {
  double pressure = 0.0;
  for (const Toucher& toucher : field.touchers) {
    const glm::dvec3 in_tool = to_inner(toucher.in_body, undented);
    if (!inside_box(toucher.bounds, in_tool)) {
      continue;
    }
    const Slot& slot = nearest_slot(field.slots, toucher.tool, turned);
    const double overlap = -signed_distance(field.world, toucher.parts, in_tool).value;
    if (overlap > 0.0) {
      pressure += slot.dent.pressure * std::min(overlap / slot.dent.full_overlap, 1.0);
    }
  }
  return pressure;
}

/// Rows of one body's vertices.
struct VertexRows {
  std::span<const VertexRest> rest;
  std::span<VertexDisplacement> displacement;
  std::span<TwistAngle> twist;
  std::span<const TwistAxis> axes;
};

/// Turns one vertex, noting the angles; where it is then [m, body].
glm::vec3 twist_vertex(const BodyField& field, const VertexRows& rows, std::size_t vertex,
                       double free) {
  glm::vec3 position(rows.rest[vertex].position);
  const glm::dvec3 rest(position);
  for (std::size_t slot = 0; slot < field.slots.size(); ++slot) {
    const auto angle = static_cast<float>(free * field.slots[slot].twist.angle(rest));
    rows.twist[slot * rows.rest.size() + vertex].angle = angle;
    if (angle != 0.0F) {
      position = turn_vertex(position, rows.axes[slot], angle);
    }
  }
  return position;
}

void move_vertex(const BodyField& field, const VertexRows& rows, std::size_t vertex,
                 const glm::dvec3& interpolated) {
  const glm::vec4& rest = rows.rest[vertex].position;
  const double free = rest.w >= 1.0F ? 0.0 : freedom(field, glm::dvec3(rest));
  const glm::vec3 turned_float = twist_vertex(field, rows, vertex, free);
  if (free == 0.0) {
    rows.displacement[vertex].displacement = glm::vec4(0.0F);
    return;
  }
  const glm::dvec3 turned(turned_float);
  const glm::dvec3 undented = turned + free * interpolated;
  glm::dvec3 place = undented;
  for (const Slot& slot : field.slots) {
    place += free * slot.dent.displacement(turned);
  }
  double pressure = 0.0;
  if (!field.touchers.empty()) {
    pressure = pressure_at(field, turned, undented);
    place = push_out(field, turned, place);
  }
  rows.displacement[vertex].displacement =
      glm::vec4(glm::vec3(place - turned), static_cast<float>(pressure));
}

void move_vertices(const BodyField& field, const VertexRows& rows) {
  PointBlock block{};
  for (std::size_t first = 0; first < rows.rest.size(); first += kPointBlock) {
    const std::size_t count = std::min(kPointBlock, rows.rest.size() - first);
    if (field.has_weights) {
      for (std::size_t i = 0; i < count; ++i) {
        const glm::vec4& rest = rows.rest[first + i].position;
        block.x[i] = rest.x;
        block.y[i] = rest.y;
        block.z[i] = rest.z;
      }
      interpolate_block(field.weights, block);
    }
    for (std::size_t i = 0; i < count; ++i) {
      move_vertex(field, rows, first + i, glm::dvec3(block.ux[i], block.uy[i], block.uz[i]));
    }
  }
}

}  // namespace

void surface_field(const World& world, const Snapshot& snapshot, FrameWorld& frame) {
  for (std::uint32_t tool = 0; tool < frame.tools.size(); ++tool) {
    frame.tools.at<Pose>(tool) = snapshot.tools.at<ToolPose>(tool).now;
  }
  for (std::uint32_t body = 0; body < frame.bodies.size(); ++body) {
    FrameBody& data = frame.bodies.at<FrameBody>(body);
    const Range vertices = frame.bodies.at<DrawRange>(body).vertices;
    const BodyField field = body_field(world, snapshot, frame, body);
    data.regions_drawn = static_cast<std::uint32_t>(field.slots.size());
    const auto axes = frame.axes.rows<TwistAxis>(data.axes);
    for (std::size_t slot = 0; slot < field.slots.size(); ++slot) {
      axes[slot] = field.slots[slot].twist.axis;
    }
    move_vertices(field, {frame.body_vertices.rows<VertexRest>(vertices),
                          frame.body_vertices.rows<VertexDisplacement>(vertices),
                          frame.twist.rows<TwistAngle>(data.twist), axes});
  }
}

}  // namespace torsion
