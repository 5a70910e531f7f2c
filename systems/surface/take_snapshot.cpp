#include "systems/surface/take_snapshot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/body/skeleton/skeleton.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/support/contact_load.hpp"
#include "systems/contact/support/support_fit.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/lanes.hpp"
#include "systems/math/smooth_step.hpp"
#include "systems/surface/region_fields.hpp"

namespace torsion::engine {
namespace {

constexpr std::size_t kAnchorNumbers = std::size_t{3} * kAnchorsPerBody;
using AnchorColumn = std::array<double, kAnchorNumbers>;

/// to += the sum over a force's components of component times row. Rows are `pitch` apart and have
/// `count` numbers.
TORSION_WIDEST
void add_rows(std::size_t count, const glm::dvec3& force, const ComplianceValue* __restrict rows,
              std::size_t pitch, double* __restrict to) {
  const double x = force.x;
  const double y = force.y;
  const double z = force.z;
  const ComplianceValue* const __restrict row_y = rows + pitch;
  const ComplianceValue* const __restrict row_z = row_y + pitch;
  for (std::size_t i = 0; i < count; ++i) {
    to[i] = to[i] + x * rows[i].value + y * row_y[i].value + z * row_z[i].value;
  }
}

glm::dvec3 vector_at(const AnchorColumn& column, std::size_t anchor) {
  return {column[3 * anchor], column[3 * anchor + 1], column[3 * anchor + 2]};
}

/// Adds the displacements of the anchors, which are the first of the ports, by forces at a support
/// fit's ports. The compliance is symmetric, so the row of a port's axis holds what a force there
/// does everywhere.
void move_anchors(const PortCompliance& body, const SupportFit& support_fit,
                  const PortVectors& forces, std::span<AnchorMotion> anchors, AnchorTurns& turns) {
  const std::size_t side = 3 * body.ports.size();
  const std::size_t count = 3 * anchors.size();
  const ComplianceValue* const turns_by_force = &body.values[side * side];
  AnchorColumn moved{};
  AnchorColumn turned{};
  for (std::size_t p = 0; p < support_fit.count; ++p) {
    const std::size_t row = 3 * std::size_t{support_fit.ports[p]};
    add_rows(count, forces[p], &body.values[row * side], side, moved.data());
    add_rows(count, forces[p], &turns_by_force[row * count], count, turned.data());
  }
  for (std::size_t anchor = 0; anchor < anchors.size(); ++anchor) {
    anchors[anchor].displacement += vector_at(moved, anchor);
    turns.turn[anchor] = glm::dot(support_fit.normal, vector_at(turned, anchor));
  }
}

/// Mean over a ring around the region's place of how far its SupportField has moved around it, rad.
double mean_turn(const State& state, std::uint32_t region, double radius) {
  constexpr int kPlaces = 8;  // a polynomial of the fourth degree has no more than five waves
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const glm::dvec3& center = state.regions.at<Contact>(region).rest_point;
  double sum = 0.0;
  for (int place = 0; place < kPlaces; ++place) {
    const double angle = 2.0 * std::numbers::pi * place / kPlaces;
    const glm::dvec3 way = tangent_to_body(frame, {std::cos(angle), std::sin(angle)});
    sum += glm::dot(glm::cross(frame.normal, way),
                    displacement_at(state.regions.at<SupportField>(region), center + radius * way));
  }
  return sum / (kPlaces * radius);
}

/// As the region's contact model uses it: mdr uses the rigid part only. For a polynomial of the
/// fourth degree a ring's mean turn is c + g r^2: two rings determine both.
void find_support_turn(const Model& model, const State& state, std::uint32_t region,
                       AnchorTurns& turns) {
  const RegionSupport& support = state.regions.at<RegionSupport>(region);
  turns.support = glm::dot(support.rotation - support.rotation_step,
                           state.regions.at<RegionFrame>(region).normal);
  const double radius = state.regions.at<Contact>(region).radius;
  if (radius > 0.0 && law_of(model, state.regions.at<RegionIdentity>(region).body).by_cells) {
    const double outer = mean_turn(state, region, radius);
    const double inner = mean_turn(state, region, 0.5 * radius);
    turns.support_growth = (outer - inner) / (0.75 * radius * radius);
    turns.support += inner - 0.25 * radius * radius * turns.support_growth;
  }
}

/// All regions of one body.
void move_anchors_of(const Model& model, const State& state, std::uint32_t body,
                     Snapshot& snapshot) {
  const auto anchors =
      snapshot.anchors.rows<AnchorMotion>(model.bodies.at<OwnedRows>(body).anchors);
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
    if (identity.body != body) {
      continue;
    }
    const SupportFit& support_fit = state.support_fits.at<SupportFit>(block_of(identity));
    PortVectors forces;
    forces_at_ports(support_fit, contact_load(model, state, region, support_fit).moments, forces);
    AnchorTurns& turns = snapshot.region_fields.at<AnchorTurns>(region);
    find_support_turn(model, state, region, turns);
    move_anchors(ports_of(model, body), support_fit, forces, anchors, turns);
  }
}

}  // namespace

