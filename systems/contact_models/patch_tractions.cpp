// The tangential tractions of the contact model `patch`.

#include <algorithm>
#include <array>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>

#include "systems/contact_models/local_inverse.hpp"
#include "systems/contact_models/patch_sums.hpp"

namespace torsion {
namespace {

constexpr double kInside = 1.0 + 1e-9;  // of a limit's square
// Of what is asked, where there is no telling how far to go: the local inverse asks for too much of
// what is smooth, the more so the more cells lie across it.
constexpr double kCalm = 0.6;
constexpr double kCalmSide = 16.0;  // cells along a side, beyond which it is less
constexpr double kShort = 0.05;     // of a step: so bent that it leads nowhere

struct Inverses {
  LocalInverse x;
  LocalInverse y;
  double stiffness = 0.0;  // Pa/m of a cell on its own
};

/// What one sweep finds.
struct Sweep {
  double square = 0.0;  // of the residual under the preconditioner
  TractionStep step;
};

TractionColumns columns_of(PatchWork& work) {
  TractionColumns cells{};
  cells.count = whole_lanes(work.cells.size());
  std::array<double**, kTractionColumns> each{
      &cells.traction_x, &cells.traction_y, &cells.target_x, &cells.target_y,   &cells.moved_x,
      &cells.moved_y,    &cells.limit,      &cells.slips,    &cells.residual_x, &cells.residual_y,
      &cells.asked_x,    &cells.asked_y,    &cells.along_x,  &cells.along_y,    &cells.softened,
      &cells.step_x,     &cells.step_y,     &cells.clips,    &cells.moves_x,    &cells.moves_y};
  for (std::size_t k = 0; k < each.size(); ++k) {
    *each[k] = work.listed.data() + k * cells.count;
  }
  return cells;
}

/// Listed values to their cells among those with a border.
void spread(const PatchWork& work, const double* listed, std::vector<double>& bordered) {
  for (std::size_t k = 0; k < work.cells.size(); ++k) {
    bordered[work.bordered[k]] = listed[k];
  }
}

/// Values of cells (by number, or by their rows among those with a border) to the list.
void gather(const PatchWork& work, const std::vector<std::uint32_t>& rows,
            std::span<const double> values, double* listed) {
  for (std::size_t k = 0; k < work.cells.size(); ++k) {
    listed[k] = values[rows[k]];
  }
}

/// What a displacement of the listed cells asks for, at all cells with a border.
void ask_for(const PatchProblem& problem, const Inverses& inverses, const double* x,
             const double* y, PatchWork& work, std::vector<double>& asked_x,
             std::vector<double>& asked_y) {
  const std::uint32_t side = problem.influences.side;
  spread(work, x, work.residual_x);
  spread(work, y, work.residual_y);
  apply_local_inverse(inverses.x, 1.0 / problem.compliance, side, work.residual_x.data(),
                      asked_x.data());
  apply_local_inverse(inverses.y, 1.0 / problem.compliance, side, work.residual_y.data(),
                      asked_y.data());
}

/// As for the pressures (patch_pressures.cpp): to sliding along x and y, and turning.
void yield_to_rigid_motions(const PatchProblem& problem, const Inverses& inverses,
                            const TractionColumns& cells, PatchWork& work) {
  glm::dmat3 stiffness(0.0);
  glm::dvec3 asked(0.0);
  // Lists in columns that the pressures no longer need.
  const auto motion_x = [&work](std::size_t k) {
    return work.rigid_x[k].data();
  };
  const auto motion_y = [&work](std::size_t k) {
    return work.rigid_y[k].data();
  };
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t row = 0; row < work.cells.size(); ++row) {
      const std::uint32_t cell = work.cells[row];
      motion_x(k)[row] = k == 2 ? -problem.support.place_y[cell] : (k == 0 ? 1.0 : 0.0);
      motion_y(k)[row] = k == 2 ? problem.support.place_x[cell] : (k == 1 ? 1.0 : 0.0);
    }
    std::fill_n(motion_x(k) + work.cells.size(), cells.count - work.cells.size(), 0.0);
    std::fill_n(motion_y(k) + work.cells.size(), cells.count - work.cells.size(), 0.0);
    std::copy_n(motion_x(k), cells.count, cells.moves_x);
    std::copy_n(motion_y(k), cells.count, cells.moves_y);
    keep_answered(cells, cells.moves_x, cells.moves_y);
    ask_for(problem, inverses, cells.moves_x, cells.moves_y, work, work.asked_x, work.asked_y);
    double* const asks_x = work.rigid_asks_x[k].data();
    double* const asks_y = work.rigid_asks_y[k].data();
    gather(work, work.bordered, work.asked_x, asks_x);
    gather(work, work.bordered, work.asked_y, asks_y);
    std::fill_n(asks_x + work.cells.size(), cells.count - work.cells.size(), 0.0);
    std::fill_n(asks_y + work.cells.size(), cells.count - work.cells.size(), 0.0);
    const auto column = static_cast<int>(k);
    asked[column] =
        dot(cells.count, asks_x, cells.residual_x) + dot(cells.count, asks_y, cells.residual_y);
    std::copy_n(asks_x, cells.count, cells.moves_x);
    std::copy_n(asks_y, cells.count, cells.moves_y);
    keep_answered(cells, cells.moves_x, cells.moves_y);
    for (std::size_t other = 0; other <= k; ++other) {
      const auto row = static_cast<int>(other);
      stiffness[column][row] = stiffness[row][column] =
          dot(cells.count, cells.moves_x, motion_x(other)) +
          dot(cells.count, cells.moves_y, motion_y(other));
    }
  }
  const glm::dmat3& yields = problem.support.slides;
  const glm::dvec3 back = glm::inverse(glm::dmat3(1.0) + yields * stiffness) * (yields * asked);
  for (std::size_t k = 0; k < 3; ++k) {
    const double share = -back[static_cast<int>(k)];
    add_scaled(cells.count, share, work.rigid_asks_x[k].data(), cells.asked_x);
    add_scaled(cells.count, share, work.rigid_asks_y[k].data(), cells.asked_y);
  }
}

