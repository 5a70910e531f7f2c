#include "systems/surface/region_fields.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/contact/law.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/stick_slip.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/lanes.hpp"
#include "systems/math/linear_algebra.hpp"
#include "systems/mdr/places.hpp"
#include "systems/surface/take_snapshot.hpp"

namespace torsion::engine {
namespace {

constexpr auto kDiscs = static_cast<double>(kFieldDiscs);

double surface_turn(double r, double s) {
  if (r <= s) {
    return 1.0;
  }
  const double x = s / r;
  return 2.0 / std::numbers::pi * (std::asin(x) - x * std::sqrt(1.0 - x * x));
}

/// Matrix and right sides of the least squares: the rings' turns, and the couple.
struct TurnFit {
  std::array<double, std::size_t{kFieldDiscs} * kFieldDiscs> matrix{};
  std::array<double, std::size_t{kFieldDiscs} * 2> right{};
};

TORSION_WIDEST
void add_rings(const RingProfiles& profiles, const RingTurns& rings, TurnFit& fit) {
  for (std::size_t ring = 0; ring < kRings; ++ring) {
    const double* const turn = profiles.turn[ring].data();
    for (std::size_t j = 0; j < kFieldDiscs; ++j) {
      const double weighted = rings.weight[ring] * turn[j];
      for (std::size_t k = 0; k < kFieldDiscs; ++k) {
        fit.matrix[j * kFieldDiscs + k] += weighted * turn[k];
      }
      fit.right[2 * j] += rings.around[ring] * turn[j];
    }
  }
}

/// Differences of neighbours, and a little of the discs themselves, so that two equal ones remain
/// distinguishable.
void add_calm(double weight, TurnFit& fit) {
  constexpr double kOfItself = 1e-6;
  for (std::size_t j = 0; j < kFieldDiscs; ++j) {
    double* const row = &fit.matrix[j * kFieldDiscs];
    const bool ends = j == 0 || j + 1 == kFieldDiscs;
    row[j] += weight * ((ends ? 1.0 : 2.0) + kOfItself);
    if (j + 1 < kFieldDiscs) {
      row[j + 1] -= weight;  // the solver reads what is right of the diagonal
    }
  }
}

/// Couple of a disc over that of the largest.
double couple_share(std::size_t disc) {
  const double s = static_cast<double>(disc + 1) / kDiscs;
  return s * s * s;
}

}  // namespace

RingProfiles make_ring_profiles() {
  // A ring's points lie on both sides of it, with the weights of RingTurns::add: its profile is the
  // mean over evenly spread points.
  constexpr int kSlices = 64;
  RingProfiles profiles;
  for (std::size_t ring = 0; ring < kRings; ++ring) {
    double weights = 0.0;
    for (int slice = -kSlices; slice < kSlices; ++slice) {
      const double off = (slice + 0.5) / kSlices;
      const double r = (static_cast<double>(ring) + off) / kDiscs;
      if (r <= 0.0) {
        continue;
      }
      const double weight = (1.0 - std::abs(off)) * r * r * r;
      weights += weight;
      for (std::size_t j = 0; j < kFieldDiscs; ++j) {
        profiles.turn[ring][j] += weight * surface_turn(r, static_cast<double>(j + 1) / kDiscs);
      }
    }
    for (double& turn : profiles.turn[ring]) {
      turn /= weights;
    }
  }
  return profiles;
}

void RingTurns::add(double r, double moved) {
  const double place = r * kDiscs;
  if (place >= static_cast<double>(kRings - 1)) {
    return;
  }
  const auto ring = static_cast<std::size_t>(place);
  const double outer = place - static_cast<double>(ring);
  weight[ring] += (1.0 - outer) * r * r;
  weight[ring + 1] += outer * r * r;
  around[ring] += (1.0 - outer) * r * moved;
  around[ring + 1] += outer * r * moved;
}

void discs_of_ring_turns(const RingProfiles& profiles, const RingTurns& rings, double couple,
                         double calm, std::span<double> turn) {
  TurnFit fit;
  add_rings(profiles, rings, fit);
  double weights = 0.0;
  for (const double weight : rings.weight) {
    weights += weight;
  }
  add_calm(calm * weights, fit);
  for (std::size_t j = 0; j < kFieldDiscs; ++j) {
    fit.right[2 * j + 1] = couple_share(j);
  }
  solve_symmetric(kFieldDiscs, kFieldDiscs, fit.matrix.data(), 2, fit.right.data(), 1e-12);
  // The rings' turns, and of the profile that raises the couple at the least cost as much as is
  // missing.
  double found = 0.0;
  double raised = 0.0;
  for (std::size_t j = 0; j < kFieldDiscs; ++j) {
    found += couple_share(j) * fit.right[2 * j];
    raised += couple_share(j) * fit.right[2 * j + 1];
  }
  const double lacking = (couple - found) / raised;
  for (std::size_t j = 0; j < kFieldDiscs; ++j) {
    turn[j] = fit.right[2 * j] + lacking * fit.right[2 * j + 1];
  }
}

namespace {

// A uniform pressure on a square of width b displaces its middle as far as a point load spread over
// b / (4 ln(1 + sqrt(2))) (Johnson, 1985, eq. 3.25).
constexpr double kSpreadOverBlock = 0.2837;

/// Found by trial on a ball's partial slip, 8 to 24 cells a side: with less, single cells show;
/// with more, the field is distorted.
double calm_of(std::uint32_t side) {
  const double share = 0.12 / static_cast<double>(side);
  return share * share;
}

/// One region.
struct Source {
  const RegionFrame& frame;
  std::uint32_t side;
  double cell_area;  // m^2
  std::span<const CellTraction> tractions;
};

/// Divides `force` among the blocks in proportion to the cells' pressures.
/// @return the pressure centre
glm::dvec2 press_blocks(const Source& source, double force_in_all, RegionField& field) {
  glm::dvec2 center(0.0);
  double total = 0.0;
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < source.side; ++j) {
    for (std::uint32_t i = 0; i < source.side; ++i, ++cell) {
      const CellTraction& traction = source.tractions[cell];
      const double force = traction.pressure * traction.coverage * source.cell_area;
      if (force <= 0.0) {
        continue;
      }
      const glm::dvec2 place = cell_center(source.frame, source.side, i, j);
      PressedBlock& block = field.blocks[j * kFieldBlocks / source.side * kFieldBlocks +
                                         i * kFieldBlocks / source.side];
      block.force += force;
      block.place += place * force;
      center += place * force;
      total += force;
    }
  }
  for (PressedBlock& block : field.blocks) {
    block.place = block.force > 0.0 ? block.place / block.force : glm::dvec2(0.0);
    block.force *= total > 0.0 ? force_in_all / total : 0.0;
  }
  return total > 0.0 ? center / total : glm::dvec2(0.0);
}

/// Radius of the disc with the second moment of the loaded cells about the centre, m: a blade's
/// turn acts farther out than that of a disc of its area.
double radius_of_moment(const Source& source, const glm::dvec2& center) {
  double squares = 0.0;
  double count = 0.0;
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < source.side; ++j) {
    for (std::uint32_t i = 0; i < source.side; ++i, ++cell) {
      if (source.tractions[cell].pressure > 0.0) {
        const glm::dvec2 arm = cell_center(source.frame, source.side, i, j) - center;
        squares += glm::dot(arm, arm);
        count += 1.0;
      }
    }
  }
  return std::sqrt(2.0 * squares * inverse_of(count));  // of a disc: a^2 / 2
}

