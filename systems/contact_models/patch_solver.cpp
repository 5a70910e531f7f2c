#include "systems/contact_models/patch_solver.hpp"

#include <algorithm>
#include <cmath>

#include "systems/contact_models/add_influence.hpp"

namespace torsion {
namespace {

/// The cells that matter: those that may carry pressure.
struct Window {
  std::uint32_t first_i = 0, end_i = 0;
  std::uint32_t first_j = 0, end_j = 0;
};

/// Columns of displacements are changed in whole rows of the grid, so that they are right at every
/// cell, loaded or not.
void add_pressure(const PatchProblem& problem, const PatchColumns& columns, std::uint32_t i,
                  std::uint32_t j, double change) {
  const InfluenceTables& tables = problem.influences;
  const double scaled = change * problem.compliance;
  const GridBlock block{tables.side, tables.width(), tables.index(i, j, 0, 0)};
  add_influence(block, tables.of(InfluenceKind::kZZ), scaled, columns.depression.data());
  if (problem.coupled) {
    add_influence(block, tables.of(InfluenceKind::kZX), -scaled, columns.moved_x.data());
    add_influence(block, tables.of(InfluenceKind::kZY), -scaled, columns.moved_y.data());
  }
}

void add_traction(const PatchProblem& problem, const PatchColumns& columns, std::uint32_t i,
                  std::uint32_t j, double change_x, double change_y) {
  const InfluenceTables& tables = problem.influences;
  const double x = change_x * problem.compliance;
  const double y = change_y * problem.compliance;
  const GridBlock block{tables.side, tables.width(), tables.index(i, j, 0, 0)};
  add_two_influences(block, tables.of(InfluenceKind::kXX), x, tables.of(InfluenceKind::kXY), y,
                     columns.moved_x.data());
  add_two_influences(block, tables.of(InfluenceKind::kXY), x, tables.of(InfluenceKind::kYY), y,
                     columns.moved_y.data());
  if (problem.coupled) {
    add_two_influences(block, tables.of(InfluenceKind::kZX), x, tables.of(InfluenceKind::kZY), y,
                       columns.depression.data());
  }
}

/// What the cells of one problem share.
struct Relaxation {
  double normal_stiffness = 0.0;      // Pa/m of a cell on its own
  double tangential_stiffness = 0.0;  // Pa/m, the softer way is taken as stiff as the stiffer one
  double least_change = 0.0;          // Pa
};

Relaxation relaxation_of(const PatchProblem& problem) {
  const InfluenceTables& tables = problem.influences;
  const double softest = std::max(tables.self(InfluenceKind::kXX), tables.self(InfluenceKind::kYY));
  return {1.0 / (tables.self(InfluenceKind::kZZ) * problem.compliance),
          1.0 / (softest * problem.compliance), problem.skip * problem.reference};
}

/// @return how far the cell's pressure changed, Pa
double relax_pressure(const PatchProblem& problem, const PatchColumns& columns,
                      const Relaxation& relaxation, std::uint32_t i, std::uint32_t j) {
  const std::uint32_t cell = j * problem.influences.side + i;
  const double before = columns.pressure[cell];
  const double gap = columns.depth[cell] - columns.depression[cell];
  const double after = std::max(0.0, before + gap * relaxation.normal_stiffness);
  const double change = after - before;
  if (std::abs(change) > relaxation.least_change || (after == 0.0 && before > 0.0)) {
    columns.pressure[cell] = after;
    add_pressure(problem, columns, i, j, change);
    return std::abs(change);
  }
  return 0.0;
}

double relax_traction(const PatchProblem& problem, const PatchColumns& columns,
                      const Relaxation& relaxation, std::uint32_t i, std::uint32_t j) {
  const std::uint32_t cell = j * problem.influences.side + i;
  const double limit = columns.friction[cell] * columns.pressure[cell];
  double x = columns.traction_x[cell] +
             (columns.target_x[cell] - columns.moved_x[cell]) * relaxation.tangential_stiffness;
  double y = columns.traction_y[cell] +
             (columns.target_y[cell] - columns.moved_y[cell]) * relaxation.tangential_stiffness;
  const double square = x * x + y * y;
  columns.slips[cell] = 0.0;
  if (square > limit * limit) {
    const double share = limit / std::sqrt(square);
    x *= share;
    y *= share;
    columns.slips[cell] = 1.0;
  }
  const double change_x = x - columns.traction_x[cell];
  const double change_y = y - columns.traction_y[cell];
  const double change = std::max(std::abs(change_x), std::abs(change_y));
  if (change <= relaxation.least_change && limit > 0.0) {
    return 0.0;
  }
  if (change > 0.0) {
    columns.traction_x[cell] = x;
    columns.traction_y[cell] = y;
    add_traction(problem, columns, i, j, change_x, change_y);
  }
  return change;
}

double relax_cell(const PatchProblem& problem, const PatchColumns& columns,
                  const Relaxation& relaxation, std::uint32_t i, std::uint32_t j) {
  const std::uint32_t cell = j * problem.influences.side + i;
  if (columns.pressure[cell] <= 0.0 && columns.depth[cell] <= columns.depression[cell]) {
    columns.slips[cell] = 1.0;
    if (columns.traction_x[cell] == 0.0 && columns.traction_y[cell] == 0.0) {
      return 0.0;
    }
  }
  const double normal = relax_pressure(problem, columns, relaxation, i, j);
  return std::max(normal, relax_traction(problem, columns, relaxation, i, j));
}

/// The box around the cells that overlap or are loaded.
Window window_of(const PatchColumns& columns, std::uint32_t side) {
  Window window{side, 0, side, 0};
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      if (columns.depth[cell] <= 0.0 && columns.pressure[cell] <= 0.0) {
        continue;
      }
      window.first_i = std::min(window.first_i, i);
      window.end_i = std::max(window.end_i, i + 1);
      window.first_j = std::min(window.first_j, j);
      window.end_j = std::max(window.end_j, j + 1);
    }
  }
  return window;
}