void anchor_motions(const Model& model, const State& state, Snapshot& snapshot) {
  for (std::uint32_t body = 0; body < model.bodies.size(); ++body) {
    if (model.bodies.at<BodyModels>(body).body == BodyModel::kCompliance) {
      move_anchors_of(model, state, body, snapshot);
    }
  }
}

namespace {

using std::numbers::pi;

/// A region's load on the main beam's tip, in the beam's frame: minus the body's load on the tool.
struct TipLoad {
  glm::dvec3 force{0.0};   // N
  glm::dvec2 moment{0.0};  // N m, without torsion
};

TipLoad tip_load(const MainBeam& beam, const RegionFrame& frame, const RegionNormal& normal,
                 const RegionFriction& friction) {
  const glm::dvec3 force = -(frame.normal * normal.force + tangent_to_body(frame, friction.force));
  const glm::dvec3 couple = frame.normal * -friction.couple;
  return {
      {glm::dot(force, beam.first), glm::dot(force, beam.second), glm::dot(force, beam.direction)},
      {glm::dot(couple, beam.first), glm::dot(couple, beam.second)}};
}

/// Distance from the root along the beam of the section to which a point belongs. Sections are
/// perpendicular to the beam; over a fixed face they are parallel to the face, so that the whole
/// face belongs to the root.
double place_along(const MainBeam& beam, const FixedRegion& fixed, const glm::dvec3& from_root) {
  if (fixed.kind != FixedKind::kFace) {
    return glm::dot(from_root, beam.direction);
  }
  const double steepness = std::max(glm::dot(beam.direction, fixed.normal), 1e-3);
  return glm::dot(from_root, fixed.normal) / steepness;
}

/// u(a) = u(s) + rot(s) x r - nu e(s) r. The root keeps a free bar from contracting: the last term
/// grows from zero there to its full size within one radius of the section (Saint-Venant's
/// principle).
void move_anchors(const MainBeam& beam, const BeamDeflection& deflection, const FixedRegion& fixed,
                  double poisson_ratio, std::span<const AnchorRest> rest,
                  std::span<AnchorMotion> motion) {
  const double radius = std::sqrt(beam.sections[kBeamStations / 2].area / pi);
  const double over_entry = 1.0 / std::min(radius, 0.5 * beam.length);
  for (std::size_t j = 0; j < rest.size(); ++j) {
    const glm::dvec3 from_root = rest[j].position - fixed.point;
    const double along = std::clamp(place_along(beam, fixed, from_root), 0.0, beam.length);
    const glm::dvec3 rib = from_root - beam.direction * along;
    const double x = glm::dot(rib, beam.first);
    const double y = glm::dot(rib, beam.second);
    const double z = glm::dot(rib, beam.direction);
    const SectionMotion section = section_motion(deflection, along);
    const double swelling =
        -poisson_ratio * axial_strain(deflection, along) * smooth_step(along * over_entry);
    const glm::dvec3 local(section.shift.x + section.turn.y * z + swelling * x,
                           section.shift.y - section.turn.x * z + swelling * y,
                           section.shift.z + section.turn.x * y - section.turn.y * x);
    motion[j].displacement +=
        beam.first * local.x + beam.second * local.y + beam.direction * local.z;
  }
}

}  // namespace

void skeleton_motions(const Model& model, const State& state, Snapshot& snapshot) {
  const auto identities = state.regions.column<RegionIdentity>();
  for (std::uint32_t body = 0; body < model.bodies.size(); ++body) {
    const Range anchors = model.bodies.at<OwnedRows>(body).anchors;
    const auto motion = snapshot.anchors.rows<AnchorMotion>(anchors);
    if (model.bodies.at<BodyModels>(body).body != BodyModel::kSkeleton || anchors.count == 0) {
      continue;
    }
    const Elasticity& elasticity = model.bodies.at<Elasticity>(body);
    const FixedRegion& fixed = model.bodies.at<FixedRegion>(body);
    for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
      if (identities[region].body != body) {
        continue;
      }
      const MainBeam beam = main_beam(model, body, state.regions.at<Contact>(region).rest_point);
      const TipLoad load = tip_load(beam, state.regions.at<RegionFrame>(region),
                                    state.regions.at<RegionNormal>(region),
                                    state.regions.at<RegionFriction>(region));
      const BeamDeflection deflection = deflect(beam, elasticity, load.force, load.moment);
      move_anchors(beam, deflection, fixed, elasticity.poisson_ratio,
                   model.anchors.rows<AnchorRest>(anchors), motion);
    }
  }
}

SnapshotTables make_snapshot_tables(const State& state, const MdrTables& mdr) {
  return {mdr, state.patch_cells.empty() ? RingProfiles{} : make_ring_profiles()};
}

void take_snapshot(const Model& model, const State& state, const SnapshotTables& tables,
                   Snapshot& snapshot) {
  capture(model, state, snapshot);
  region_fields(model, state, tables, snapshot);
  skeleton_motions(model, state, snapshot);
  anchor_motions(model, state, snapshot);
}

}  // namespace torsion::engine
