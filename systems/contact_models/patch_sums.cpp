#include "systems/contact_models/patch_sums.hpp"

#include <cstring>

namespace torsion {
namespace {

void add(std::span<double> to, double scale, const std::vector<double>& values) {
  for (std::size_t cell = 0; cell < to.size(); ++cell) {
    to[cell] += scale * values[cell];
  }
}

/// displacement = what the sources do by one table.
void sum_of(const PatchProblem& problem, const InfluenceSources& sources, InfluenceKind kind,
            const std::vector<double>& scales, std::vector<double>& displacement) {
  sum_influence(block_of(problem.influences), sources, problem.influences.of(kind), scales.data(),
                nullptr, displacement.data());
}

/// moves_x, moves_y = displacement along the surface by what has been gathered.
void sum_tractions(const PatchProblem& problem, const InfluenceSources& sources, PatchWork& work) {
  const InfluenceTables& tables = problem.influences;
  const GridBlock block = block_of(tables);
  for (std::size_t k = 0; k < std::size_t{2} * sources.count; ++k) {
    work.scales[k] = work.scales_x[k] + work.scales_y[k];
  }
  const double* const both = work.moves_both.data();
  sum_of(problem, sources, InfluenceKind::kXY, work.scales, work.moves_both);
  sum_influence(block, sources, tables.of(InfluenceKind::kXXLessXY), work.scales_x.data(), both,
                work.moves_x.data());
  sum_influence(block, sources, tables.of(InfluenceKind::kYYLessXY), work.scales_y.data(), both,
                work.moves_y.data());
}

/// So short that a call of memcpy would take longer.
void copy_row(std::uint32_t side, const double* from, double* to) {
  constexpr std::uint32_t kFew = 4;
  std::uint32_t i = 0;
  for (; i + kFew <= side; i += kFew) {
    std::memcpy(to + i, from + i, kFew * sizeof(double));
  }
  for (; i < side; ++i) {
    to[i] = from[i];
  }
}

/// Gathers the cells where one of the changes is not zero; scales become displacements per table.
/// @param change_x, change_y  Pa, (side x side)
InfluenceSources gather_sources(const PatchProblem& problem, std::span<const double> change_x,
                                std::span<const double> change_y, PatchWork& work) {
  const std::uint32_t side = problem.influences.side;
  const auto width = static_cast<std::uint32_t>(problem.influences.width());
  const std::uint32_t above = side > 1 ? side : 0;
  std::uint32_t count = 0;
  for (std::uint32_t row = 0; row < side; row += 2) {
    const PairedRows rows = paired_rows(side, row);
    const double first = rows.first * problem.compliance;
    const double second = rows.second * problem.compliance;
    std::uint32_t cell = rows.row * side;
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      double* const x = &work.scales_x[std::size_t{2} * count];
      double* const y = &work.scales_y[std::size_t{2} * count];
      x[0] = first * change_x[cell];
      x[1] = second * change_x[cell + above];
      y[0] = first * change_y[cell];
      y[1] = second * change_y[cell + above];
      work.places[count] = rows.row * width + i;
      count += x[0] != 0.0 || x[1] != 0.0 || y[0] != 0.0 || y[1] != 0.0 ? 1U : 0U;
    }
  }
  return {work.places.data(), count};
}

}  // namespace

void to_border(std::uint32_t side, std::span<const double> cells, std::span<double> bordered) {
  for (std::size_t j = 0; j < side; ++j) {
    copy_row(side, &cells[j * side], &bordered[(j + 1) * (side + 2) + 1]);
  }
}

void from_border(std::uint32_t side, std::span<const double> bordered, std::span<double> cells) {
  for (std::size_t j = 0; j < side; ++j) {
    copy_row(side, &bordered[(j + 1) * (side + 2) + 1], &cells[j * side]);
  }
}

void add_sideways(const PatchProblem& problem, const PatchColumns& columns,
                  std::span<const double> change, PatchWork& work) {
  const InfluenceSources sources = gather_sources(problem, change, change, work);
  // Minus: by reciprocity (influence.hpp).
  sum_of(problem, sources, InfluenceKind::kZX, work.scales_x, work.moves_x);
  sum_of(problem, sources, InfluenceKind::kZY, work.scales_x, work.moves_y);
  add(columns.moved_x, -1.0, work.moves_x);
  add(columns.moved_y, -1.0, work.moves_y);
}

