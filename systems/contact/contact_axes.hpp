#pragma once

#include <cmath>

#include "systems/contact/grid_cells.hpp"

namespace torsion {

/// What is longer than so many times its width is a long contact: its grid lies along it.
inline constexpr double kLongContact = 1.6;

/// Of the width of a contact over its length, rad: to turn a grid by less changes nothing.
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

/// The grid's longer axis is to go along the contact, in a square one the nearer.
ContactAxes contact_axes(const Grid& grid, const CellMoments& moments);

/// Turns the grid's tangents about its normal.
void turn_axes(RegionFrame& frame, double angle);

}  // namespace torsion
