#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ecs/components.hpp"
#include "ecs/result.hpp"
#include "systems/geometry/distance.hpp"
#include "systems/half_space/fields.hpp"
#include "systems/model/expected_rolling.hpp"

namespace torsion::engine {

/// A linear elastic body, at rest and free but for where it is clamped.
struct ElasticSolid {
  std::function<Distance(const glm::dvec3&)> signed_distance;  // m, body; negative inside
  Bounds bounds;                                               // m, body
  // Of a point in the body or on its surface, there to the accuracy of signed_distance: what is to
  // hold a face must allow for that. The clamp's end is found inside the grid's cells; a clamp that
  // holds no node of the grid is not.
  std::function<bool(const glm::dvec3&)> clamped;
  Elasticity elasticity;
};

struct SmoothComplianceOptions {
  std::uint32_t elements = 16;  // along the longest side of the bounds, 8 to 64; at least 8
                                // along the others. The factor of a cube takes 50 MB at
                                // 16, 270 MB at 24, growing with the fourth power
  std::uint32_t threads = 1;    // the result is the same bits for any number
  std::function<void(double)> progress;  // called with 0 to 1 as it goes on, if set
  bool couples = true;                   // false: the ports take forces only
};

/// How wrenches at ports move the material at ports, beyond what half-spaces do: the part of a
/// body's compliance that comes from its finite size, its clamp and its shape. The motion at port i
/// under a wrench at port j is their block of `matrix` plus half_space_coupling(i, j), for i = j
/// plus what the contact itself does to the half-space at the port.
struct SmoothCompliance {
  Eigen::MatrixXd matrix;           // 6M x 6M, body axes, SI, symmetric: rows translation (m) and
                                    // rotation (rad) of port i; columns force (N) and torque (N m)
                                    // about port j. Without couples 3M x 3M
  Eigen::MatrixXd turns;            // 3M x 3M, without couples only: rotation (rad) of port i by
                                    // force (N) at port j
  double relative_asymmetry = 0.0;  // of the compliance between ports, half-spaces included,
                                    // before it was made symmetric: |C - C'| / |C|, Frobenius
                                    // norms, rotations times half the longest side
};

/// Solves for the smooth compliance by finite elements. For each unit wrench at a port the
/// displacement is split into the half-space's closed form and a rest that is smooth near the port;
/// only the rest is discretised, driven by minus the closed form's tractions on the free surface
/// and minus its displacement at the clamp.
///
/// Errors at 16 elements, for ports farther than two elements from edges: 0.5 % between forces and
/// displacements, 2 % between forces and rotations, some 5 % between torques and rotations, most of
/// it across edges; bars 1 to 3 % in torsion, exact in stretch and bending; round bodies 5 %, from
/// where the clamp ends. A bulk modulus above 1e4 G is taken as that. A wrench is a point's: of a
/// contact so large that it matters where in it the forces act (on a cube of side b, a torque over
/// a disc of radius 0.2 b: 2.5 %, 0.4 b: 12 % of the smooth part), take the forces and
/// displacements of several ports in it.
/// @param ports  on the solid's surface
/// @return an Error when the bounds are empty, nothing of the body is found in them, the clamp
///         holds fewer than three nodes that are not in line, or the material is no solid
Result<SmoothCompliance> build_smooth_compliance(const ElasticSolid& solid,
                                                 std::span<const Port> ports,
                                                 const SmoothComplianceOptions& options);

/// The same through the cache. The matrix scales with 1/E, so E is not in the key.
/// @param identity  bytes that tell the solid's shape and clamp from every other's
Result<SmoothCompliance> load_or_build_smooth_compliance(const ElasticSolid& solid,
                                                         std::span<const std::byte> identity,
                                                         std::span<const Port> ports,
                                                         const SmoothComplianceOptions& options);

/// Up to `count` ports spread over the free surface, each with its mirror images in the planes in
/// which the body and its clamp are symmetric, and each next one farthest from all before it and
/// from the clamp, in distances that count 2.5 times as much at the end of the body opposite of the
/// clamp as a shortest side away from it; none at the clamp, none so near a sharp edge that the
/// surface bends away within a third of the ports' mean spacing. Where a scene's contacts are does
/// not count: on the side of a cube, and of a column twice as high as wide, 128 ports so chosen are
/// within 0.2 and 0.4 % of 500 that are densest there, and one cache serves all scenes of a body.
/// A face that has none of its own after that gets some, up to `count` more. On a body whose walls
/// are thinner than ports would be apart, they are densest where contacts are expected.
std::vector<Port> choose_ports(const ElasticSolid& solid, std::uint32_t count,
                               const ExpectedPlace& expected = {});

/// How far apart its ports are over how thick the body is, as a contact in the expected place sees
/// it, of nine in ten points there; anywhere where none is known. Above 1 a contact may stand where
/// the ports know nothing of it.
double port_distance_over_thickness(const ElasticSolid& solid, std::span<const Port> ports,
                                    const ExpectedPlace& expected);

}  // namespace torsion::engine
