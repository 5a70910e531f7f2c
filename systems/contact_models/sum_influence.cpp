#include "systems/contact_models/sum_influence.hpp"

#include <cstring>

// The same loops in the widest vectors that the machine has. Every displacement is made of
// chains of sums over the sources in their order, and without fused multiply-add (CMakeLists.txt)
// all versions give the same bits.
#if defined(__x86_64__) && defined(__GNUC__)
#define TORSION_WIDE_VERSIONS 1
#endif

namespace torsion {
namespace {

using Wide = double __attribute__((vector_size(64)));
using Middle = double __attribute__((vector_size(32)));

#define TORSION_INLINE static inline __attribute__((always_inline))

/// Rows at a time: their chains of sums hide each other's latency.
constexpr std::uint32_t kRows = 4;

/// What is the same for all cells.
struct Sums {
  GridBlock block;
  InfluenceSources sources;
};

/// `Rows` rows of as many columns as fit a vector. Table and displacement point at the first cell.
template <class Vector, std::uint32_t Rows>
TORSION_INLINE void sum_block(const Sums& at, const double* table, const double* scales,
                              double* displacement) {
  Vector sums[Rows] = {};
  for (std::size_t pair = 0; pair < at.sources.count; ++pair) {
    // Row by row: what is a pair's first for one row is its second for the next.
    const double* from = table - at.sources.places[pair] - at.block.width;
    const double first = scales[2 * pair];
    const double second = scales[2 * pair + 1];
    for (std::uint32_t row = 0; row <= Rows; ++row, from += at.block.width) {
      Vector value;
      std::memcpy(&value, from, sizeof value);
      if (row > 0) {
        sums[row - 1] += first * value;
      }
      if (row < Rows) {
        sums[row] += second * value;
      }
    }
  }
  for (std::uint32_t row = 0; row < Rows; ++row) {
    std::memcpy(displacement + std::size_t{row} * at.block.pitch, &sums[row], sizeof(Vector));
  }
}

template <class Vector, std::uint32_t Rows>
TORSION_INLINE void sum_block(const Sums& at, const TangentialSums& of) {
  Vector sums_x[Rows] = {};
  Vector sums_y[Rows] = {};
  Vector sums_both[Rows] = {};
  for (std::size_t pair = 0; pair < at.sources.count; ++pair) {
    const std::size_t place = at.sources.places[pair] + at.block.width;
    const double* const x = of.scales_x + std::size_t{2} * pair;
    const double* const y = of.scales_y + std::size_t{2} * pair;
    const double both[2] = {x[0] + y[0], x[1] + y[1]};
    for (std::uint32_t row = 0; row <= Rows; ++row) {
      const std::size_t to = std::size_t{row} * at.block.width;
      Vector by_x;
      Vector by_both;
      Vector by_y;
      std::memcpy(&by_x, of.x - place + to, sizeof by_x);
      std::memcpy(&by_both, of.xy - place + to, sizeof by_both);
      std::memcpy(&by_y, of.y - place + to, sizeof by_y);
      if (row > 0) {
        sums_x[row - 1] += x[0] * by_x;
        sums_both[row - 1] += both[0] * by_both;
        sums_y[row - 1] += y[0] * by_y;
      }
      if (row < Rows) {
        sums_x[row] += x[1] * by_x;
        sums_both[row] += both[1] * by_both;
        sums_y[row] += y[1] * by_y;
      }
    }
  }
  for (std::uint32_t row = 0; row < Rows; ++row) {
    sums_x[row] += sums_both[row];
    sums_y[row] += sums_both[row];
    std::memcpy(of.moved_x + std::size_t{row} * at.block.pitch, &sums_x[row], sizeof(Vector));
    std::memcpy(of.moved_y + std::size_t{row} * at.block.pitch, &sums_y[row], sizeof(Vector));
  }
}

/// One table, `Rows` rows from `first_row` on.
template <std::uint32_t Lanes, std::uint32_t Rows>
TORSION_INLINE void sum_rows(const Sums& at, const double* table, const double* scales,
                             double* displacement, std::uint32_t first_row) {
  const std::uint32_t side = at.block.side;
  const double* const from = table + at.block.self + first_row * at.block.width;
  double* const to = displacement + std::size_t{first_row} * at.block.pitch;
  std::uint32_t column = 0;
  if constexpr (Lanes >= 8) {
    for (; column + 8 <= side; column += 8) {
      sum_block<Wide, Rows>(at, from + column, scales, to + column);
    }
  }
  if constexpr (Lanes >= 4) {
    for (; column + 4 <= side; column += 4) {
      sum_block<Middle, Rows>(at, from + column, scales, to + column);
    }
  }
  for (; column < side; ++column) {
    sum_block<double, Rows>(at, from + column, scales, to + column);
  }
}

TORSION_INLINE TangentialSums shifted(const TangentialSums& of, std::size_t table,
                                      std::size_t cell) {
  return {of.x + table, of.xy + table,     of.y + table,     of.scales_x,
          of.scales_y,  of.moved_x + cell, of.moved_y + cell};
}

template <std::uint32_t Lanes, std::uint32_t Rows>
TORSION_INLINE void sum_rows(const Sums& at, const TangentialSums& of, std::uint32_t first_row) {
  const std::uint32_t side = at.block.side;
  const TangentialSums row = shifted(of, at.block.self + first_row * at.block.width,
                                     std::size_t{first_row} * at.block.pitch);
  std::uint32_t column = 0;
  if constexpr (Lanes >= 8) {
    for (; column + 8 <= side; column += 8) {
      sum_block<Wide, Rows>(at, shifted(row, column, column));
    }
  }
  if constexpr (Lanes >= 4) {
    for (; column + 4 <= side; column += 4) {
      sum_block<Middle, Rows>(at, shifted(row, column, column));
    }
  }
  for (; column < side; ++column) {
    sum_block<double, Rows>(at, shifted(row, column, column));
  }
}

template <std::uint32_t Lanes>
TORSION_INLINE void sum_all(const Sums& at, const double* table, const double* scales,
                            double* displacement) {
  std::uint32_t row = 0;
  for (; row + kRows <= at.block.side; row += kRows) {
    sum_rows<Lanes, kRows>(at, table, scales, displacement, row);
  }
  for (; row < at.block.side; ++row) {
    sum_rows<Lanes, 1>(at, table, scales, displacement, row);
  }
}

template <std::uint32_t Lanes>
TORSION_INLINE void sum_all(const Sums& at, const TangentialSums& of) {
  // Half as many rows: there are three sums each, and narrow vectors run out of registers.
  constexpr std::uint32_t kPairs = Lanes >= 8 ? kRows : kRows / 2;
  std::uint32_t row = 0;
  for (; row + kPairs <= at.block.side; row += kPairs) {
    sum_rows<Lanes, kPairs>(at, of, row);
  }
  for (; row < at.block.side; ++row) {
    sum_rows<Lanes, 1>(at, of, row);
  }
}

#ifdef TORSION_WIDE_VERSIONS
__attribute__((target("avx512f"))) void sum_widest(const Sums& at, const double* table,
                                                   const double* scales, double* displacement) {
  sum_all<8>(at, table, scales, displacement);
}
__attribute__((target("avx2"))) void sum_wide(const Sums& at, const double* table,
                                              const double* scales, double* displacement) {
  sum_all<4>(at, table, scales, displacement);
}
__attribute__((target("avx512f"))) void sum_widest(const Sums& at, const TangentialSums& of) {
  sum_all<8>(at, of);
}
__attribute__((target("avx2"))) void sum_wide(const Sums& at, const TangentialSums& of) {
  sum_all<4>(at, of);
}
#endif

}  // namespace

void sum_influence(const GridBlock& block, const InfluenceSources& sources, const double* table,
                   const double* scales, double* displacement) {
  if (block.side == 1) {  // there is no row for a pair's second
    displacement[0] = sources.count > 0 ? scales[0] * table[block.self] : 0.0;
    return;
  }
  const Sums at{block, sources};
#ifdef TORSION_WIDE_VERSIONS
  if (__builtin_cpu_supports("avx512f")) {
    return sum_widest(at, table, scales, displacement);
  }
  if (__builtin_cpu_supports("avx2")) {
    return sum_wide(at, table, scales, displacement);
  }
#endif
  sum_all<1>(at, table, scales, displacement);
}

void sum_tangential(const GridBlock& block, const InfluenceSources& sources,
                    const TangentialSums& sums) {
  if (block.side == 1) {
    sum_influence(block, sources, sums.x, sums.scales_x, sums.moved_x);
    sum_influence(block, sources, sums.y, sums.scales_y, sums.moved_y);
    return;
  }
  const Sums at{block, sources};
#ifdef TORSION_WIDE_VERSIONS
  if (__builtin_cpu_supports("avx512f")) {
    return sum_widest(at, sums);
  }
  if (__builtin_cpu_supports("avx2")) {
    return sum_wide(at, sums);
  }
#endif
  sum_all<1>(at, sums);
}

}  // namespace torsion
