#pragma once

#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/lubkin.hpp"
#include "tests/reference/exact/materials.hpp"

namespace torsion::engine::reference {

inline constexpr PressureShape kPressureShapes[] = {PressureShape::kWinkler, PressureShape::kHertz,
                                                    PressureShape::kUniform,
                                                    PressureShape::kFlatPunch};

/// Sphere of 50 mm on rubber: the case of most tables.
inline LubkinContact twisted_rubber(PressureShape shape = PressureShape::kHertz,
                                    double force = 10.0, double friction = 0.75) {
  const HertzSphere sphere = hertz_sphere_at_force(0.05, contact_modulus(3e6, 0.5), force);
  return {shape, force, friction, sphere.radius, shear_modulus(3e6, 0.5)};
}

}  // namespace torsion::engine::reference
