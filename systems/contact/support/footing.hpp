#pragma once

#include <array>
#include <span>

#include <Eigen/Core>

#include "ecs/components.hpp"
#include "systems/math/matrix6.hpp"

namespace torsion {

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
/// Forces at a footing's ports, N, or displacements of them, m; the first `count` rows count.
using PortVectors = std::array<glm::dvec3, kFootingPorts>;

/// How far a port is from a point of the surface as a contact there sees it, m: the more its
/// surface is turned away the farther, and kNeverSeen across an edge.
inline constexpr double kNeverSeen = 1e300;
double seen_distance(const CompliancePort& port, const glm::dvec3& point, const glm::dvec3& normal);

/// Whether a footing still serves for a contact, or has to be laid anew.
bool still_fits(const Footing& footing, const ContactEllipse& contact);

/// Lays a footing: finds ports around the contact (by the distance as seen along the surface),
/// fits a SupportField to displacements at them by least squares, weighted to zero at its reach,
/// and finds the forces at them that unit wrenches on the contact are. Where ports are few the
/// higher terms are kept small; rigid motions are reproduced exactly.
void lay_footing(const PortCompliance& body, const ContactEllipse& contact, Footing& footing);

/// Coordinates along the surface of a point of the body, over the footing's reach.
glm::dvec2 plain_coordinates_in(const Footing& footing, const glm::dvec3& point);

/// The same in its SupportField, at most 1 (support_coordinates).
glm::dvec2 coordinates_in(const Footing& footing, const glm::dvec3& point);

/// Forces at the ports that do the same work as the moments in any SupportField that is fitted to
/// the ports' displacements.
void forces_at_ports(const Footing& footing, const SupportMoments& moments, PortVectors& forces);

/// Displacements at the ports by forces at them.
void displacements_at_ports(const PortCompliance& body, const Footing& footing,
                            const PortVectors& forces, PortVectors& displacements);

/// The mean rigid motion at the contact's centre, weighted as a rigid disc spreads its load: the
/// motion of a disc that would slip in no mean.
Vector6 rigid_motion(const Footing& footing, const PortVectors& displacements);

/// What is left of the displacements beyond that rigid motion.
SupportField bending(const Footing& footing, const PortVectors& displacements,
                     const Vector6& rigid);

/// Rigid motion at `to` by unit wrenches at `from`, through the ports.
Matrix6 motion_between(const PortCompliance& body, const Footing& to, const Footing& from);

}  // namespace torsion
