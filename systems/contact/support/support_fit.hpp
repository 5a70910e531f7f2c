#pragma once

// The polynomial in which body model compliance moves the surface under a region.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <Eigen/Core>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "ecs/components.hpp"
#include "ecs/model.hpp"
#include "systems/half_space/curved_influence.hpp"
#include "systems/math/linear_algebra.hpp"

namespace torsion::engine {

/// Degree of each of a SupportField's terms.
inline constexpr std::array<int, kSupportTerms> kSupportDegrees{0, 1, 1, 2, 2, 2, 3, 3,
                                                                3, 3, 4, 4, 4, 4, 4};

/// Coordinates of a point at most 1 from the origin: farther out the field goes on as it is at 1,
/// for a polynomial says nothing of what it was not fitted to.
inline glm::dvec2 support_coordinates(const glm::dvec2& point) {
  return point / std::max(1.0, glm::length(point));
}

/// The terms at a place: 1; x, y; x^2, x y, y^2; x^3, x^2 y, ...; ... y^4.
inline std::array<double, kSupportTerms> support_terms(const glm::dvec2& at) {
  const double x = at.x;
  const double y = at.y;
  const double xx = x * x;
  const double xy = x * y;
  const double yy = y * y;
  return {1.0,    x,      y,       xx,      xy,      yy,      xx * x, xx * y,
          yy * x, yy * y, xx * xx, xx * xy, xx * yy, xy * yy, yy * yy};
}

/// How far the field moves a point, m, body.
/// @param point  m, body
glm::dvec3 displacement_at(const SupportField& field, const glm::dvec3& point);

/// What body model compliance knows of a body: its ports, and the matrix of the displacements at
/// ports by forces at ports, (3 ports)^2, row-major, m/N.
struct PortCompliance {
  std::span<const CompliancePort> ports;
  std::span<const ComplianceValue> values;
};

/// The disc or ellipse over which a contact spreads its load.
struct ContactEllipse {
  glm::dvec3 center{0.0};  // m, body: on the rest surface
  glm::dvec3 axis_1{0.0};  // m, body: half axes
  glm::dvec3 axis_2{0.0};
  glm::dvec3 normal{0.0};  // body, unit
  double radius = 0.0;     // m: of the disc of the same area
};

/// Points inside the unit disc and their shares of a load that is spread over it as a rigid disc
/// spreads it, 1 / sqrt(1 - r^2), or as a ball, sqrt(1 - r^2): exact for polynomials of the fifth
/// and fourth degree. Johnson, Contact Mechanics, 1985, 3.4.
struct DiscPoint {
  glm::dvec2 place{0.0};
  double disc_share = 0.0;
  double ball_share = 0.0;
};
inline constexpr std::size_t kDiscPoints = 24;
const std::array<DiscPoint, kDiscPoints>& disc_points();

/// A wrench about the contact's centre as forces at the disc's points laid over its ellipse: normal
/// ones for tilting couples, tangential ones for the twisting couple.
/// @param shares  how it is spread
using DiscForces = std::array<glm::dvec3, kDiscPoints>;
DiscForces spread_wrench(const ContactEllipse& contact, double DiscPoint::*shares,
                         const glm::dvec3& force, const glm::dvec3& couple);

/// Forces on the material, as moments of a SupportField's terms, N.
using SupportMoments = std::array<glm::dvec3, kSupportTerms>;
/// Forces at a support fit's ports, N, or displacements of them, m; the first `count` rows count.
using PortVectors = std::array<glm::dvec3, kSupportPorts>;

/// How far a port is from a point of the surface as a contact there sees it, m: the more its
/// surface is turned away the farther, and kNeverSeen across an edge.
inline constexpr double kNeverSeen = 1e300;
double seen_distance(const CompliancePort& port, const glm::dvec3& point, const glm::dvec3& normal);

/// Whether a support fit still serves for a contact, or has to be found again.
bool still_fits(const SupportFit& support_fit, const ContactEllipse& contact);

/// Lays a support fit: finds ports around the contact (by the distance as seen along the surface),
/// fits a SupportField to displacements at them by least squares, weighted to zero at its reach,
/// and finds the forces at them that unit wrenches on the contact are. Where ports are few the
/// higher terms are kept small; rigid motions are reproduced exactly.
void fit_support(const PortCompliance& body, const ContactEllipse& contact,
                 SupportFit& support_fit);

/// Coordinates along the surface of a point of the body, over the support fit's reach.
glm::dvec2 plain_coordinates_in(const SupportFit& support_fit, const glm::dvec3& point);

/// The same in its SupportField, at most 1 (support_coordinates).
glm::dvec2 coordinates_in(const SupportFit& support_fit, const glm::dvec3& point);

/// Forces at the ports that do the same work as the moments in any SupportField that is fitted to
/// the ports' displacements.
void forces_at_ports(const SupportFit& support_fit, const SupportMoments& moments,
                     PortVectors& forces);

/// Displacements at the ports by forces at them.
void displacements_at_ports(const PortCompliance& body, const SupportFit& support_fit,
                            const PortVectors& forces, PortVectors& displacements);

/// The mean rigid motion at the contact's centre, weighted as a rigid disc spreads its load: the
/// motion of a disc with zero mean slip.
Vector6 rigid_motion(const SupportFit& support_fit, const PortVectors& displacements);

/// What is left of the displacements beyond that rigid motion.
SupportField bending(const SupportFit& support_fit, const PortVectors& displacements,
                     const Vector6& rigid);

/// Rigid motion at `to` by unit wrenches at `from`, through the ports.
Matrix6 motion_between(const PortCompliance& body, const SupportFit& to, const SupportFit& from);

/// response = fit times the ports' compliance times the fit transposed: the terms of the polynomial
/// in which a support fit moves by unit moments.
void find_response(const PortCompliance& body, const SupportFit& support_fit,
                   SupportResponse& response);

/// How a body bends away from the half-space that its contact is taken for, and up to where the
/// contact has to know.
struct SurfaceBend {
  SurfaceCurvature curvature;  // in the axes asked for
  double reach = 0.0;          // m; 0: flat
};

/// Of the surface around a contact. What the curvature adds to a half-space's response goes with
/// the logarithm of the distance (curved_influence.hpp), so that the ports, and the elements
/// between them, know only the part at their own distances. `reach` is the distance at which they
/// have it: the mean, in logarithms, over what the support fit makes of the ports.
/// @param across  m: of the contact
SurfaceBend find_surface_bend(const Model& model, std::uint32_t body, const SupportFit& support_fit,
                              const RegionFrame& axes, double across);

/// Whether any surface of the body may be curved at all.
bool may_bend(const Model& model, std::uint32_t body);

}  // namespace torsion::engine
