#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "ecs/components.hpp"
#include "ecs/device_sample.hpp"

namespace torsion::engine {

/// Springs and dampers between a device's handle and the tool it holds, and the largest force and
/// torque that they come to.
struct VirtualCoupling {
  double stiffness = 0.0;       // N/m
  double damping = 0.0;         // N s/m
  double turn_stiffness = 0.0;  // N m/rad
  double turn_damping = 0.0;    // N m s/rad
  double largest_force = 0.0;   // N
  double largest_torque = 0.0;  // N m
};

/// A frame and how it moves; world axes.
struct MovingFrame {
  Pose pose;
  glm::dvec3 velocity{0.0};          // m/s, of its origin
  glm::dvec3 angular_velocity{0.0};  // rad/s
};

/// The wrench of the coupling on the tool about the tool's origin, world axes; the handle feels the
/// opposite. In turning the spring's potential is 4 k (1 - cos(theta / 2)): its torque
/// 2 k sin(theta / 2) is that of a spring for small angles and largest at pi, with no jump on the
/// way to a whole turn. Force and torque come smoothly to their largest.
Wrench coupling_wrench(const VirtualCoupling& coupling, const MovingFrame& handle,
                       const MovingFrame& tool);

/// `vector` with its length L brought smoothly below `most`: L / sqrt(1 + (L / most)^2). Zero where
/// `most` is.
glm::dvec3 soft_limit(const glm::dvec3& vector, double most);

/// Where a handle keeps a tool where it is, against a wrench of its contacts: coupling_wrench()
/// there is the opposite of `contact`, or nine tenths of the coupling's largest, if that is less.
/// Without stiffness, where the tool is.
/// @param contact  on the tool about its origin, world axes
Pose balancing_handle(const VirtualCoupling& coupling, const Pose& tool, const Wrench& contact);

/// The coupling with limits raised as far as a balancing handle needs them to answer all of
/// `contact`: a tool that is taken while it presses is not thrown off. In turning also with a
/// stiffness that answers within a sixth of a turn. Nothing is lower than it was.
/// @param contact  on the tool about its origin, world axes
VirtualCoupling strong_enough(const VirtualCoupling& coupling, const Wrench& contact);

/// What set a stiffness.
enum class StiffnessLimit {
  kPassivity,  // b > K (T / 2 + t_d)
  kDevice,     // the maker's largest
  kUnknown,    // neither is known: a cautious one
};

struct CouplingChoice {
  VirtualCoupling coupling;
  StiffnessLimit limit = StiffnessLimit::kUnknown;
  StiffnessLimit turn_limit = StiffnessLimit::kUnknown;
};

/// The stiffest coupling that the device can display whatever it touches. A sampled spring is
/// passive where b > K T / 2 + |B| (Colgate & Schenkel, 1997), with a delay b > K (T / 2 + t_d)
/// (Hulin et al., 2014); nine tenths of that, and no damper, which would only cost stiffness.
CouplingChoice choose_coupling(const DeviceTraits& device);

/// For a person: what set a stiffness.
const char* limit_text(StiffnessLimit limit);

/// The stiffness up to which a pure spring between a device of damping b and a passive simulation
/// is passive, N/m: b >= K T / (2 pi). Source: Llewellyn's criterion for a two-port whose device
/// holds its force, worst at half the sampling rate (Adams & Hannaford, 1999).
double virtual_coupling_bound(double damping, double period);

}  // namespace torsion::engine
