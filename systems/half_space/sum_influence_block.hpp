#pragma once

// The loops of sum_influence.hpp for one width of vectors. Included by one source file for every
// instruction set, each compiled with its own flags: nothing here may be shared between them by the
// linker, so all of it is static and inlined.

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "systems/half_space/sum_influence.hpp"

namespace torsion::engine {

/// What sum_influence is asked for, by sides of 2 and more.
struct InfluenceSums {
  GridBlock block;
  InfluenceSources sources;
  const double* table = nullptr;
  const double* scales = nullptr;
  const double* start = nullptr;
  double* displacement = nullptr;
};

void sum_influence_avx512(const InfluenceSums& sums);
void sum_influence_avx2(const InfluenceSums& sums);

namespace influence_block {

template <std::uint32_t Lanes>
struct VectorOf {
  using Type __attribute__((vector_size(Lanes * sizeof(double)))) = double;
};
template <>
struct VectorOf<1> {
  using Type = double;
};

#define TORSION_INLINE static inline __attribute__((always_inline))

// Keeps what is read once and used twice in a register. The compiler would read it twice, since it
// takes that to be free; but most of these reads go across two cache lines.
#if defined(__AVX2__) && defined(__GNUC__)
#define TORSION_KEEP(value) __asm__("" : "+v"(value))
#else
#define TORSION_KEEP(value)
#endif

/// `Rows` rows of `Lanes` columns, the first at `row` and `column`.
template <std::uint32_t Lanes, std::uint32_t Rows>
TORSION_INLINE void sum_block(const InfluenceSums& of, std::uint32_t row, std::uint32_t column) {
  using Vector = typename VectorOf<Lanes>::Type;
  const std::size_t width = of.block.width;
  const std::size_t pitch = of.block.pitch;
  const std::size_t cell = row * pitch + column;
  // Of a pair's second; its first's rows come one later.
  const double* const table = of.table + of.block.self + row * width + column - width;
  Vector sums[Rows] = {};
  if (of.start != nullptr) {
    for (std::uint32_t k = 0; k < Rows; ++k) {
      std::memcpy(&sums[k], of.start + cell + k * pitch, sizeof(Vector));
    }
  }
  for (std::size_t pair = 0; pair < of.sources.count; ++pair) {
    // Row by row: what is a pair's first for one row is its second for the next.
    const double* const from = table - of.sources.places[pair];
    const double first = of.scales[2 * pair];
    const double second = of.scales[2 * pair + 1];
    for (std::uint32_t k = 0; k <= Rows; ++k) {
      Vector value;
      std::memcpy(&value, from + k * width, sizeof value);
      TORSION_KEEP(value);
      if (k > 0) {
        sums[k - 1] += first * value;
      }
      if (k < Rows) {
        sums[k] += second * value;
      }
    }
  }
  for (std::uint32_t k = 0; k < Rows; ++k) {
    std::memcpy(of.displacement + cell + k * pitch, &sums[k], sizeof(Vector));
  }
}

/// `Rows` rows from `row` on, the columns from `column` on. What is left beside whole vectors is
/// done by one more that ends with the row, if it is more than half of one: some cells are summed
/// twice, to the same.
template <std::uint32_t Lanes, std::uint32_t Rows>
TORSION_INLINE void sum_rows(const InfluenceSums& of, std::uint32_t row, std::uint32_t column) {
  const std::uint32_t side = of.block.side;
  for (; column + Lanes <= side; column += Lanes) {
    sum_block<Lanes, Rows>(of, row, column);
  }
  if constexpr (Lanes > 1) {
    if (column > 0 && side - column > Lanes / 2) {
      sum_block<Lanes, Rows>(of, row, side - Lanes);
    } else if (column < side) {
      sum_rows<Lanes / 2, Rows>(of, row, column);
    }
  }
}

/// All rows, `Rows` at a time: their chains of sums hide each other's latency. The last ones
/// likewise.
template <std::uint32_t Lanes, std::uint32_t Rows>
TORSION_INLINE void sum_all(const InfluenceSums& of) {
  const std::uint32_t side = of.block.side;
  for (std::uint32_t row = 0; row < side; row += Rows) {
    sum_rows<Lanes, Rows>(of, row + Rows <= side ? row : side - Rows, 0);
  }
}

/// @return what all rows cost, `Rows` at a time: each time as many as there are rows of the table
TORSION_INLINE std::uint32_t cost(std::uint32_t side, std::uint32_t rows) {
  return side < rows ? 0xffffffffU : (side + rows - 1) / rows * (rows + 1);
}

/// By the number of rows at a time that costs least.
template <std::uint32_t Lanes>
TORSION_INLINE void sum_all(const InfluenceSums& sums) {
  const InfluenceSums of = sums;  // which no displacement that is written can be part of
  const std::uint32_t side = of.block.side;
  const std::uint32_t by_twelve = cost(side, 12);
  const std::uint32_t by_eight = cost(side, 8);
  const std::uint32_t by_six = cost(side, 6);
  const std::uint32_t by_two = cost(side, 2);
  if (by_twelve <= by_eight && by_twelve <= by_six && by_twelve <= by_two) {
    sum_all<Lanes, 12>(of);
  } else if (by_eight <= by_six && by_eight <= by_two) {
    sum_all<Lanes, 8>(of);
  } else if (by_six <= by_two) {
    sum_all<Lanes, 6>(of);
  } else {
    sum_all<Lanes, 2>(of);
  }
}

}  // namespace influence_block
}  // namespace torsion::engine
