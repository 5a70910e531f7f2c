#pragma once

#include "ecs/model.hpp"
#include "systems/contact/support/footing.hpp"

namespace torsion {

/// How a unit wrench on a contact of a layer, spread as a ball spreads it, moves the contact as a
/// rigid body (6 x 6, body axes, about its centre) beyond what it would do on a half-space.
/// @param body       with a layer's kernel
/// @param thickness  m
Matrix6 layer_motion(const Model& model, std::uint32_t body, const ContactEllipse& contact,
                     double thickness);

}  // namespace torsion
