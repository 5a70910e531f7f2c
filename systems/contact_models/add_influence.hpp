#pragma once

// The innermost loops of the contact model `patch`.

#include <cstddef>
#include <cstdint>

namespace torsion {

/// Where in an influence table the displacements of a whole grid begin.
struct GridBlock {
  std::uint32_t side = 0;  // cells along a side
  std::size_t width = 0;   // of a row of the table
  std::size_t first = 0;   // index for the grid's cell (0, 0)
};

/// displacement += scale * table, at every cell of the grid.
/// @param displacement  (side x side)
void add_influence(const GridBlock& block, const double* table, double scale, double* displacement);

/// displacement += first_scale * first + second_scale * second.
void add_two_influences(const GridBlock& block, const double* first, double first_scale,
                        const double* second, double second_scale, double* displacement);

}  // namespace torsion
