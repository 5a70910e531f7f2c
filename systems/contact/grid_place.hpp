#pragma once

#include "systems/contact/grid_cells.hpp"

namespace torsion {

/// Of a region's grid around its contact: about one cell of 16.
inline constexpr double kGridMargin = 1.12;
inline constexpr double kSmallestHalf = 1e-9;  // m

/// A box in the grid's plane; empty while lowest > highest.
struct PlaneBox {
  glm::dvec2 lowest{1e300};
  glm::dvec2 highest{-1e300};
  void include(const glm::dvec2& low, const glm::dvec2& high) {
    lowest = glm::min(lowest, low);
    highest = glm::max(highest, high);
  }
  [[nodiscard]] bool empty() const { return lowest.x > highest.x || lowest.y > highest.y; }
};

/// The contact as the last pass found it: covered cells, cut where their coverage says that the
/// edge runs.
PlaneBox covered_box(const Grid& grid, const CellBits& covered);

/// Likewise along axes that are turned by `angle` from the grid's, rad.
PlaneBox covered_box(const Grid& grid, const CellBits& covered, double angle);

/// Half the sides of the grid that suits a contact. A sliver is given a tenth of its length in
/// width, so that no cell degenerates.
glm::dvec2 half_size_for(const Grid& grid, const PlaneBox& box);

/// Half of the overlap's extent along the grid's axes, m: that of the shapes as far as
/// SmoothContact is known, else the grid's own.
glm::dvec2 overlap_extent(const State& state, std::uint32_t region);

/// Outward normal of the body's surface nearest to a point of its frame.
glm::dvec3 body_normal(const Grid& grid, const glm::dvec3& point);

/// Gives the grid a size, and puts its origin `shift` away in its own plane (m) and back on the
/// body's rest surface.
void lay(const Grid& grid, const glm::dvec2& shift, const glm::dvec2& half_size);

/// Puts the grid around `box` (of its own plane).
void fit(const Grid& grid, const PlaneBox& box);

/// Likewise, but goes only a part of a short way: where a contact ends is known from cells to a
/// share of one, and a grid that went all the way would find it elsewhere again, in every step.
/// @param moves  whether the tool does; under one that stands a grid that nearly fits stays
void approach(const Grid& grid, const PlaneBox& box, bool moves);

/// Lets every cell look for the tool from the same depth.
void restart_heights(const Grid& grid, double depth);

}  // namespace torsion
