#include "systems/surface_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "systems/anchor_interpolation.hpp"
#include "systems/body_field.hpp"
#include "systems/distance.hpp"
#include "systems/frames.hpp"
#include "systems/turn_vertex.hpp"

namespace torsion {
namespace {

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

/// What the interpolation says at the points of a block.
struct BlockField {
  PointBlock moved;
  std::array<BlockColumn, kMaxRegionsPerBody> turned;  // rad; those of slots whose turn is on
};

/// A vertex after turns about the axes, m, body.
struct TurnedVertex {
  glm::vec3 by_regions{0.0F};  // by what regions do to the half-space
  glm::vec3 by_all{0.0F};      // and by the turn of the whole body
};

/// Turns one vertex, noting the angles.
/// @param i  its place in the block
TurnedVertex twist_vertex(const BodyField& field, const VertexRows& rows, const BlockField& block,
                          std::size_t vertex, std::size_t i, double free) {
  const glm::vec3 rest(rows.rest[vertex].position);
  TurnedVertex at{rest, rest};
  for (std::size_t slot = 0; slot < field.slots.size(); ++slot) {
    const double own = free * field.slots[slot].twist.angle(glm::dvec3(rest));
    double whole = own;
    if (field.slots[slot].turn.on) {
      whole += free * static_cast<double>(block.turned[slot][i]);
    }
    const auto angle = static_cast<float>(whole);
    rows.twist[slot * rows.rest.size() + vertex].angle = angle;
    if (angle != 0.0F) {
      at.by_all = turn_vertex(at.by_all, rows.axes[slot], angle);
    }
    if (field.turns) {
      at.by_regions = turn_vertex(at.by_regions, rows.axes[slot], static_cast<float>(own));
    }
  }
  if (!field.turns) {
    at.by_regions = at.by_all;
  }
  return at;
}

/// A direction of the body at rest as the turn of the whole body leaves it.
glm::dvec3 with_body(const BodyField& field, const BlockField& block, std::size_t i, double free,
                     glm::dvec3 direction) {
  for (std::size_t slot = 0; slot < field.slots.size(); ++slot) {
    const BodyTurn& turn = field.slots[slot].turn;
    if (turn.on) {
      const double angle = free * static_cast<double>(block.turned[slot][i]);
      const glm::dvec3 across = glm::cross(turn.direction, direction);
      direction +=
          std::sin(angle) * across + (1.0 - std::cos(angle)) * glm::cross(turn.direction, across);
    }
  }
  return direction;
}

void move_vertex(const BodyField& field, const VertexRows& rows, const BlockField& block,
                 std::size_t vertex, std::size_t i) {
  const glm::vec4& rest = rows.rest[vertex].position;
  const double free = rest.w >= 1.0F ? 0.0 : freedom(field, glm::dvec3(rest));
  const TurnedVertex at = twist_vertex(field, rows, block, vertex, i, free);
  if (free == 0.0) {
    rows.displacement[vertex].displacement = glm::vec4(0.0F);
    return;
  }
  const glm::dvec3 local(at.by_regions);
  const glm::dvec3 turned(at.by_all);
  glm::dvec3 smooth(block.moved.ux[i], block.moved.uy[i], block.moved.uz[i]);
  glm::dvec3 dents(0.0);
  for (const Slot& slot : field.slots) {
    dents += slot.dent.displacement(local);
  }
  if (field.turns) {
    // The middle of a section goes as it is pushed; the rest of the section turns about it.
    const glm::dvec3 middle = middle_at(field, glm::dvec3(rest));
    smooth = middle + with_body(field, block, i, free, smooth - middle);
    dents = with_body(field, block, i, free, dents);
  }
  const glm::dvec3 undented = turned + free * smooth;
  glm::dvec3 place = undented + free * dents;
  double pressure = 0.0;
  if (!field.touchers.empty()) {
    pressure = pressure_at(field, local, undented);
    place = push_out(field, local, place);
  }
  rows.displacement[vertex].displacement =
      glm::vec4(glm::vec3(place - turned), static_cast<float>(pressure));
}

void interpolate_at(const BodyField& field, std::span<const VertexRest> rest, BlockField& block) {
  for (std::size_t i = 0; i < rest.size(); ++i) {
    block.moved.x[i] = rest[i].position.x;
    block.moved.y[i] = rest[i].position.y;
    block.moved.z[i] = rest[i].position.z;
  }
  interpolate_block(field.weights, block.moved);
  for (std::size_t slot = 0; slot < field.slots.size(); ++slot) {
    if (field.slots[slot].turn.on) {
      interpolate_block(field.slots[slot].turn.angle, field.weights.centers, block.moved,
                        block.turned[slot]);
    }
  }
}

void move_vertices(const BodyField& field, const VertexRows& rows) {
  BlockField block{};
  for (std::size_t first = 0; first < rows.rest.size(); first += kPointBlock) {
    const std::size_t count = std::min(kPointBlock, rows.rest.size() - first);
    if (field.has_weights) {
      interpolate_at(field, rows.rest.subspan(first, count), block);
    }
    for (std::size_t i = 0; i < count; ++i) {
      move_vertex(field, rows, block, first + i, i);
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
