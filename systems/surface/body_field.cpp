#include "systems/surface/body_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/math/frames.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion::engine {
namespace {

constexpr double kHeldBand =
    0.03;  // of the body's size: over this width beside what is fixed motion fades to zero

double distance_share_from_volume(const FixedVolume& volume, const glm::dvec3& point) {
  constexpr double kFadeBand = 0.1;  // of the volume's half size
  const glm::dvec3 unit = volume.to_unit * (point - volume.center);
  const double away = volume.kind == VolumeKind::kSphere
                          ? glm::length(unit)
                          : std::max({std::abs(unit.x), std::abs(unit.y), std::abs(unit.z)});
  return smooth_step((away - 1.0) / kFadeBand);
}

/// Displacements at the interpolation's centers: those of the body model, and zero at the held
/// points. The dents' far fields are subtracted, so that the sum passes through the anchors.
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

/// Regions in the order in which they began: each dent is what the skeleton and the dents before it
/// leave of the overlap.
void fill_slots(const Snapshot& snapshot, BodyField& field) {
  for (std::uint32_t region = 0; region < snapshot.regions.size(); ++region) {
    const RegionIdentity& identity = snapshot.regions.at<RegionIdentity>(region);
    if (identity.body != field.body || field.slots.size() == kMaxRegionsPerBody) {
      continue;
    }
    const Contact& contact = snapshot.regions.at<Contact>(region);
    glm::dvec3 moved =
        field.has_weights ? interpolate(field.weights, contact.rest_point) : glm::dvec3(0.0);
    for (const Slot& before : field.slots) {
      moved += before.dent.displacement(contact.rest_point);
    }
    const RegionDent dent = region_dent(field.model, snapshot, region, moved);
    field.slots.push_back(
        {region_twist(field.model, snapshot, region), dent, BodyTurn{}, region, identity.tool,
         dent.radius > 0.0 ? snapshot.regions.at<Overlap>(region).largest_depth : 0.0});
  }
}

/// All regions of a tool that its axis misses turn one beam: together at most as far as the tool.
void limit_past_turns(const Snapshot& snapshot, BodyField& field) {
  for (std::uint32_t tool = 0; tool < snapshot.tools.size(); ++tool) {
    double sum = 0.0;
    double most = 0.0;
    for (const Slot& slot : field.slots) {
      if (slot.tool == tool) {
        sum += std::abs(slot.twist.past_turn);
        most = std::max(most, snapshot.regions.at<RegionMotion>(slot.region).largest_rotation);
      }
    }
    for (Slot& slot : field.slots) {
      if (slot.tool == tool && sum > most) {
        slot.twist.past_turn *= most / sum;
      }
    }
  }
}

void fill_touchers(const Snapshot& snapshot, BodyField& field) {
  const Pose& pose = snapshot.bodies.at<BodyPose>(field.body).now;
  for (const Slot& slot : field.slots) {
    const bool known =
        std::any_of(field.touchers.begin(), field.touchers.end(),
                    [&](const Toucher& toucher) { return toucher.tool == slot.tool; });
    if (!known && slot.depth > 0.0) {
      field.touchers.push_back({slot.tool, field.model.tools.at<OwnedRows>(slot.tool).parts,
                                field.model.tools.at<Bounds>(slot.tool),
                                relative(pose, snapshot.tools.at<ToolPose>(slot.tool).now)});
    }
  }
}

constexpr double kLeastTurn = 1e-4;  // rad; what is below half of it moves along tangents

/// Angles of the anchors about a slot's axis, as far as they are drawn as turns; empty if all are
/// too small. They fade in between half of the least turn and that.
/// @param share  out: how far
std::vector<double> anchor_turns(const Snapshot& snapshot, const Slot& slot, std::size_t anchors,
                                 std::size_t centers, double& share) {
  std::vector<double> turns;
  if (slot.twist.discs.radius <= 0.0) {
    return turns;
  }
  const AnchorTurns& all = snapshot.region_fields.at<AnchorTurns>(slot.region);
  turns.assign(std::begin(all.turn), std::begin(all.turn) + anchors);
  double largest = 0.0;
  for (const double turn : turns) {
    largest = std::max(largest, std::abs(turn));
  }
  share = smooth_step(2.0 * largest / kLeastTurn - 1.0);
  if (share == 0.0) {
    return {};
  }
  for (double& turn : turns) {
    turn *= share;
  }
  turns.resize(centers, 0.0);  // held points do not turn
  return turns;
}

/// The turn of the whole body about each slot's axis. The anchors' displacements by it, to first
/// order, are subtracted from theirs, so that the rest stays small however far they turn.
/// @param values  m: of the interpolation's centers; in and out
void fill_turns(const Snapshot& snapshot, std::span<const InterpolationRow> inverse,
                std::size_t anchors, std::span<const glm::dvec3> centers, BodyField& field,
                std::span<glm::dvec3> values) {
  double squares = 0.0;
  for (Slot& slot : field.slots) {
    const std::vector<double> turns =
        anchor_turns(snapshot, slot, anchors, centers.size(), slot.turn.share);
    if (turns.empty()) {
      continue;
    }
    BodyTurn& turn = slot.turn;
    turn.point = slot.twist.discs.center;
    turn.direction = slot.twist.discs.normal;
    solve_interpolation(inverse, turns, turn.angle);
    const double at_contact = interpolate(turn.angle, centers, turn.point);
    turn.weight = at_contact * at_contact;
    squares += turn.weight;
    for (std::size_t j = 0; j < anchors; ++j) {
      values[j] -= turns[j] * glm::cross(turn.direction, centers[j] - turn.point);
    }
    field.turns = true;
  }
  for (Slot& slot : field.slots) {
    slot.turn.weight /= squares > 0.0 ? squares : 1.0;
  }
}

/// How far the interpolated displacements alone move a ring around a turn's axis, rad.
double ring_turn(const BodyField& field, const BodyTurn& turn, double radius) {
  constexpr int kPlaces = 8;
  const glm::dvec3 other =
      std::abs(turn.direction.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  const glm::dvec3 first = glm::normalize(glm::cross(turn.direction, other));
  const glm::dvec3 second = glm::cross(turn.direction, first);
  double sum = 0.0;
  for (int place = 0; place < kPlaces; ++place) {
    const double angle = 2.0 * std::numbers::pi * place / kPlaces;
    const glm::dvec3 way = std::cos(angle) * first + std::sin(angle) * second;
    sum += glm::dot(glm::cross(turn.direction, way),
                    interpolate(field.weights, turn.point + radius * way));
  }
  return sum / (kPlaces * radius);
}

/// The material under a contact has turned as the step computed it; the interpolation differs from
/// that by some percent, and does not resolve what is finer than the anchors. The part of the
/// remaining displacements that goes around the axis is counted in the turn and subtracted from
/// them: an anchor's angle is its material's, and larger than its way around the axis where turns
/// grow outwards.
void meet_supports(const Snapshot& snapshot, std::span<const glm::dvec3> centers,
                   BodyField& field) {
  for (Slot& slot : field.slots) {
    BodyTurn& turn = slot.turn;
    const AnchorTurns& turns = snapshot.region_fields.at<AnchorTurns>(slot.region);
    double missing = turns.support;
    for (const Slot& other : field.slots) {
      if (other.turn.share > 0.0) {
        const double by_region = &other == &slot ? 0.0 : other.twist.angle(turn.point);
        missing -= (by_region + interpolate(other.turn.angle, centers, turn.point)) *
                   glm::dot(other.turn.direction, turn.direction);
      }
    }
    turn.under_contact = turn.share > 0.0
                             ? interpolate(turn.angle, centers, turn.point) + turn.share * missing
                             : 0.0;
    turn.growth = turn.share * turns.support_growth;
    turn.radius = slot.twist.discs.radius;
    if (turn.share > 0.0) {
      const double inner = turn.share * ring_turn(field, turn, 0.5 * turn.radius);
      const double outer = turn.share * ring_turn(field, turn, turn.radius);
      turn.left_growth = (outer - inner) / (0.75 * turn.radius * turn.radius);
      turn.left = inner - 0.25 * turn.radius * turn.radius * turn.left_growth;
    }
  }
}

/// Displacement along the axes, from end to end of the body.
void fill_middles(BodyField& field) {
  const Bounds& bounds = field.model.bodies.at<Bounds>(field.body);
  const glm::dvec3 center = 0.5 * (bounds.lowest + bounds.highest);
  const glm::dvec3 half = 0.5 * (bounds.highest - bounds.lowest);
  for (Slot& slot : field.slots) {
    BodyTurn& turn = slot.turn;
    if (turn.share <= 0.0) {
      continue;
    }
    const double reach = glm::dot(half, glm::abs(turn.direction));
    turn.lowest = glm::dot(center - turn.point, turn.direction) - reach;
    turn.spacing = 2.0 * reach / (BodyTurn::kMiddles - 1.0);
    for (std::size_t k = 0; k < BodyTurn::kMiddles; ++k) {
      const double along = turn.lowest + turn.spacing * static_cast<double>(k);
      turn.middle[k] = interpolate(field.weights, turn.point + turn.direction * along);
    }
  }
}
}  // namespace

BodyField body_field(const Model& model, const Snapshot& snapshot, const FrameWorld& frame,
                     std::uint32_t body) {
  const FrameBody& data = frame.bodies.at<FrameBody>(body);
  const Bounds& bounds = model.bodies.at<Bounds>(body);
  BodyField field{model, body, model.bodies.at<FixedRegion>(body), {}, 0.0, {}, false, false,
                  {},    {}};
  field.volumes = model.fixed_volumes.rows<FixedVolume>(field.fixed.volumes);
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
  limit_past_turns(snapshot, field);
  fill_touchers(snapshot, field);
  if (!field.has_weights || field.slots.empty()) {
    return field;
  }
  // On a body with compliance, only the dents contain the contacts' half-space displacements.
  const bool anchors_have_dents = model.bodies.at<BodyModels>(body).body == BodyModel::kSkeleton;
  std::vector<glm::dvec3> values = anchors_have_dents
                                       ? center_values(snapshot, data, field.slots, centers)
                                       : center_values(snapshot, data, {}, centers);
  fill_turns(snapshot, inverse, data.anchors.count, centers, field, values);
  solve_interpolation(inverse, centers, values, field.weights);
  meet_supports(snapshot, centers, field);
  fill_middles(field);
  return field;
}

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

ContactShare share_of_contact(const BodyTurn& turn, const glm::dvec3& point) {
  constexpr double kReach = 1.3;  // of the polynomial that grows, in radii (support fit.cpp)
  const double distance = glm::distance(point, turn.point);
  const double grown = std::min(distance, kReach * turn.radius);
  return {1.0 - smooth_step(distance / turn.radius - 1.0),
          turn.under_contact + turn.growth * grown * grown,
          turn.left + turn.left_growth * grown * grown};
}

glm::dvec3 middle_at(const BodyField& field, const glm::dvec3& point) {
  glm::dvec3 sum(0.0);
  for (const Slot& slot : field.slots) {
    const BodyTurn& turn = slot.turn;
    if (turn.share > 0.0 && turn.weight > 0.0) {
      const double along = glm::dot(point - turn.point, turn.direction) - turn.lowest;
      const double place = std::clamp(along / turn.spacing, 0.0, BodyTurn::kMiddles - 1.0);
      const auto below = std::min(static_cast<std::size_t>(place), BodyTurn::kMiddles - 2);
      const double above = place - static_cast<double>(below);
      sum += turn.weight * ((1.0 - above) * turn.middle[below] + above * turn.middle[below + 1]);
    }
  }
  return sum;
}
}  // namespace torsion::engine