/// What is left of every loaded cell's way, and what it asks for.
/// @return the sum of the residual's squares under the preconditioner
double ask(const PatchProblem& problem, const Inverses& inverses, const TractionColumns& cells,
           PatchWork& work) {
  find_ways(cells, inverses.stiffness);
  ask_for(problem, inverses, cells.residual_x, cells.residual_y, work, work.asked_x, work.asked_y);
  gather(work, work.bordered, work.asked_x, cells.asked_x);
  gather(work, work.bordered, work.asked_y, cells.asked_y);
  if (problem.support.soft) {
    yield_to_rigid_motions(problem, inverses, cells, work);
  }
  return dot(cells.count, cells.residual_x, cells.asked_x) +
         dot(cells.count, cells.residual_y, cells.asked_y);
}

/// What every cell asks for if its neighbours stay.
void ask_alone(const Inverses& inverses, const TractionColumns& cells) {
  for (std::size_t k = 0; k < cells.count; ++k) {
    cells.asked_x[k] = inverses.stiffness * cells.residual_x[k];
    cells.asked_y[k] = inverses.stiffness * cells.residual_y[k];
  }
}

/// What the step displaces.
/// @return the energy's curvature along it, Pa m
double move(const PatchProblem& problem, const TractionColumns& cells, PatchWork& work) {
  move_by_traction(problem, cells.step_x, cells.step_y, work);
  gather(work, work.cells, work.moves_x, cells.moves_x);
  gather(work, work.cells, work.moves_y, cells.moves_y);
  return dot(cells.count, cells.step_x, cells.moves_x) +
         dot(cells.count, cells.step_y, cells.moves_y);
}

/// Lists the cells that carry a load or have to lose one, and the pairs that they are in.
void list_cells(const PatchColumns& columns, const InfluenceTables& tables, PatchWork& work) {
  const std::uint32_t side = tables.side;
  const auto width = static_cast<std::uint32_t>(tables.width());
  const std::uint32_t above = side > 1 ? side : 0;
  find_loads(columns.pressure.size(), columns.friction.data(), columns.pressure.data(),
             columns.traction_x.data(), columns.traction_y.data(), work.moves_x.data());
  work.cells.resize(columns.pressure.size() + 1);
  std::uint32_t count = 0;
  std::uint32_t pairs = 0;
  for (std::uint32_t row = 0; row < side; row += 2) {
    const PairedRows rows = paired_rows(side, row);
    std::uint32_t cell = rows.row * side;
    std::uint32_t bordered = (rows.row + 1) * (side + 2) + 1;
    for (std::uint32_t i = 0; i < side; ++i, ++cell, ++bordered) {
      const std::uint32_t first = rows.first * work.moves_x[cell] > 0.0 ? 1 : 0;
      const std::uint32_t second = rows.second * work.moves_x[cell + above] > 0.0 ? 1 : 0;
      work.cells[count] = cell;
      work.bordered[count] = bordered;
      work.slots[count] = 2 * pairs;
      count += first;
      work.cells[count] = cell + above;
      work.bordered[count] = bordered + side + 2;
      work.slots[count] = 2 * pairs + 1;
      count += second;
      work.places[pairs] = rows.row * width + i;
      pairs += first | second;
    }
  }
  work.cells.resize(count);
  work.pairs = pairs;
  std::fill_n(work.scales_x.begin(), 2 * pairs, 0.0);
  std::fill_n(work.scales_y.begin(), 2 * pairs, 0.0);
}

