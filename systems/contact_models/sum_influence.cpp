#include "systems/contact_models/sum_influence.hpp"

#include <cstring>

// The same loops in the widest vectors that the machine has. Every displacement is one chain of
// sums over the sources in their order, and without fused multiply-add (CMakeLists.txt) all
// versions give the same bits.
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
  for (std::uint32_t source = 0; source < at.sources.count; ++source) {
    const double* const from = table - at.sources.places[source];
    const double scale = scales[source];
    for (std::uint32_t row = 0; row < Rows; ++row) {
      Vector value;
      std::memcpy(&value, from + std::size_t{row} * at.block.width, sizeof value);
      sums[row] += scale * value;
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
  for (std::uint32_t source = 0; source < at.sources.count; ++source) {
    const std::uint32_t place = at.sources.places[source];
    const double scale_x = of.scales_x[source];
    const double scale_y = of.scales_y[source];
    for (std::uint32_t row = 0; row < Rows; ++row) {
      const std::size_t to = std::size_t{row} * at.block.width;
      Vector xx;
      Vector xy;
      Vector yy;
      std::memcpy(&xx, of.xx - place + to, sizeof xx);
      std::memcpy(&xy, of.xy - place + to, sizeof xy);
      std::memcpy(&yy, of.yy - place + to, sizeof yy);
      sums_x[row] += scale_x * xx + scale_y * xy;
      sums_y[row] += scale_x * xy + scale_y * yy;
    }
  }
  for (std::uint32_t row = 0; row < Rows; ++row) {
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
  return {of.xx + table, of.xy + table,     of.yy + table,    of.scales_x,
          of.scales_y,   of.moved_x + cell, of.moved_y + cell};
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
  // Half as many rows: there are two sums each, and narrow vectors run out of registers.
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
