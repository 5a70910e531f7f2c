#include "systems/surface/surface_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/geometry/distance.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/lanes.hpp"
#include "systems/surface/anchor_interpolation.hpp"
#include "systems/surface/body_field.hpp"
#include "systems/surface/twist_and_dent.hpp"

namespace torsion::engine {
TORSION_WIDEST
void turn_block(const TwistAxis& axis, const BlockColumn& angles, BlockVectors& points) {
  float largest = 0.0F;
  for (const float angle : angles) {
    largest = std::max(largest, std::abs(angle));
  }
  if (largest == 0.0F) {
    return;
  }
  if (!(largest < 0.5F * std::numbers::pi_v<float>)) {
    for (std::size_t i = 0; i < kPointBlock; ++i) {
      const glm::vec3 turned =
          turn_vertex({points.x[i], points.y[i], points.z[i]}, axis, angles[i]);
      points.x[i] = turned.x;
      points.y[i] = turned.y;
      points.z[i] = turned.z;
    }
    return;
  }
  const glm::vec3 k(axis.direction);
  const glm::vec3 p(axis.point);
  for (std::size_t i = 0; i < kPointBlock; ++i) {
    const SineVersine turn = sine_and_versine_of_half(0.5F * angles[i]);
    const float rx = points.x[i] - p.x;
    const float ry = points.y[i] - p.y;
    const float rz = points.z[i] - p.z;
    const float ax = k.y * rz - k.z * ry;
    const float ay = k.z * rx - k.x * rz;
    const float az = k.x * ry - k.y * rx;
    points.x[i] += turn.sine * ax + turn.versine * (k.y * az - k.z * ay);
    points.y[i] += turn.sine * ay + turn.versine * (k.z * ax - k.x * az);
    points.z[i] += turn.sine * az + turn.versine * (k.x * ay - k.y * ax);
  }
}

void deform_vertices(const FrameWorld& frame, std::uint32_t body, std::span<glm::vec4> positions) {
  const FrameBody& data = frame.bodies.at<FrameBody>(body);
  const Range vertices = frame.bodies.at<DrawRange>(body).vertices;
  TORSION_ASSERT(positions.size() == vertices.count);
  const auto rest = frame.body_vertices.rows<VertexRest>(vertices);
  const auto displacement = frame.body_vertices.rows<VertexDisplacement>(vertices);
  const auto twist = frame.twist.rows<TwistAngle>(data.twist);
  const auto axes = frame.axes.rows<TwistAxis>(data.axes);
  for (std::uint32_t vertex = 0; vertex < vertices.count; ++vertex) {
    glm::vec3 position(rest[vertex].position);
    float turned = 0.0F;  // rad, as the heat map shows it
    for (std::uint32_t slot = 0; slot < data.regions_drawn; ++slot) {
      const float angle = twist[slot * vertices.count + vertex].angle;
      if (angle != 0.0F) {
        position = turn_vertex(position, axes[slot], angle);
        turned += angle;
      }
    }
    positions[vertex] = glm::vec4(position + glm::vec3(displacement[vertex].displacement), turned);
  }
}

namespace {

bool inside_box(const Bounds& bounds, const glm::dvec3& point) {
  return glm::all(glm::greaterThan(point, bounds.lowest)) &&
         glm::all(glm::lessThan(point, bounds.highest));
}

/// The slot of this tool whose region is nearest, in units of its radius.
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

/// How far a point inside the tool must go along `direction` (tool frame) to leave it. Newton's
/// method on the distance, bracketed, because interior distances of tools that are not convex are
/// not monotone; where the distance hardly changes along the way, steps that double.
double way_out(const Model& model, const Toucher& toucher, const glm::dvec3& start,
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
    distance = signed_distance(model, toucher.parts, start + direction * t);
  }
  return distance.value < 0.0 && std::isfinite(outside) ? outside : t;
}

/// The direction in which the body yields to a tool at a point: against the outward normals of the
/// tool's regions, weighted by the fourth power of their nearness, so that the nearest one counts
/// and nothing jumps between two. Body frame, unit.
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

/// Moves a point that is still inside a tool out of it, in the direction halfway between into the
/// body and the nearest way out: a point beside a steep wall goes to the wall, not all the way
/// down.
glm::dvec3 push_out(const BodyField& field, const glm::dvec3& rest_place, const glm::dvec3& place) {
  glm::dvec3 pushed = place;
  for (const Toucher& toucher : field.touchers) {
    const glm::dvec3 in_tool = to_inner(toucher.in_body, pushed);
    if (!inside_box(toucher.bounds, in_tool)) {
      continue;
    }
    const Distance distance = signed_distance(field.model, toucher.parts, in_tool);
    if (!(distance.value < 0.0)) {
      continue;
    }
    const glm::dvec3 inward = way_into_body(field, toucher.tool, rest_place);
    const glm::dvec3 both = inward + toucher.in_body.rotation * distance.gradient;
    const double length = glm::length(both);
    const glm::dvec3 way = length > 0.1 ? both / length : inward;
    const glm::dvec3 in_tool_way = glm::conjugate(toucher.in_body.rotation) * way;
    pushed += way * way_out(field.model, toucher, in_tool, in_tool_way, distance);
  }
  return pushed;
}

/// Contact pressure at a point, from the tool's depth in the body without the dent there.
double pressure_at(const BodyField& field, const glm::dvec3& turned, const glm::dvec3& undented) {
  double pressure = 0.0;
  for (const Toucher& toucher : field.touchers) {
    const glm::dvec3 in_tool = to_inner(toucher.in_body, undented);
    if (!inside_box(toucher.bounds, in_tool)) {
      continue;
    }
    const Slot& slot = nearest_slot(field.slots, toucher.tool, turned);
    const double overlap = -signed_distance(field.model, toucher.parts, in_tool).value;
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

/// A block of vertices.
struct VertexBlock {
  std::size_t first = 0;                             // row
  std::size_t count = 0;                             // of kPointBlock
  std::array<double, kPointBlock> free;              // 0: fixed, 1: not
  BlockVectors rest;                                 // m, body
  BlockVectors smooth;                               // m, body: the interpolation's, unturned
  std::array<BlockColumn, kMaxRegionsPerBody> turn;  // rad: of slots with a share of the turn
  BlockVectors turned;                               // m, body: by all angles
  BlockVectors turned_by_regions;                    // m, body: without the whole body's
  BlockVectors dents;                                // m, body
};

void take_rows(const BodyField& field, const VertexRows& rows, VertexBlock& block) {
  for (std::size_t i = 0; i < block.count; ++i) {
    const glm::vec4& rest = rows.rest[block.first + i].position;
    const glm::dvec3 point(rest);
    block.rest.set(i, point);
    block.free[i] = rest.w >= 1.0F ? 0.0 : freedom(field, point);
  }
}

void interpolate_block(const BodyField& field, VertexBlock& block) {
  std::array<ScalarColumn, kMaxRegionsPerBody> columns;
  std::size_t turning = 0;
  for (std::size_t slot = 0; slot < field.slots.size(); ++slot) {
    if (field.slots[slot].turn.share > 0.0) {
      columns[turning++] = {&field.slots[slot].turn.angle, &block.turn[slot]};
    }
  }
  interpolate_block(field.weights, block.rest, block.smooth, std::span(columns).first(turning));
  for (std::size_t slot = 0; slot < field.slots.size(); ++slot) {
    const BodyTurn& turn = field.slots[slot].turn;
    for (std::size_t i = 0; i < (turn.share > 0.0 ? block.count : 0); ++i) {
      const glm::dvec3 rest = block.rest.at(i);
      float& angle = block.turn[slot][i];
      if (is_under_contact(turn, rest)) {
        const ContactShare under = share_of_contact(turn, rest);
        angle += static_cast<float>(under.share * (under.angle - static_cast<double>(angle)));
        block.smooth.set(i, block.smooth.at(i) - under.share * under.left *
                                                     glm::cross(turn.direction, rest - turn.point));
      }
      angle *= static_cast<float>(block.free[i]);
    }
  }
}

/// Turns the vertices and stores the angles.
void turn_vertices(const BodyField& field, const VertexRows& rows, VertexBlock& block) {
  block.turned = block.rest;
  block.turned_by_regions = block.rest;
  BlockColumn angles{};
  for (std::size_t slot = 0; slot < field.slots.size(); ++slot) {
    field.slots[slot].twist.angles(block.rest, block.count, angles);
    for (std::size_t i = 0; i < block.count; ++i) {
      angles[i] *= static_cast<float>(block.free[i]);
    }
    std::fill(angles.begin() + static_cast<std::ptrdiff_t>(block.count), angles.end(), 0.0F);
    if (field.turns) {
      turn_block(rows.axes[slot], angles, block.turned_by_regions);
    }
    if (field.slots[slot].turn.share > 0.0) {
      for (std::size_t i = 0; i < block.count; ++i) {
        angles[i] += block.turn[slot][i];
      }
    }
    turn_block(rows.axes[slot], angles, block.turned);
    for (std::size_t i = 0; i < block.count; ++i) {
      rows.twist[slot * rows.rest.size() + block.first + i].angle = angles[i];
    }
  }
  if (!field.turns) {
    block.turned_by_regions = block.turned;
  }
}

/// Turns the displacements with the body: a section's middle is displaced without a turn, the rest
/// of the section turns about it.
void turn_displacements(const BodyField& field, VertexBlock& block) {
  BlockVectors middles;
  for (std::size_t i = 0; i < block.count; ++i) {
    const glm::dvec3 middle = middle_at(field, block.rest.at(i));
    middles.set(i, middle);
    block.smooth.set(i, block.smooth.at(i) - middle);
  }
  for (std::size_t slot = 0; slot < field.slots.size(); ++slot) {
    const BodyTurn& turn = field.slots[slot].turn;
    if (turn.share > 0.0) {
      const TwistAxis direction{glm::vec4(0.0F), glm::vec4(glm::vec3(turn.direction), 0.0F)};
      turn_block(direction, block.turn[slot], block.smooth);
      turn_block(direction, block.turn[slot], block.dents);
    }
  }
  for (std::size_t i = 0; i < block.count; ++i) {
    block.smooth.set(i, block.smooth.at(i) + middles.at(i));
  }
}

/// Displacement [m, body] and pressure [Pa] of one vertex of the block.
glm::vec4 displacement_of(const BodyField& field, const VertexBlock& block, std::size_t i) {
  if (block.free[i] == 0.0) {
    return glm::vec4(0.0F);
  }
  const glm::dvec3 turned = block.turned.at(i);
  const glm::dvec3 undented = turned + block.free[i] * block.smooth.at(i);
  glm::dvec3 place = undented + block.free[i] * block.dents.at(i);
  double pressure = 0.0;
  if (!field.touchers.empty()) {
    const glm::dvec3 on_body = block.turned_by_regions.at(i);
    pressure = pressure_at(field, on_body, undented);
    place = push_out(field, on_body, place);
  }
  return {glm::vec3(place - turned), static_cast<float>(pressure)};
}

void move_vertices(const BodyField& field, const VertexRows& rows) {
  VertexBlock block{};
  for (; block.first < rows.rest.size(); block.first += kPointBlock) {
    block.count = std::min(kPointBlock, rows.rest.size() - block.first);
    take_rows(field, rows, block);
    if (field.has_weights) {
      interpolate_block(field, block);
    }
    turn_vertices(field, rows, block);
    block.dents = BlockVectors{};
    for (const Slot& slot : field.slots) {
      slot.dent.add_displacements(block.turned_by_regions, block.count, block.dents);
    }
    if (field.turns) {
      turn_displacements(field, block);
    }
    for (std::size_t i = 0; i < block.count; ++i) {
      rows.displacement[block.first + i].displacement = displacement_of(field, block, i);
    }
  }
}

}  // namespace

void surface_field(const Model& model, const Snapshot& snapshot, FrameWorld& frame) {
  for (std::uint32_t tool = 0; tool < frame.tools.size(); ++tool) {
    frame.tools.at<Pose>(tool) = snapshot.tools.at<ToolPose>(tool).now;
  }
  for (std::uint32_t body = 0; body < frame.bodies.size(); ++body) {
    frame.bodies.at<Pose>(body) = snapshot.bodies.at<BodyPose>(body).now;
    FrameBody& data = frame.bodies.at<FrameBody>(body);
    const Range vertices = frame.bodies.at<DrawRange>(body).vertices;
    const BodyField field = body_field(model, snapshot, frame, body);
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

}  // namespace torsion::engine
