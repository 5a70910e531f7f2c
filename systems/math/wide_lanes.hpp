#pragma once

// Eight cells at a time, in vectors of whatever width the machine has: the same partial sums, so
// the same bits, in all of them. Vectors are passed by reference, since how they are passed by
// value depends on the instruction set.

#include <cstddef>

namespace torsion::engine {

/// Columns of cells are as long as a multiple of that (lay_columns in contact/scratch.hpp).
inline constexpr std::size_t kLanes = 8;

constexpr std::size_t whole_lanes(std::size_t count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

using Wide = double __attribute__((vector_size(sizeof(double) * kLanes)));

#define TORSION_LANES static inline __attribute__((always_inline))

/// The eight numbers from one on, to be read or written. A vector type of less alignment is not
/// enough: clang forgets that where it is referred to, and takes the address for a multiple of 64.
struct __attribute__((packed, aligned(alignof(double)), may_alias)) LooseLanes {
  Wide all;
};

TORSION_LANES const LooseLanes& lanes_at(const double* first) {
  return *reinterpret_cast<const LooseLanes*>(first);
}

TORSION_LANES LooseLanes& lanes_at(double* first) {
  return *reinterpret_cast<LooseLanes*>(first);
}

TORSION_LANES double sum_of(const Wide& lanes) {
  return ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) +
         ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
}

/// The largest of all lanes and 0.
TORSION_LANES double largest_of(const Wide& lanes) {
  double most = 0.0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    most = lanes[lane] > most ? lanes[lane] : most;
  }
  return most;
}

}  // namespace torsion::engine
