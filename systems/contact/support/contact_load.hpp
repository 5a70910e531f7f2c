#pragma once

#include <cstdint>

#include "ecs/state.hpp"
#include "systems/contact/support/footing.hpp"

namespace torsion {

/// What a region's contact does to the material.
struct ContactLoad {
  SupportMoments moments{};          // N: of its forces, in a footing's SupportField
  Vector6 wrench = Vector6::Zero();  // N, N m about the footing's centre
};

PortCompliance ports_of(const Model& model, std::uint32_t body);

/// The ellipse that has the area and the second moments of the cells that carry pressure; the
/// region's disc where the contact model has no pressures cell by cell.
ContactEllipse contact_ellipse(const Model& model, const State& state, std::uint32_t region);

/// Contact model patch: cell by cell. The others: force and couple as a ball spreads them.
ContactLoad contact_load(const Model& model, const State& state, std::uint32_t region,
                         const Footing& footing);

}  // namespace torsion
