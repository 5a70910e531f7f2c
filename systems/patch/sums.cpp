#include "systems/patch/sums.hpp"

#include <algorithm>
#include <bit>

namespace torsion::engine {
namespace {

void add(std::span<double> to, double scale, const std::vector<double>& values) {
  for (std::size_t cell = 0; cell < to.size(); ++cell) {
    to[cell] += scale * values[cell];
  }
}

/// displacement = the sources' influence by one table.
void sum_influences(const PatchProblem& problem, const InfluenceSources& sources,
                    InfluenceKind kind, const std::vector<double>& scales,
                    std::vector<double>& displacement) {
  sum_influence(block_of(problem.influences), sources, problem.influences.of(kind), scales.data(),
                nullptr, displacement.data());
}

/// response_x, response_y = displacement along the surface by the gathered sources.
void sum_tractions(const PatchProblem& problem, const InfluenceSources& sources, PatchWork& work) {
  const InfluenceTables& tables = problem.influences;
  const GridBlock block = block_of(tables);
  for (std::size_t k = 0; k < std::size_t{2} * sources.count; ++k) {
    work.scales[k] = work.scales_x[k] + work.scales_y[k];
  }
  const double* const both = work.response_both.data();
  sum_influences(problem, sources, InfluenceKind::kXY, work.scales, work.response_both);
  sum_influence(block, sources, tables.of(InfluenceKind::kXXLessXY), work.scales_x.data(), both,
                work.response_x.data());
  sum_influence(block, sources, tables.of(InfluenceKind::kYYLessXY), work.scales_y.data(), both,
                work.response_y.data());
}

/// Two rows of changes of one component, one below the other.
struct ChangeRows {
  const double* low = nullptr;
  const double* high = nullptr;
  /// Not zero if one of the two is not: faster than two floating point comparisons.
  [[nodiscard]] std::uint64_t any(std::uint32_t i) const {
    constexpr std::uint32_t kSign = 1;
    return (std::bit_cast<std::uint64_t>(low[i]) | std::bit_cast<std::uint64_t>(high[i])) << kSign;
  }
};

void scale_pairs(const ChangeRows& rows, double first, double second, std::uint32_t begin,
                 std::uint32_t end, double* __restrict scales) {
  for (std::uint32_t i = begin; i < end; ++i) {
    scales[std::size_t{2} * (i - begin)] = first * rows.low[i];
    scales[std::size_t{2} * (i - begin) + 1] = second * rows.high[i];
  }
}

/// Gathers pairs of cells: in every two rows those from the first to the last with a change that is
/// not zero. Scales become displacements per table.
/// @param change_x, change_y  Pa, (side x side); change_y may be empty
InfluenceSources gather_sources(const PatchProblem& problem, std::span<const double> change_x,
                                std::span<const double> change_y, PatchWork& work) {
  const std::uint32_t side = problem.influences.side;
  const auto width = static_cast<std::uint32_t>(problem.influences.width());
  const std::uint32_t above = side > 1 ? side : 0;
  const bool both = !change_y.empty();
  std::uint32_t count = 0;
  for (std::uint32_t row = 0; row < side; row += 2) {
    const PairedRows paired = paired_rows(side, row);
    const double first = paired.first * problem.compliance;
    const double second = paired.second * problem.compliance;
    const double* const x = change_x.data() + std::size_t{paired.row} * side;
    const double* const y = both ? change_y.data() + std::size_t{paired.row} * side : x;
    const ChangeRows rows_x{x, x + above};
    const ChangeRows rows_y{y, y + above};
    std::uint32_t begin = 0;
    std::uint32_t end = side;
    while (begin < end && (rows_x.any(begin) | rows_y.any(begin)) == 0) {
      ++begin;
    }
    while (begin < end && (rows_x.any(end - 1) | rows_y.any(end - 1)) == 0) {
      --end;
    }
    scale_pairs(rows_x, first, second, begin, end, &work.scales_x[std::size_t{2} * count]);
    if (both) {
      scale_pairs(rows_y, first, second, begin, end, &work.scales_y[std::size_t{2} * count]);
    }
    for (std::uint32_t i = begin; i < end; ++i) {
      work.places[count++] = paired.row * width + i;
    }
  }
  return {work.places.data(), count};
}

}  // namespace

void move_as_one(const PatchSupport& support, std::size_t motion, double* x, double* y) {
  for (std::size_t cell = 0; cell < support.place_x.size(); ++cell) {
    x[cell] = motion == 2 ? -support.place_y[cell] : (motion == 0 ? 1.0 : 0.0);
    y[cell] = motion == 2 ? support.place_x[cell] : (motion == 1 ? 1.0 : 0.0);
  }
}

void precondition(const PatchProblem& problem, const LocalInverse& inverse, const double* residual,
                  PatchWork& work, double* preconditioned) {
  const std::uint32_t side = problem.influences.side;
  const std::span<const double>& root = problem.rims.root;
  // With A the influences and D the softness at rims, whose diagonals differ only by the roots R, R
  // B R approximates the inverse of A + D as B does that of A.
  if (!root.empty()) {
    multiply(root.size(), root.data(), residual, preconditioned);
  }
  to_border(side, root.empty() ? residual : preconditioned, work.bordered.data());
  apply_local_inverse(inverse, 1.0 / problem.compliance, side, work.bordered.data(),
                      preconditioned);
  if (!root.empty()) {
    multiply(root.size(), root.data(), preconditioned, preconditioned);
  }
}

void add_rims(const PatchProblem& problem, InfluenceKind kind, double sign,
              std::span<const double> traction, std::span<double> displacement) {
  const std::span<const double>& softness = problem.rims.softness;
  const double scale = sign * problem.compliance * problem.influences.self(kind);
  const std::size_t count = std::min(softness.size(), displacement.size());
  for (std::size_t cell = 0; cell < count; ++cell) {
    displacement[cell] += scale * softness[cell] * traction[cell];
  }
}

void add_sideways(const PatchProblem& problem, const PatchColumns& columns,
                  std::span<const double> change, PatchWork& work) {
  const InfluenceSources sources = gather_sources(problem, change, {}, work);
  // Minus: by reciprocity (influence.hpp).
  sum_influences(problem, sources, InfluenceKind::kZX, work.scales_x, work.response_x);
  sum_influences(problem, sources, InfluenceKind::kZY, work.scales_x, work.response_y);
  add(columns.moved_x, -1.0, work.response_x);
  add(columns.moved_y, -1.0, work.response_y);
}

void add_depression(const PatchProblem& problem, const PatchColumns& columns,
                    std::span<const double> change_x, std::span<const double> change_y,
                    PatchWork& work) {
  const InfluenceSources sources = gather_sources(problem, change_x, change_y, work);
  sum_influences(problem, sources, InfluenceKind::kZX, work.scales_x, work.response_x);
  sum_influences(problem, sources, InfluenceKind::kZY, work.scales_y, work.response_y);
  add(columns.depression, 1.0, work.response_x);
  add(columns.depression, 1.0, work.response_y);
}

void add_pressure(const PatchProblem& problem, const PatchColumns& columns,
                  std::span<const double> change, PatchWork& work) {
  const InfluenceSources sources = gather_sources(problem, change, {}, work);
  sum_influences(problem, sources, InfluenceKind::kZZ, work.scales_x, work.response_x);
  add(columns.depression, 1.0, work.response_x);
  add_rims(problem, InfluenceKind::kZZ, 1.0, change, columns.depression);
  if (problem.coupled) {
    add_sideways(problem, columns, change, work);
  }
}

void add_tractions(const PatchProblem& problem, const PatchColumns& columns,
                   std::span<const double> change_x, std::span<const double> change_y,
                   PatchWork& work) {
  sum_tractions(problem, gather_sources(problem, change_x, change_y, work), work);
  add(columns.moved_x, 1.0, work.response_x);
  add(columns.moved_y, 1.0, work.response_y);
  add_rims(problem, InfluenceKind::kXX, 1.0, change_x, columns.moved_x);
  add_rims(problem, InfluenceKind::kYY, 1.0, change_y, columns.moved_y);
  if (problem.coupled) {
    add_depression(problem, columns, change_x, change_y, work);
  }
}

void move_by_pressure(const PatchProblem& problem, PatchWork& work) {
  sum_influences(problem, gather_sources(problem, work.direction_x, {}, work), InfluenceKind::kZZ,
                 work.scales_x, work.response_x);
  add_rims(problem, InfluenceKind::kZZ, 1.0, work.direction_x, work.response_x);
  add_support(problem.support, {{}, {}, work.direction_x}, {{}, {}, work.response_x});
}

void move_by_traction(const PatchProblem& problem, PatchWork& work) {
  sum_tractions(problem, gather_sources(problem, work.direction_x, work.direction_y, work), work);
  add_rims(problem, InfluenceKind::kXX, 1.0, work.direction_x, work.response_x);
  add_rims(problem, InfluenceKind::kYY, 1.0, work.direction_y, work.response_y);
  add_support(problem.support, {work.direction_x, work.direction_y, {}},
              {work.response_x, work.response_y, {}});
}

}  // namespace torsion::engine
