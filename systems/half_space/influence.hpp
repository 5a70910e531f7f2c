#pragma once

// How one loaded cell of a grid displaces the surface of an elastic half-space at another cell's
// centre: Boussinesq's and Cerruti's solutions for uniform tractions on rectangles.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec2.hpp>

namespace torsion::engine {

/// Displacement (first letter) by traction (second letter); z points into the body.
/// The last two are differences of others: u_x = sum of (xx - xy) q_x + s, u_y = sum of
/// (yy - xy) q_y + s with s = sum of xy (q_x + q_y) takes three products instead of four.
enum class InfluenceKind : std::uint32_t { kZZ, kXX, kXY, kYY, kZX, kZY, kXXLessXY, kYYLessXY };
inline constexpr std::uint32_t kSolvedKinds = 6;
inline constexpr std::uint32_t kInfluenceKinds = 8;

/// Cells are 2^aspect times as long along x as along y; a grid takes the nearest of these.
inline constexpr std::int32_t kMostAspect = 4;
inline constexpr std::uint32_t kAspects = 2 * kMostAspect + 1;

/// Number of values of all tables of one body for grids of side x side cells.
constexpr std::size_t influence_count(std::uint32_t side) {
  return std::size_t{kAspects} * kInfluenceKinds * (2 * std::size_t{side} - 1) *
         (2 * std::size_t{side});
}

/// Tables for one Poisson's ratio: for every aspect the kinds, each (2 side - 1) rows of 2 side
/// values (the last of a row is padding); the value for a displacement at cell (i + di, j + dj) by
/// a traction on cell (i, j) is in row dj + side - 1 at di + side - 1. Times the cell's length
/// along x over the shear modulus it is m/Pa. u_x by the pressure is minus kZX, u_y minus kZY
/// (reciprocity). Source: Love, Phil. Trans. R. Soc. A 228 (1929) 377; Johnson, Contact Mechanics,
/// 1985, 3.2, 3.6.
/// @param poisson_ratio  0 to 0.5
/// @param values         (influence_count(side)) out
void fill_influences(double poisson_ratio, std::uint32_t side, std::span<double> values);

/// Fills the kinds that are differences from those that are not.
/// @param values  all kinds of one grid, one after another
void fill_differences(std::span<double> values);

/// The tables of one aspect.
struct InfluenceTables {
  std::uint32_t side = 0;
  std::array<const double*, kInfluenceKinds> kinds{};  // each (2 side - 1) x (2 side)

  [[nodiscard]] std::size_t width() const { return 2 * std::size_t{side}; }
  /// Index of the displacement at column `i` and row `j` by a traction at (source_i, source_j); the
  /// following columns follow it.
  [[nodiscard]] std::size_t index(std::uint32_t source_i, std::uint32_t source_j, std::uint32_t i,
                                  std::uint32_t j) const {
    return (j + side - 1 - source_j) * width() + (i + side - 1 - source_i);
  }
  [[nodiscard]] const double* of(InfluenceKind kind) const {
    return kinds[static_cast<std::size_t>(kind)];
  }
  /// Displacement of a cell by its own traction.
  [[nodiscard]] double self(InfluenceKind kind) const { return of(kind)[index(0, 0, 0, 0)]; }
};

/// @param values  what fill_influences has filled
/// @param aspect  -kMostAspect to kMostAspect
InfluenceTables influence_tables(std::span<const double> values, std::uint32_t side,
                                 std::int32_t aspect);

/// Which of the shapes of cells that there are tables for a grid has: -kMostAspect to kMostAspect.
std::int32_t table_aspect(const glm::dvec2& half_size);

/// Half the sides, at least `least`, of a grid whose cells have one of the shapes that there are
/// influence tables for.
/// @param least  m
glm::dvec2 tabulated_half_size(const glm::dvec2& least);

/// Likewise, of cells with a given shape: 2^aspect times as long along x as along y.
glm::dvec2 tabulated_half_size(const glm::dvec2& least, std::int32_t aspect);

// A cheap stand-in for the inverse of an influence table: which tractions a displacement asks for,
// by a cell and its eight neighbours.

/// What a displacement of a cell asks for there, at its neighbours along x and along y, and at
/// those across a corner.
struct LocalInverse {
  double here = 0.0;
  double along_x = 0.0;
  double along_y = 0.0;
  double corner = 0.0;
};

/// The middle row of the inverse of the influences within three by three cells: the sparse
/// approximate inverse (Benson and Frederickson, Utilitas Mathematica 22 (1982) 127; on Toeplitz
/// matrices, Chan and Ng, SIAM Review 38 (1996) 427). In the tables' units.
LocalInverse local_inverse(const InfluenceTables& tables, InfluenceKind kind);

/// Those of all three directions.
struct LocalInverses {
  LocalInverse x, y, z;
};

inline LocalInverses local_inverses(const InfluenceTables& tables) {
  return {local_inverse(tables, InfluenceKind::kXX), local_inverse(tables, InfluenceKind::kYY),
          local_inverse(tables, InfluenceKind::kZZ)};
}

}  // namespace torsion::engine
