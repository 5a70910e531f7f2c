#include "systems/body/compliance/region_couplings.hpp"

#include <algorithm>

#include <Eigen/Core>
#include <glm/geometric.hpp>

#include "systems/contact/law.hpp"
#include "systems/half_space/coupling.hpp"
#include "systems/half_space/layer_coupling.hpp"
#include "systems/half_space/layer_thickness.hpp"

namespace torsion {
namespace {

/// The same on a layer, forces and displacements alone: there a contact moves nothing farther away
/// than some thicknesses.
Matrix6 on_layer(const CompliantBody& body, const Matrix6& half_space, const Footing& to,
                 const Footing& from, double thickness) {
  Matrix6 motion = Matrix6::Zero();
  if (has_layer_kernel(body.model, body.row)) {
    const glm::dmat3 layer =
        layer_coupling(body.model, body.row, from.normal, to.center - from.center, thickness);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        motion(row, column) = half_space(row, column) + layer[column][row];
      }
    }
  }
  return motion;
}

/// Row of the coupling between two blocks' regions.
std::uint32_t coupling_row(std::uint32_t one, std::uint32_t other) {
  const std::uint32_t high = std::max(one, other);
  return high * (high - 1) / 2 + std::min(one, other);
}

bool is_found(const RegionCoupling& coupling, const Footing& to, const Footing& from) {
  return coupling.serial_to == to.serial && coupling.serial_from == from.serial;
}

/// Where the one is seen from the other. Point loads in each other's place would move each other
/// without bound, and regions that part or meet may have their middles anywhere: mdr's are discs,
/// so they lie as far apart as their rims at least. Those of patch are what their cells are, and
/// the middle of one may lie within the disc of another: as far as the larger one's rim at least,
/// where two regions do less to each other than each does to itself. With q = (1 - nu^2) / (pi E)
/// point loads at distance d sink by q / d, discs by (pi / 2) q / a.
glm::dvec3 apart(const Footing& there, const Footing& here, bool by_cells) {
  const glm::dvec3 way = there.center - here.center;
  const double distance = glm::length(way);
  const double least = by_cells ? std::max(there.radius, here.radius) : there.radius + here.radius;
  return distance < least ? here.center + way * (least / distance) : there.center;
}

void find_coupling(const CompliantBody& body, const Footing& there, const Footing& here,
                   RegionCoupling& coupling) {
  coupling.serial_to = there.serial;
  coupling.serial_from = here.serial;
  Eigen::Map<Matrix6>(coupling.motion.data()) = motion_of(body, there, here);
}

/// @param found_before  take those that were, or those that never were
/// @return how many more may be found
std::size_t find_some_couplings(const CompliantBody& body, bool found_before, std::size_t most) {
  for (std::size_t i = 0; i < body.count; ++i) {
    for (std::size_t j = 0; j < i && most > 0; ++j) {
      const bool ordered = body.stands[i].block > body.stands[j].block;
      const Stand& to = body.stands[ordered ? i : j];
      const Stand& from = body.stands[ordered ? j : i];
      RegionCoupling& coupling = coupling_between(body, to, from);
      const Footing& there = footing_of(body, to);
      const Footing& here = footing_of(body, from);
      if ((coupling.serial_to != 0) == found_before && !is_found(coupling, there, here)) {
        find_coupling(body, there, here, coupling);
        --most;
      }
    }
  }
  return most;
}

}  // namespace

void forget_couplings(State& state, std::uint32_t block) {
  for (std::uint32_t other = 0; other < state.footings.size(); ++other) {
    if (other != block) {
      state.couplings.at<RegionCoupling>(coupling_row(block, other)) = RegionCoupling{};
    }
  }
}

Matrix6 motion_of(const CompliantBody& body, const Footing& there, const Footing& here) {
  Matrix6 motion = there.share * here.share * motion_between(body.ports, there, here);
  if (there.center != here.center) {
    const bool by_cells = law_of(body.model, body.row).by_cells;
    motion +=
        half_space_coupling({apart(there, here, by_cells), there.normal},
                            {here.center, here.normal}, body.model.bodies.at<Elasticity>(body.row));
  }
  const double thickness = layer_thickness(body.model, body.row, here.normal, here.center);
  if (thickness > 0.0) {
    motion = on_layer(body, motion, there, here, thickness);
  }
  return motion;
}

void find_couplings(const CompliantBody& body) {
  find_some_couplings(body, true, find_some_couplings(body, false, kCouplingsAStep));
}

RegionCoupling& coupling_between(const CompliantBody& body, const Stand& to, const Stand& from) {
  return body.state.couplings.at<RegionCoupling>(coupling_row(to.block, from.block));
}

}  // namespace torsion
