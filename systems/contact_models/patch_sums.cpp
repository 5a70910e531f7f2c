#include "systems/contact_models/patch_sums.hpp"

#include <cstring>

namespace torsion {
namespace {

void add(std::span<double> to, double scale, const std::vector<double>& values) {
  for (std::size_t cell = 0; cell < to.size(); ++cell) {
    to[cell] += scale * values[cell];
  }
}

/// moves_x, moves_y = displacement along the surface by what has been gathered.
void sum_tractions(const PatchProblem& problem, const InfluenceSources& sources, PatchWork& work) {
  const InfluenceTables& tables = problem.influences;
  sum_tangential(
      block_of(tables), sources,
      {tables.of(InfluenceKind::kXX), tables.of(InfluenceKind::kXY), tables.of(InfluenceKind::kYY),
       work.scales_x.data(), work.scales_y.data(), work.moves_x.data(), work.moves_y.data()});
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
  std::uint32_t count = 0;
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      work.places[count] = j * width + i;
      work.scales_x[count] = problem.compliance * change_x[cell];
      work.scales_y[count] = problem.compliance * change_y[cell];
      count += change_x[cell] != 0.0 || change_y[cell] != 0.0 ? 1U : 0U;
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
  const InfluenceTables& tables = problem.influences;
  const InfluenceSources sources = gather_sources(problem, change, change, work);
  // Minus: by reciprocity (influence.hpp).
  sum_influence(block_of(tables), sources, tables.of(InfluenceKind::kZX), work.scales_x.data(),
                work.moves_x.data());
  sum_influence(block_of(tables), sources, tables.of(InfluenceKind::kZY), work.scales_x.data(),
                work.moves_y.data());
  add(columns.moved_x, -1.0, work.moves_x);
  add(columns.moved_y, -1.0, work.moves_y);
}

void add_depression(const PatchProblem& problem, const PatchColumns& columns,
                    std::span<const double> change_x, std::span<const double> change_y,
                    PatchWork& work) {
  const InfluenceTables& tables = problem.influences;
  const InfluenceSources sources = gather_sources(problem, change_x, change_y, work);
  sum_influence(block_of(tables), sources, tables.of(InfluenceKind::kZX), work.scales_x.data(),
                work.moves_x.data());
  sum_influence(block_of(tables), sources, tables.of(InfluenceKind::kZY), work.scales_y.data(),
                work.moves_y.data());
  add(columns.depression, 1.0, work.moves_x);
  add(columns.depression, 1.0, work.moves_y);
}

void add_pressure(const PatchProblem& problem, const PatchColumns& columns,
                  std::span<const double> change, PatchWork& work) {
  const InfluenceTables& tables = problem.influences;
  const InfluenceSources sources = gather_sources(problem, change, change, work);
  sum_influence(block_of(tables), sources, tables.of(InfluenceKind::kZZ), work.scales_x.data(),
                work.moves_x.data());
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
  std::uint32_t count = 0;
  for (std::uint32_t j = 0; j < side; ++j) {
    const double* const step = work.step.data() + std::size_t{j + 1} * (side + 2) + 1;
    for (std::uint32_t i = 0; i < side; ++i) {
      work.places[count] = j * width + i;
      work.scales_x[count] = problem.compliance * step[i];
      count += step[i] != 0.0 ? 1U : 0U;
    }
  }
  GridBlock block = block_of(tables);
  block.pitch = side + 2;
  sum_influence(block, {work.places.data(), count}, tables.of(InfluenceKind::kZZ),
                work.scales_x.data(), work.moves.data() + side + 3);
  if (problem.support.response != nullptr) {
    from_border(side, work.step, work.step_x);
    from_border(side, work.moves, work.moves_x);
    add_support(problem.support, {{}, {}, work.step_x}, {{}, {}, work.moves_x});
    to_border(side, work.moves_x, work.moves);
  }
}

void move_by_traction(const PatchProblem& problem, PatchWork& work) {
  const InfluenceTables& tables = problem.influences;
  const std::uint32_t side = tables.side;
  const std::uint32_t beside = static_cast<std::uint32_t>(tables.width()) - side;
  std::uint32_t count = 0;
  for (const std::uint32_t cell : work.cells) {
    work.places[count] = cell + cell / side * beside;
    work.scales_x[count] = problem.compliance * work.step_x[cell];
    work.scales_y[count] = problem.compliance * work.step_y[cell];
    ++count;
  }
  sum_tractions(problem, {work.places.data(), count}, work);
  add_support(problem.support, {work.step_x, work.step_y, {}}, {work.moves_x, work.moves_y, {}});
}

}  // namespace torsion