void add_depression(const PatchProblem& problem, const PatchColumns& columns,
                    std::span<const double> change_x, std::span<const double> change_y,
                    PatchWork& work) {
  const InfluenceSources sources = gather_sources(problem, change_x, change_y, work);
  sum_of(problem, sources, InfluenceKind::kZX, work.scales_x, work.moves_x);
  sum_of(problem, sources, InfluenceKind::kZY, work.scales_y, work.moves_y);
  add(columns.depression, 1.0, work.moves_x);
  add(columns.depression, 1.0, work.moves_y);
}

void add_pressure(const PatchProblem& problem, const PatchColumns& columns,
                  std::span<const double> change, PatchWork& work) {
  const InfluenceSources sources = gather_sources(problem, change, change, work);
  sum_of(problem, sources, InfluenceKind::kZZ, work.scales_x, work.moves_x);
  add(columns.depression, 1.0, work.moves_x);
  if (problem.coupled) {
    add_sideways(problem, columns, change, work);
  }
}

void add_tractions(const PatchProblem& problem, const PatchColumns& columns,
                   std::span<const double> change_x, std::span<const double> change_y,
                   PatchWork& work) {
  sum_tractions(problem, gather_sources(problem, change_x, change_y, work), work);
  add(columns.moved_x, 1.0, work.moves_x);
  add(columns.moved_y, 1.0, work.moves_y);
  if (problem.coupled) {
    add_depression(problem, columns, change_x, change_y, work);
  }
}

void move_by_pressure(const PatchProblem& problem, PatchWork& work) {
  const InfluenceTables& tables = problem.influences;
  const std::uint32_t side = tables.side;
  const auto width = static_cast<std::uint32_t>(tables.width());
  const std::uint32_t above = side > 1 ? side + 2 : 0;
  std::uint32_t count = 0;
  for (std::uint32_t row = 0; row < side; row += 2) {
    const PairedRows rows = paired_rows(side, row);
    const double first = rows.first * problem.compliance;
    const double second = rows.second * problem.compliance;
    const double* step = work.step.data() + std::size_t{rows.row + 1} * (side + 2) + 1;
    for (std::uint32_t i = 0; i < side; ++i, ++step) {
      double* const scales = &work.scales_x[std::size_t{2} * count];
      scales[0] = first * step[0];
      scales[1] = second * step[above];
      work.places[count] = rows.row * width + i;
      count += scales[0] != 0.0 || scales[1] != 0.0 ? 1U : 0U;
    }
  }
  GridBlock block = block_of(tables);
  block.pitch = side + 2;
  sum_influence(block, {work.places.data(), count}, tables.of(InfluenceKind::kZZ),
                work.scales_x.data(), nullptr, work.moves.data() + side + 3);
  if (problem.support.response != nullptr) {
    from_border(side, work.step, work.step_x);
    from_border(side, work.moves, work.moves_x);
    add_support(problem.support, {{}, {}, work.step_x}, {{}, {}, work.moves_x});
    to_border(side, work.moves_x, work.moves);
  }
}

void move_by_traction(const PatchProblem& problem, const double* step_x, const double* step_y,
                      PatchWork& work) {
  for (std::size_t k = 0; k < work.cells.size(); ++k) {
    work.scales_x[work.slots[k]] = problem.compliance * step_x[k];
    work.scales_y[work.slots[k]] = problem.compliance * step_y[k];
  }
  sum_tractions(problem, {work.places.data(), work.pairs}, work);
  if (problem.support.response != nullptr) {
    for (std::size_t k = 0; k < work.cells.size(); ++k) {
      work.step_x[work.cells[k]] = step_x[k];
      work.step_y[work.cells[k]] = step_y[k];
    }
    add_support(problem.support, {work.step_x, work.step_y, {}}, {work.moves_x, work.moves_y, {}});
  }
}

}  // namespace torsion
