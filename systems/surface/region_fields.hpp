#pragma once

// From how far the surface has turned around a contact to the bonded discs that turn it so.

#include <array>
#include <cstddef>
#include <span>

#include "ecs/components.hpp"
#include "ecs/snapshot.hpp"
#include "ecs/state.hpp"

namespace torsion::engine {

struct SnapshotTables;  // systems/surface/take_snapshot.hpp

// Rings about the contact's middle, one a disc and seven beyond the rim: what the surface does
// there tells discs of about the contact's own size apart.
inline constexpr std::size_t kRings = kFieldDiscs + 8;

/// How far discs of radius (j + 1) / kFieldDiscs, turned by 1 rad, turn the rings.
struct RingProfiles {
  std::array<std::array<double, kFieldDiscs>, kRings> turn{};
};

/// Source: Reissner & Sagoci, J. Appl. Phys. 15, 1944: outside a bonded disc of radius s the
/// surface turns by 2 / pi (asin(s / r) - s / r sqrt(1 - s^2 / r^2)) of the disc's angle.
RingProfiles make_ring_profiles();

/// What points of the surface say, summed up ring by ring; lengths over the contact's radius.
struct RingTurns {
  std::array<double, kRings> weight{};  // r^2
  std::array<double, kRings> around{};  // r^2 times the turn, rad

  /// A point at distance r, shared between the two nearest rings; none beyond the last.
  /// @param moved  displacement around the middle over the radius
  void add(double r, double moved);
};

/// The discs that turn the rings as nearly as discs can and have the couple: least squares, by
/// which neighbours differ no more than they must.
/// @param couple  of all discs over that of the largest when it turns by 1 rad
/// @param calm    weight of neighbours' differences, relative; the fewer points, the more they need
/// @param turn    (kFieldDiscs) out: rad
void discs_of_ring_turns(const RingProfiles& profiles, const RingTurns& rings, double couple,
                         double calm, std::span<double> turn);

/// Sums up every region of a half-space model for drawing: forces block by block, and the bonded
/// discs that turn the surface as its cells have turned and have the region's couple. Writes
/// RegionField.
void region_fields(const Model& model, const State& state, const SnapshotTables& tables,
                   Snapshot& snapshot);

}  // namespace torsion::engine
