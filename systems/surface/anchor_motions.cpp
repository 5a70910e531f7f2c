#include "systems/surface/anchor_motions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/contact/law.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/support/contact_load.hpp"
#include "systems/contact/support/footing.hpp"
#include "systems/contact/support/support_field.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/lanes.hpp"

namespace torsion {
namespace {

constexpr std::size_t kAnchorNumbers = std::size_t{3} * kAnchorsPerBody;
using AnchorColumn = std::array<double, kAnchorNumbers>;

/// to += the sum of a force's components times their rows, which are `pitch` apart; `count`
/// numbers.
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

/// Adds what forces at a footing's ports do to the anchors, which are the first of the ports: the
/// compliance is symmetric, so that the row of a port's axis has what a force there does to all.
void move_anchors(const PortCompliance& body, const Footing& footing, const PortVectors& forces,
                  std::span<AnchorMotion> anchors, AnchorTurns& turns) {
  const std::size_t side = 3 * body.ports.size();
  const std::size_t count = 3 * anchors.size();
  const ComplianceValue* const turns_by_force = &body.values[side * side];
  AnchorColumn moved{};
  AnchorColumn turned{};
  for (std::size_t p = 0; p < footing.count; ++p) {
    const std::size_t row = 3 * std::size_t{footing.ports[p]};
    add_rows(count, forces[p], &body.values[row * side], side, moved.data());
    add_rows(count, forces[p], &turns_by_force[row * count], count, turned.data());
  }
  for (std::size_t anchor = 0; anchor < anchors.size(); ++anchor) {
    anchors[anchor].displacement += vector_at(moved, anchor);
    turns.turn[anchor] = glm::dot(footing.normal, vector_at(turned, anchor));
  }
}

/// Mean over a ring about the region's place by how far its SupportField has gone round it, rad.
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

/// As the region's contact sees it: mdr knows the rigid part only. Of a polynomial of the fourth
/// degree the mean turn of a ring is c + g r^2: two rings tell both.
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
    const Footing& footing = state.footings.at<Footing>(block_of(identity));
    PortVectors forces;
    forces_at_ports(footing, contact_load(model, state, region, footing).moments, forces);
    AnchorTurns& turns = snapshot.region_fields.at<AnchorTurns>(region);
    find_support_turn(model, state, region, turns);
    move_anchors(ports_of(model, body), footing, forces, anchors, turns);
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

}  // namespace torsion
