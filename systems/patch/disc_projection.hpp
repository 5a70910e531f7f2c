#pragma once

// Tractions onto their discs of friction, on a body that deflects as a whole. Source: Becker and
// Fadili, A quasi-Newton proximal splitting method, NIPS 2012: in a metric that is diagonal but for
// a few rows a projection is a search for as many numbers, here the body's motion.

#include <cstddef>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace torsion::engine {

/// Along the surface: x and y, m, and turning about the grid's origin, rad.
using SurfaceMotion = glm::dvec3;

/// What does work on that, sums over the cells: of tractions along x and y, Pa, and of their
/// moments about the grid's origin, Pa m.
using SurfaceLoad = glm::dvec3;

/// (side x side), and zeros up to whole lanes.
struct DiscColumns {
  std::vector<double> place_x, place_y;    // m, grid: the cells' centres
  std::vector<double> stiffness;           // Pa/m, of each cell on its own
  std::vector<double> trial_x, trial_y;    // Pa: what is to go onto the discs
  std::vector<double> result_x, result_y;  // Pa: on them
  // Pa/m: by how much the result goes back when the body moves
  std::vector<double> answer_xx, answer_xy, answer_yy;
  void reserve(std::size_t count);
};

/// What the body does meanwhile.
struct BodyInBalance {
  glm::dmat3 yields{0.0};   // SurfaceMotion by SurfaceLoad, symmetric, not negative
  SurfaceLoad before{0.0};  // for which the body has moved already
  SurfaceLoad known{0.0};   // beyond that: to whose motion the trials have gone
};

/// What it comes to.
struct BodyAnswer {
  // Beyond that of the known load. Not by the load, which has too few digits: the cells of a soft
  // body respond to the last ones.
  SurfaceMotion motion{0.0};
  SurfaceLoad load{0.0};  // of the results, beyond `before`
};

SurfaceLoad load_of(const DiscColumns& columns, const double* x, const double* y);

/// (x, y) = from - what the motion moves the cells by.
void take_off_motion(const DiscColumns& columns, const SurfaceMotion& motion, const double* from_x,
                     const double* from_y, double* x, double* y);

/// The results are the trials, less what the cells' stiffness makes of the body's motion beyond
/// that of the known load, each on its disc; and the body moves by the load that they are. That is
/// where a convex function of the motion has its least: Newton's method with a line search.
/// @param limit  Pa, (n): the discs' radii
BodyAnswer project_in_balance(const BodyInBalance& body, const double* limit, DiscColumns& columns);

}  // namespace torsion::engine