/// The region's couple on the material, about the field's centre, N m.
double couple_of(const Source& source, const RegionField& field) {
  double couple = 0.0;
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < source.side; ++j) {
    for (std::uint32_t i = 0; i < source.side; ++i, ++cell) {
      const CellTraction& traction = source.tractions[cell];
      const glm::dvec2 arm = cell_center(source.frame, source.side, i, j) - field.center;
      couple -= traction.coverage * source.cell_area *
                (arm.x * traction.traction.y - arm.y * traction.traction.x);
    }
  }
  return couple;
}

/// How far the cells have gone around the field's centre: all of the grid's cells, in contact or
/// not.
RingTurns turns_of_cells(const State& state, std::uint32_t region, const Source& source,
                         const RegionField& field) {
  const Range cells = state.regions.at<RegionIdentity>(region).cells;
  const std::span<const PatchMovedX> moved_x = state.patch_cells.rows<PatchMovedX>(cells);
  const std::span<const PatchMovedY> moved_y = state.patch_cells.rows<PatchMovedY>(cells);
  glm::dvec2 drift(0.0);  // of all that is pressed
  double pressure = 0.0;
  for (std::uint32_t cell = 0; cell < cells.count; ++cell) {
    const double pressed = source.tractions[cell].pressure;
    drift += pressed * glm::dvec2(moved_x[cell].value, moved_y[cell].value);
    pressure += pressed;
  }
  drift *= inverse_of(pressure);
  RingTurns rings;
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < source.side; ++j) {
    for (std::uint32_t i = 0; i < source.side; ++i, ++cell) {
      const glm::dvec2 arm =
          (cell_center(source.frame, source.side, i, j) - field.center) / field.radius;
      const glm::dvec2 moved = glm::dvec2(moved_x[cell].value, moved_y[cell].value) - drift;
      const double r = glm::length(arm);
      rings.add(r, (arm.x * moved.y - arm.y * moved.x) * inverse_of(r * field.radius));
    }
  }
  return rings;
}

