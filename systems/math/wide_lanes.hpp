#pragma once

// Eight cells at a time, in vectors of whatever width the machine has: the same partial sums, so
// the same bits, in all of them.
//
// A loop over cells is a function template of the type `Wide` of eight numbers, and
// TORSION_IN_WIDEST calls the one for the machine. A vector type that is wider than the machine's
// registers would serve as well, but the compiler keeps it in memory, several times slower.

#include <cstddef>

namespace torsion::engine {

/// Columns of cells are as long as a multiple of that (lay_columns in contact/scratch.hpp).
inline constexpr std::size_t kLanes = 8;

constexpr std::size_t whole_lanes(std::size_t count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

#define TORSION_LANES static inline __attribute__((always_inline))

/// What the machine works on at once.
template <std::size_t Count>
struct MachineVector {
  using Type __attribute__((vector_size(sizeof(double) * Count))) = double;
};

/// Twice as many lanes as Half has.
template <class Half>
struct LanePair {
  Half low;
  Half high;
};

// Eight lanes, by the numbers that a register holds.
using WideBy8 = MachineVector<8>::Type;
using WideBy4 = LanePair<MachineVector<4>::Type>;
using WideBy2 = LanePair<LanePair<MachineVector<2>::Type>>;

// Vectors themselves have these operators; those of comparisons make masks for choose().
#define TORSION_LANE_OPERATOR(sign)                                                    \
  template <class Half>                                                                \
  TORSION_LANES auto operator sign(const LanePair<Half>& a, const LanePair<Half>& b) { \
    return LanePair<decltype(a.low sign b.low)>{a.low sign b.low, a.high sign b.high}; \
  }                                                                                    \
  template <class Half>                                                                \
  TORSION_LANES auto operator sign(const LanePair<Half>& a, double b) {                \
    return LanePair<decltype(a.low sign b)>{a.low sign b, a.high sign b};              \
  }                                                                                    \
  template <class Half>                                                                \
  TORSION_LANES auto operator sign(double a, const LanePair<Half>& b) {                \
    return LanePair<decltype(a sign b.low)>{a sign b.low, a sign b.high};              \
  }
TORSION_LANE_OPERATOR(+)
TORSION_LANE_OPERATOR(-)
TORSION_LANE_OPERATOR(*)
TORSION_LANE_OPERATOR(/)
TORSION_LANE_OPERATOR(>)
TORSION_LANE_OPERATOR(<)
TORSION_LANE_OPERATOR(!=)
#undef TORSION_LANE_OPERATOR

template <class Half>
TORSION_LANES LanePair<Half> operator-(const LanePair<Half>& a) {
  return {-a.low, -a.high};
}

template <class Half>
TORSION_LANES LanePair<Half>& operator+=(LanePair<Half>& a, const LanePair<Half>& b) {
  return a = a + b;
}

template <class Half>
TORSION_LANES LanePair<Half>& operator-=(LanePair<Half>& a, const LanePair<Half>& b) {
  return a = a - b;
}

/// `a` where the mask is set, else `b`.
template <class Mask, class Vector>
TORSION_LANES Vector choose(const Mask& mask, const Vector& a, const Vector& b) {
  return mask ? a : b;
}

template <class Mask, class Half>
TORSION_LANES LanePair<Half> choose(const LanePair<Mask>& mask, const LanePair<Half>& a,
                                    const LanePair<Half>& b) {
  return {choose(mask.low, a.low, b.low), choose(mask.high, a.high, b.high)};
}

/// How the lanes are read, written and put together.
template <class Vector>
struct LaneAccess {
  static constexpr std::size_t kCount = sizeof(Vector) / sizeof(double);

  // At any multiple of a number's size. A vector type of less alignment is not enough: clang
  // forgets that where it is referred to.
  struct __attribute__((packed, aligned(alignof(double)), may_alias)) Loose {
    Vector all;
  };

  TORSION_LANES void load(const double* from, Vector& to) {
    to = reinterpret_cast<const Loose*>(from)->all;
  }

  TORSION_LANES void store(const Vector& from, double* to) {
    reinterpret_cast<Loose*>(to)->all = from;
  }

  /// Neighbours first, then pairs.
  TORSION_LANES double sum(const Vector& of) {
    if constexpr (kCount == 2) {
      return of[0] + of[1];
    } else if constexpr (kCount == 4) {
      return (of[0] + of[1]) + (of[2] + of[3]);
    } else {
      return ((of[0] + of[1]) + (of[2] + of[3])) + ((of[4] + of[5]) + (of[6] + of[7]));
    }
  }

  TORSION_LANES double largest(const Vector& of, double most) {
    for (std::size_t lane = 0; lane < kCount; ++lane) {
      most = of[lane] > most ? of[lane] : most;
    }
    return most;
  }
};

template <class Half>
struct LaneAccess<LanePair<Half>> {
  static constexpr std::size_t kHalf = sizeof(Half) / sizeof(double);
  using HalfAccess = LaneAccess<Half>;

  TORSION_LANES void load(const double* from, LanePair<Half>& to) {
    HalfAccess::load(from, to.low);
    HalfAccess::load(from + kHalf, to.high);
  }

  TORSION_LANES void store(const LanePair<Half>& from, double* to) {
    HalfAccess::store(from.low, to);
    HalfAccess::store(from.high, to + kHalf);
  }

  TORSION_LANES double sum(const LanePair<Half>& of) {
    return HalfAccess::sum(of.low) + HalfAccess::sum(of.high);
  }

  TORSION_LANES double largest(const LanePair<Half>& of, double most) {
    return HalfAccess::largest(of.high, HalfAccess::largest(of.low, most));
  }
};

/// The eight numbers from one on.
template <class Wide>
TORSION_LANES Wide lanes_at(const double* first) {
  Wide lanes;
  LaneAccess<Wide>::load(first, lanes);
  return lanes;
}

template <class Wide>
TORSION_LANES void store_lanes(const Wide& lanes, double* first) {
  LaneAccess<Wide>::store(lanes, first);
}

template <class Wide>
TORSION_LANES double sum_of(const Wide& lanes) {
  return LaneAccess<Wide>::sum(lanes);
}

/// The largest of all lanes and 0.
template <class Wide>
TORSION_LANES double largest_of(const Wide& lanes) {
  return LaneAccess<Wide>::largest(lanes, 0.0);
}

// TORSION_IN_WIDEST(function, arguments...): what function<Wide>(arguments...) returns, with the
// eight lanes that suit the machine. The function is one of TORSION_LANES.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
template <auto* Function>
struct InAvx512;
template <auto* Function>
struct InAvx2;

template <class Result, class... Parameters, Result (*Function)(Parameters...)>
struct InAvx512<Function> {
  __attribute__((target("avx512f"))) static Result call(Parameters... arguments) {
    return Function(arguments...);
  }
};

template <class Result, class... Parameters, Result (*Function)(Parameters...)>
struct InAvx2<Function> {
  __attribute__((target("avx2"))) static Result call(Parameters... arguments) {
    return Function(arguments...);
  }
};

#define TORSION_IN_WIDEST(function, ...)                                                 \
  (__builtin_cpu_supports("avx512f")                                                     \
       ? InAvx512<&function<WideBy8>>::call(__VA_ARGS__)                                 \
       : (__builtin_cpu_supports("avx2") ? InAvx2<&function<WideBy4>>::call(__VA_ARGS__) \
                                         : function<WideBy2>(__VA_ARGS__)))
#else
#define TORSION_IN_WIDEST(function, ...) function<WideBy2>(__VA_ARGS__)
#endif

}  // namespace torsion::engine
