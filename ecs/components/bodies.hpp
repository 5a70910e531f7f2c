#pragma once

// What a body is made of, what holds it, and which models run on it.
// Units, frames and "written by": ecs/components.hpp.

#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "ecs/components/basics.hpp"
#include "ecs/contact_models.hpp"
#include "ecs/range.hpp"

namespace torsion::engine {

/// Linear elastic, isotropic. Written by: load.
struct Elasticity {
  double youngs_modulus = 3e6;  // E, Pa
  double poisson_ratio = 0.5;   // nu
  double density = 1100.0;      // rho, kg/m^3
  [[nodiscard]] double shear_modulus()
      const {  // G = E / (2 (1 + nu)), equation (3) of the paper, Pa
    return youngs_modulus / (2.0 * (1.0 + poisson_ratio));
  }
  [[nodiscard]] double contact_modulus() const {  // E* = E / (1 - nu^2) against a rigid tool, Pa
    return youngs_modulus / (1.0 - poisson_ratio * poisson_ratio);
  }
};

/// The body node's frame in the world, now and one step ago. Written by: move_bodies.
struct BodyPose {
  Pose now;
  Pose before;
};

/// How a tool moves over a body in a step, seen from the body: body axes. Written by: move_bodies.
struct ToolOverBody {
  glm::dvec3 shift{0.0};   // m, of the tool's mass centre
  glm::dvec3 turn{0.0};    // rad, rotation vector
  glm::dvec3 center{0.0};  // m: where the mass centre is now
  glm::dvec3 axis{0.0};    // unit once it has turned: the rotation axis with a short memory
  double axis_turn = 0.0;  // rad, how much turning that memory holds
};

/// Coulomb coefficients, static_friction >= dynamic_friction >= 0. Written by: load.
struct Friction {
  double static_friction = 0.75;
  double dynamic_friction = 0.75;
};

enum class FixedKind : std::uint32_t { kPoint, kFace, kVolumes };

/// What holds the body. Written by: load.
struct FixedRegion {
  FixedKind kind = FixedKind::kPoint;
  std::uint32_t padding = 0;
  glm::dvec3 point{
      0.0};  // m, body: q_f of the paper; the centroid of a face or of the fixed volumes
  glm::dvec3 normal{0.0};  // body, unit, into the body; only for kFace
  Range volumes;           // rows in `fixed_volumes`; kPoint and kFace have none
};

enum class VolumeKind : std::uint32_t { kBox, kSphere };

/// A unit box (side 2) or unit sphere (radius 1) whose image fixes what of the body lies in it.
/// Written by: load.
struct FixedVolume {
  glm::dmat3 to_unit{1.0};  // unit = to_unit * (x_body - center)
  glm::dvec3 center{0.0};   // m, body
  VolumeKind kind = VolumeKind::kBox;
  std::uint32_t padding = 0;
};

#define TORSION_ENUMERATOR(name, text) k##name,
enum class ContactModel : std::uint32_t { kAuto, TORSION_CONTACT_MODELS(TORSION_ENUMERATOR) };
#undef TORSION_ENUMERATOR
enum class BodyModel : std::uint32_t { kAuto, kNone, kSkeleton, kCompliance };

/// What the scene asked for and, once prepared, what runs (never kAuto). Written by: load.
struct BodyModels {
  ContactModel contact = ContactModel::kAuto;
  BodyModel body = BodyModel::kAuto;
  double tolerance = 0.05;        // relative error in the torque that kAuto may make
  double region_threshold = 0.0;  // r_th, m; at least what the sampling resolves
};

/// Which rows of other tables belong to a tool or body. Written by: load.
struct OwnedRows {
  Range parts;         // in `parts`
  Range samples;       // in `samples`; tools only
  Range balls;         // in `balls`; tools only
  Range anchors;       // in `anchors`; bodies only
  Range influences;    // in `influences`: tables of contact model patch, none for others
  Range layer_kernel;  // likewise: of a layer with body model compliance (half_space/layer.hpp)
  Range ports;         // in `ports`; body model compliance only, the first of them are its anchors
  Range compliance;    // in `compliance`, 3 rows a port of 3 numbers a port, displacements by the
                       // force there, m/N; then 3 rows a port of 3 an anchor, turns by it, rad/N
};

/// What bounds the forces of a body's regions (region_wrenches.hpp). Written by: region_wrenches.
struct StoredEnergy {
  double most = 0.0;   // J: what the regions' contacts may hold; 0 where there are none
  double peak = 0.0;   // J: the largest that `most` has been
  double work = 0.0;   // J: what the tools have done on the body in this step
  double force = 0.0;  // N: the largest normal force of a region in the last step without a fault
  std::uint32_t faulty = 0;  // 1: the last step had one, and its force is half of this one's work
  std::uint32_t padding = 0;
};

/// Axis-aligned box of the rest shape in the owner's frame. Written by: load.
struct Bounds {
  glm::dvec3 lowest{0.0};   // m
  glm::dvec3 highest{0.0};  // m
};

}  // namespace torsion::engine
