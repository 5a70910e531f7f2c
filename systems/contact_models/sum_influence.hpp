#pragma once

// The innermost loops of the contact model `patch`: what all loaded cells of a grid do to every
// cell.

#include <cstddef>
#include <cstdint>

namespace torsion {

/// A grid, and where its influence tables hold the displacement of a cell by itself.
struct GridBlock {
  std::uint32_t side = 0;   // cells along a side
  std::uint32_t pitch = 0;  // of a row of the displacements
  std::size_t width = 0;    // of a row of the tables
  std::size_t self = 0;     // index in a table
};

/// Cells with a traction.
struct InfluenceSources {
  const std::uint32_t* places = nullptr;  // row times the tables' width plus column, each
  std::uint32_t count = 0;
};

/// displacement = the sum over the sources of scale times table, at its first of `side` rows and
/// the next ones, each `pitch` after the one before.
/// @param scales        (sources.count)
/// @param displacement  (side x side)
void sum_influence(const GridBlock& block, const InfluenceSources& sources, const double* table,
                   const double* scales, double* displacement);

/// Both components of a tangential displacement by both of the tractions.
/// @param xx, xy, yy            tables
/// @param scales_x, scales_y    (sources.count)
/// @param moved_x, moved_y      (side x side) out
struct TangentialSums {
  const double* xx = nullptr;
  const double* xy = nullptr;
  const double* yy = nullptr;
  const double* scales_x = nullptr;
  const double* scales_y = nullptr;
  double* moved_x = nullptr;
  double* moved_y = nullptr;
};
void sum_tangential(const GridBlock& block, const InfluenceSources& sources,
                    const TangentialSums& sums);

}  // namespace torsion
