#pragma once

// The innermost loops of the contact model `patch`: what all loaded cells of a grid do to every
// cell.

#include <cstddef>
#include <cstdint>

namespace torsion::engine {

/// A grid, and where its influence tables hold the displacement of a cell by itself.
struct GridBlock {
  std::uint32_t side = 0;   // cells along a side
  std::uint32_t pitch = 0;  // of a row of the displacements
  std::size_t width = 0;    // of a row of the tables
  std::size_t self = 0;     // index in a table
};

/// Cells with a traction, in pairs: one and the next row's in the same column, which share what is
/// read of a table.
struct InfluenceSources {
  const std::uint32_t* places = nullptr;  // (count) row times the tables' width plus column of the
                                          // pair's first
  std::uint32_t count = 0;                // pairs
};

/// How many pairs the cells of a grid make at most.
constexpr std::size_t most_pairs(std::uint32_t side) {
  return std::size_t{side} * ((std::size_t{side} + 1) / 2);
}

/// The pairs of a row of cells and the next one. A last row that is left alone is paired with the
/// one before, whose cells have been in a pair already and count for nothing here.
struct PairedRows {
  std::uint32_t row = 0;  // the first one
  double first = 1.0;     // what its cells count for
  double second = 1.0;
};
/// @param row  even
constexpr PairedRows paired_rows(std::uint32_t side, std::uint32_t row) {
  if (row + 1 < side) {
    return {row, 1.0, 1.0};
  }
  return side == 1 ? PairedRows{0, 1.0, 0.0} : PairedRows{row - 1, 0.0, 1.0};
}

/// displacement = start and the sum over the sources of scale times table, at its first of `side`
/// rows and the next ones, each `pitch` after the one before.
/// @param scales        (2 sources.count)
/// @param start         as displacement; null: zeros
/// @param displacement  (side x side) out, elsewhere than `start`
void sum_influence(const GridBlock& block, const InfluenceSources& sources, const double* table,
                   const double* scales, const double* start, double* displacement);

}  // namespace torsion::engine