/// @return the largest change, Pa
double sweep(const PatchProblem& problem, const PatchColumns& columns, const Relaxation& relaxation,
             const Window& window, bool back) {
  double largest = 0.0;
  const std::uint32_t columns_count = window.end_i - window.first_i;
  const std::uint32_t rows_count = window.end_j - window.first_j;
  for (std::uint32_t row = 0; row < rows_count; ++row) {
    const std::uint32_t j = back ? window.end_j - 1 - row : window.first_j + row;
    for (std::uint32_t column = 0; column < columns_count; ++column) {
      const std::uint32_t i = back ? window.end_i - 1 - column : window.first_i + column;
      largest = std::max(largest, relax_cell(problem, columns, relaxation, i, j));
    }
  }
  return largest;
}

}  // namespace

PatchOutcome solve_patch(const PatchProblem& problem, const PatchColumns& columns) {
  PatchOutcome outcome;
  const Window window = window_of(columns, problem.influences.side);
  std::ranges::fill(columns.slips, 1.0);
  if (window.end_i == 0 || problem.reference <= 0.0) {
    return outcome;
  }
  const Relaxation relaxation = relaxation_of(problem);
  while (outcome.sweeps < problem.sweeps) {
    // Forth and back in turn: a fixed order would leave its own pattern in what is left to solve.
    const bool back = outcome.sweeps % 2 == 1;
    outcome.residual = sweep(problem, columns, relaxation, window, back) / problem.reference;
    ++outcome.sweeps;
    if (outcome.residual <= problem.skip) {
      break;
    }
  }
  return outcome;
}

void displace_patch(const PatchProblem& problem, const PatchColumns& columns) {
  std::ranges::fill(columns.depression, 0.0);
  std::ranges::fill(columns.moved_x, 0.0);
  std::ranges::fill(columns.moved_y, 0.0);
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < problem.influences.side; ++j) {
    for (std::uint32_t i = 0; i < problem.influences.side; ++i, ++cell) {
      if (columns.pressure[cell] > 0.0) {
        add_pressure(problem, columns, i, j, columns.pressure[cell]);
        add_traction(problem, columns, i, j, columns.traction_x[cell], columns.traction_y[cell]);
      }
    }
  }
}

void unload_cell(const PatchProblem& problem, const PatchColumns& columns, std::uint32_t cell) {
  const std::uint32_t i = cell % problem.influences.side;
  const std::uint32_t j = cell / problem.influences.side;
  add_pressure(problem, columns, i, j, -columns.pressure[cell]);
  add_traction(problem, columns, i, j, -columns.traction_x[cell], -columns.traction_y[cell]);
  columns.pressure[cell] = 0.0;
  columns.traction_x[cell] = 0.0;
  columns.traction_y[cell] = 0.0;
}

}  // namespace torsion
