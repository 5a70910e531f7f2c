#pragma once

// The body models' own: anchors of what is drawn, beams, and the matrix of `compliance`.
// Units, frames and "written by": ecs/components.hpp.

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

#include "ecs/components/regions.hpp"

namespace torsion::engine {

inline constexpr std::uint32_t kAnchorsPerBody = 48;

/// A point of the body's rest surface at which the body model gives displacement. Written by: load.
struct AnchorRest {
  glm::dvec3 position{0.0};  // m, body
};

/// A point of the rest surface of a body with body model `compliance` between which and the others
/// it is known what forces do. Written by: load.
struct CompliancePort {
  glm::dvec3 position{0.0};  // m, body
  glm::dvec3 normal{0.0};    // body, unit, outward
};

/// One value of the matrix of a body with body model `compliance`: how forces at its ports move the
/// material beyond what half-spaces do. Written by: load.
struct ComplianceValue {
  double value = 0.0;  // m/N, rad/N
};

inline constexpr std::uint32_t kSupportPorts = 32;

/// How a region stands on the ports around it: what its tractions are as forces at them, and how
/// their displacements make a SupportField. Found again when the contact has moved or grown.
/// Written by: compliance.
struct SupportFit {
  glm::dvec3 origin{0.0};     // m, body
  glm::dvec3 tangent_x{0.0};  // body, unit
  glm::dvec3 tangent_y{0.0};
  glm::dvec3 normal{0.0};
  double reach = 0.0;          // m: of the ports, and unit of the coordinates; 0: never laid
  glm::dvec3 center{0.0};      // m, body: of the contact for which it was laid
  double radius = 0.0;         // m: of that contact
  double extent = 0.0;         // m: its longer half axis
  double share = 1.0;          // of the displacements that is let through (below)
  std::uint64_t serial = 0;    // no two that were laid have the same
  std::uint32_t on_layer = 0;  // 1: not the ports but `own` moves it, all of it
  std::uint32_t count = 0;     // of the ports
  std::array<std::uint32_t, kSupportPorts> ports{};
  std::array<std::array<double, kSupportPorts>, kSupportTerms> fit{};  // term by displacement
  // Forces at the ports that are a unit wrench about `center`, spread as a rigid disc would.
  std::array<std::array<glm::dvec3, kSupportPorts>, 6> unit_forces{};
  std::array<double, 36> own{};  // 6 x 6: motion at `center` by that unit wrench, what yields of it
  // 3 x 3, m/N, body: how the body's bend beside its half-space moves it by a force, for contact
  // models without cells. `patch` has the bend in its own tables (patch/region.hpp).
  std::array<double, 9> bend{};
};

inline constexpr std::uint32_t kSupportColumn = 16;  // terms of one axis, with one more of zero

/// What becomes of a region's tractions through its support fit's ports: the three axes' terms,
/// body axes, by the tractions' moments with their terms, m/N. Column by column; in a column and
/// from one column to the next kSupportColumn an axis. Written by: patch_forces.
struct SupportResponse {
  std::uint64_t serial = 0;  // of the support fit for which it was found
  std::array<double, std::size_t{9} * kSupportColumn * kSupportColumn> terms{};
};

/// 6 x 6, body axes: how a wrench on one region moves the material under another one. Written by:
/// compliance.
struct RegionCoupling {
  std::uint64_t serial_to = 0;  // of the support fits between which it was found
  std::uint64_t serial_from = 0;
  std::array<double, 36> motion{};
};

inline constexpr std::uint32_t kBeamStations = 16;

/// Sections of the straight beam from an anchor to the fixed point, root first: cut perpendicular
/// to the beam. Written by: load.
struct BeamSection {
  double area = 0.0;              // A, m^2
  double bending_xx = 0.0;        // I about the first transverse axis, m^4
  double bending_yy = 0.0;        // I about the second transverse axis, m^4
  double bending_xy = 0.0;        // product of inertia, m^4
  double torsion_constant = 0.0;  // J of Saint-Venant, m^4
  double polar = 0.0;             // polar second moment, m^4
};

}  // namespace torsion::engine
