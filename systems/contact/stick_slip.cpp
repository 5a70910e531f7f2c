#include "systems/contact/stick_slip.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/contact/law.hpp"
#include "systems/contact/region_grid.hpp"
#include "systems/half_space/elliptic_contact.hpp"

namespace torsion::engine {
namespace {

double cube_of(double x) {
  return x * x * x;
}

/// Ratio b / a of a contact's half axes, from its overlap's half extents along the grid, m. The
/// overlap of a paraboloid has the ratio of the square root of the curvatures' ratio, its contact
/// the power 2/3 of that (Greenwood, J. Tribol. 107 (1985) 501); a cylinder between two edges is
/// within a third of the same. In a grid that is not aligned with it, the share q = a b / (x^2 +
/// y^2) shows the ratio: for Hertz' ellipses of b / a = 1, 0.5, 0.2, 0.05 it is 0.25, 0.21, 0.13,
/// 0.04, for a strip 4/3 b / a.
double axes_of(const glm::dvec2& half, double radius, bool grid_fits) {
  const double overlap = std::min(half.x, half.y) / std::max(half.x, half.y);
  const double filled = grid_fits ? radius * radius / glm::dot(half, half) : 0.25;
  const double askew = filled * (0.8 + 3.2 * cube_of(4.0 * filled));
  return std::clamp(std::min(std::pow(overlap, 4.0 / 3.0), askew), 0.01, 1.0);
}

}  // namespace

StuckStiffness stuck_stiffness(const Model& model, const State& state, std::uint32_t region,
                               double radius) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  const Elasticity& elasticity = model.bodies.at<Elasticity>(identity.body);
  const double g = elasticity.shear_modulus();
  const double nu = elasticity.poisson_ratio;
  const glm::dvec2 half = overlap_extent(state, region);
  const double axes = axes_of(half, radius, !law_of(model, identity.body).by_cells);
  const double cube = cube_of(radius);
  const double share = ellipse_shares(axes).force;
  StuckStiffness stiffness;
  stiffness.along_tangents = 8.0 * g * radius / (2.0 - nu) * share;
  stiffness.along_normal = 4.0 * g * radius / (1.0 - nu) * share;
  stiffness.about_normal = 16.0 / 3.0 * g * cube * bonded_turn_share(axes, nu);
  stiffness.about_tangents = glm::dvec2(8.0 / 3.0 * g * cube / (1.0 - nu));
  const double depth = state.regions.at<Overlap>(region).largest_depth;
  if (depth > 0.0) {
    const double moved = 0.6 * state.regions.at<RegionNormal>(region).force / depth;
    stiffness.about_tangents =
        glm::max(stiffness.about_tangents, moved * glm::dvec2(half.y * half.y, half.x * half.x));
  }
  return stiffness;
}

}  // namespace torsion::engine