/// Fills the list's columns.
/// @return true when a traction lies outside its disc
bool load(const PatchColumns& columns, const TractionColumns& cells, PatchWork& work) {
  for (std::size_t k = 0; k < kTractionColumns; ++k) {
    std::fill_n(work.listed.data() + k * cells.count + work.cells.size(),
                cells.count - work.cells.size(), 0.0);
  }
  std::fill_n(cells.step_x, cells.count, 0.0);
  std::fill_n(cells.step_y, cells.count, 0.0);
  std::ranges::fill(work.residual_x, 0.0);
  std::ranges::fill(work.residual_y, 0.0);
  std::ranges::fill(work.step_x, 0.0);
  std::ranges::fill(work.step_y, 0.0);
  bool outside = false;
  for (std::size_t k = 0; k < work.cells.size(); ++k) {
    const std::uint32_t cell = work.cells[k];
    const double limit = columns.friction[cell] * columns.pressure[cell];
    const double x = columns.traction_x[cell];
    const double y = columns.traction_y[cell];
    cells.limit[k] = limit;
    cells.traction_x[k] = x;
    cells.traction_y[k] = y;
    cells.target_x[k] = columns.target_x[cell];
    cells.target_y[k] = columns.target_y[cell];
    cells.moved_x[k] = columns.moved_x[cell];
    cells.moved_y[k] = columns.moved_y[cell];
    outside = outside || x * x + y * y > kInside * limit * limit;
  }
  return outside;
}

void store(const TractionColumns& cells, const PatchWork& work, const PatchColumns& columns) {
  std::ranges::fill(columns.slips, 1.0);
  for (std::size_t k = 0; k < work.cells.size(); ++k) {
    const std::uint32_t cell = work.cells[k];
    columns.traction_x[cell] = cells.traction_x[k];
    columns.traction_y[cell] = cells.traction_y[k];
    columns.slips[cell] = cells.slips[k];
  }
}

/// Goes `length` of the step.
SweepChange go(const PatchColumns& columns, const TractionColumns& cells, double length,
               const PatchWork& work) {
  const std::size_t count = columns.moved_x.size();
  add_scaled(count, length, work.moves_x.data(), columns.moved_x.data());
  add_scaled(count, length, work.moves_y.data(), columns.moved_y.data());
  return change_tractions(cells, length);
}

}  // namespace

PatchOutcome relax_tractions(const PatchProblem& problem, const PatchColumns& columns,
                             PatchWork& work) {
  const InfluenceTables& tables = problem.influences;
  const double softest = std::max(tables.self(InfluenceKind::kXX), tables.self(InfluenceKind::kYY));
  const Inverses inverses{local_inverse(tables, InfluenceKind::kXX),
                          local_inverse(tables, InfluenceKind::kYY),
                          1.0 / (softest * problem.compliance)};
  list_cells(columns, tables, work);
  const TractionColumns cells = columns_of(work);
  bool outside = load(columns, cells, work);
  PatchOutcome outcome;
  double before = 0.0;  // the residual's square, 0: no direction to keep
  double whole = problem.foreseen_traction;
  bool alone = false;
  const double fewer = std::min(1.0, kCalmSide / static_cast<double>(tables.side));
  const double calm = kCalm * fewer * fewer;
  while (outcome.sweeps < problem.sweeps) {
    Sweep sweep;
    sweep.square = ask(problem, inverses, cells, work);
    const double kept = before > 0.0 ? sweep.square / before : 0.0;
    sweep.step = mix_tractions(cells, {outside ? calm : 1.0, kept});
    if (!outside && (alone || sweep.step.slope <= 0.0)) {
      // Beside cells that slip the neighbours' share may lead uphill; each cell's own does not.
      ask_alone(inverses, cells);
      const double clipped = sweep.step.clipped;
      sweep.step = mix_tractions(cells, {1.0, 0.0});
      sweep.step.clipped += clipped;
    }
    const double stiffness = move(problem, cells, work);
    if (stiffness <= 0.0) {
      outcome.residual = 0.0;
      break;
    }
    // A first step brings all tractions into their discs, so it goes all the way. Where something
    // slips, a step ends on the discs' rims: no farther.
    const double best = outside ? 1.0 : sweep.step.slope / stiffness;
    const double length = sweep.step.slips > 0.0 ? std::clamp(best, 0.0, 1.0) : best;
    alone = length < kShort;
    outside = false;
    const SweepChange change = go(columns, cells, length, work);
    before = sweep.step.clipped > 0.0 ? 0.0 : sweep.square;
    whole = std::max(whole, change.sum);
    outcome.residual = change.largest / problem.reference;
    ++outcome.sweeps;
    if (!alone && ends(problem, change, whole)) {
      break;
    }
  }
  store(cells, work, columns);
  return outcome;
}

}  // namespace torsion
