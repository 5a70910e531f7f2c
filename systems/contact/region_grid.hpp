#pragma once

#include <cmath>

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/step_context.hpp"

namespace torsion::engine {

/// A contact longer than this many times its width counts as long: its grid lies along it.
inline constexpr double kLongContact = 1.6;

/// Share of a contact's width over its length, rad: to turn a grid by less changes nothing.
inline constexpr double kAligned = 0.05;

/// Second moments of an area in its plane, over the area, about its middle, m^2.
struct SecondMoments {
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;

  /// The least width over the largest length.
  [[nodiscard]] double width_over_length() const;
  /// Of the principal axis of the larger moment from x, rad, -pi / 2 to pi / 2.
  [[nodiscard]] double angle() const { return 0.5 * std::atan2(2.0 * xy, xx - yy); }
};

/// Sums over the cells of a grid, in cells from the first one's centre.
struct CellMoments {
  double weight = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;

  /// A run of `count` whole cells in row j.
  void add_run(double first, double count, double j) {
    const double middle = first + 0.5 * (count - 1.0);
    weight += count;
    x += count * middle;
    y += count * j;
    xx += count * middle * middle + count * (count * count - 1.0) / 12.0;
    xy += count * middle * j;
    yy += count * j * j;
  }
  void add(double of_cell, double i, double j) {
    weight += of_cell;
    x += of_cell * i;
    y += of_cell * j;
    xx += of_cell * i * i;
    xy += of_cell * i * j;
    yy += of_cell * j * j;
  }
};

/// Of the cells' coverage, as find_cells leaves it in ContactScratch::cell_columns.
CellMoments covered_moments(const Grid& grid);

/// How a contact lies in its grid.
struct ContactAxes {
  double angle = 0.0;      // rad: by which the grid is to be turned about its normal so that one of
                           // its axes lies along the contact; 0 for one that is not long
  double allowance = 0.0;  // rad: its width over its length. So far askew it needs a grid twice as
                           // wide, and is worth another one
  // m, along the grid's axes: of the rectangle that has the same middle and second moments
  glm::dvec2 middle{0.0};
  glm::dvec2 size{0.0};

  [[nodiscard]] bool is_long() const { return allowance > 0.0; }
  [[nodiscard]] bool is_askew() const { return std::abs(angle) > allowance; }
};

/// How far the grid's longer axis, or a square grid's nearer one, lies off the contact's.
ContactAxes contact_axes(const Grid& grid, const CellMoments& moments);

/// Turns the grid's tangents about its normal.
void turn_axes(RegionFrame& frame, double angle);

/// Side of a region's grid over its contact's: about one cell of 16 is left free.
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

/// Likewise, but a short way is gone only in part: cells show a contact's edge to a fraction of
/// one, and a grid that moved all the way would see another edge in every step.
/// @param moves  whether the tool does; under a resting tool a grid that nearly fits stays
void approach(const Grid& grid, const PlaneBox& box, bool moves);

/// Makes every cell look for the tool from the same depth.
void restart_heights(const Grid& grid, double depth);

/// Lays a new region's grid: in the body's tangent plane at the deepest of the cluster's points,
/// just around them. The axes come from the body frame, so a scene that is turned as a whole gives
/// a grid that is turned with it.
void place_new_grid(StepContext& context, std::uint32_t region, const RegionPoints& contact);

/// The deepest of the region's contact points; depth 0 where there are none.
ContactPoint deepest_of_cluster(const Grid& grid, const RegionPoints& contact);

/// Looks again where a new grid's cells show another normal than the one it was laid with. Of a
/// face that comes to lie on a body an edge touches first, whose normal is not the face's; along it
/// the whole face would seem to lie deep.
void look_along_normal(const Grid& grid, const RegionPoints& contact);

// Of contact models whose grid is found by the overlap alone.

/// Moves a region's grid along with its overlap: centre, size and normal follow what the last
/// step's cells found, and the cluster's points lie on it. The x axis turns with the normal and not
/// about it, and along a long contact.
void follow_overlap(StepContext& context, std::uint32_t region, const RegionPoints& contact);

/// Finds the overlap's cells, and fits the grid to them.
void find_overlap(StepContext& context, std::uint32_t region, const RegionPoints& contact);

/// Moves a region's grid along with its contact, as its contact model does.
void follow_contact(StepContext& context, std::uint32_t region, const RegionPoints& contact);

/// Finds, for every cell of every region, the tool's surface along the normal and how deep it is
/// under the body's rest surface; then the region's area, depths and pressure centre. Cells that
/// are not joined to the region's own contact points belong to a neighbour and count nothing.
void region_grids(StepContext& context);

}  // namespace torsion::engine