/// Divides a disc of any radius between the two nearest ones of the field, with its angle and its
/// couple.
void add_disc(RegionField& field, double radius_share, double turn) {
  const double place = std::clamp(radius_share * kFieldDiscs, 1.0, double{kFieldDiscs});
  const auto lower = std::min(static_cast<std::size_t>(place), std::size_t{kFieldDiscs - 1});
  const auto cube = [](double x) {
    return x * x * x;
  };
  const auto low = static_cast<double>(lower);
  const double share = (cube(place) - cube(low)) / (cube(low + 1.0) - cube(low));
  field.turn[lower - 1] += (1.0 - share) * turn;
  field.turn[lower] += share * turn;
}

/// The springs' deflections grow inwards; each growth is a disc.
void discs_of_layers(const MdrFoundation& foundation, std::span<const MdrLayer> layers,
                     RegionField& field) {
  double place = 1.0;
  double turn = 0.0;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    add_disc(field, 0.5 * (place + foundation.place[k]), layers[k].turn - turn);
    place = foundation.place[k];
    turn = layers[k].turn;
  }
}

void fill_field(const Model& model, const State& state, const SnapshotTables& tables,
                std::uint32_t region, KeptColumns kept, RegionField& field) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const std::uint32_t side = model.settings.grid_side;
  const glm::dvec2 cell = 2.0 * frame.half_size / static_cast<double>(side);
  const Source source{frame, side, cell.x * cell.y, state.cells.rows<CellTraction>(identity.cells)};
  field.radius = state.regions.at<Contact>(region).radius;
  if (field.radius <= 0.0) {
    return;
  }
  field.spread = kSpreadOverBlock * 2.0 * std::min(frame.half_size.x, frame.half_size.y) /
                 static_cast<double>(kFieldBlocks);
  field.center = press_blocks(source, state.regions.at<RegionNormal>(region).force, field);
  if (kept == KeptColumns::kSurfaceCells) {
    field.radius = std::max(field.radius, radius_of_moment(source, field.center));
  }
  if (kept == KeptColumns::kSpringLayers) {
    const std::uint32_t block = block_of(identity);
    const MdrState& own = state.regions.at<MdrState>(region);
    const MdrPlaces places = places_of(tables.mdr, {own.flat_share, own.elongation});
    discs_of_layers(places.turn, state.mdr_layers.rows<MdrLayer>({block * kMdrLayers, kMdrLayers}),
                    field);
    return;
  }
  const double shear_modulus = model.bodies.at<Elasticity>(identity.body).shear_modulus();
  const double stiffness = 16.0 / 3.0 * shear_modulus * field.radius * field.radius * field.radius;
  discs_of_ring_turns(tables.rings, turns_of_cells(state, region, source, field),
                      couple_of(source, field) / stiffness, calm_of(side), field.turn);
}

}  // namespace

void region_fields(const Model& model, const State& state, const SnapshotTables& tables,
                   Snapshot& snapshot) {
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    const std::uint32_t body = state.regions.at<RegionIdentity>(region).body;
    const KeptColumns kept = law_of(model, body).keeps;
    if (kept != KeptColumns::kNone) {
      fill_field(model, state, tables, region, kept,
                 snapshot.region_fields.at<RegionField>(region));
    }
  }
}

}  // namespace torsion::engine
