#pragma once

// Keeps what a body adds to its half-space from taking more away than there is.

#include <array>

#include "ecs/components.hpp"

namespace torsion {

/// How stiff a half-space is against displacements of a disc that are a SupportField's terms, over
/// shear modulus and radius: S = Q' A^-1 Q, with A the half-space's influences of the disc's points
/// on each other and Q the terms at them, in coordinates over the radius, for nu = 0.5, where
/// pressure and traction are apart. Lower factors L of S = L L'.
struct DiscStiffness {
  static constexpr std::size_t kTangential = 2 * std::size_t{kSupportTerms};
  std::array<double, std::size_t{kSupportTerms} * kSupportTerms> normal{};  // row-major
  std::array<double, kTangential * kTangential> tangential{};               // x, then y; row-major
};

/// By boundary elements: Boussinesq's and Cerruti's solutions on some hundred squares.
DiscStiffness make_disc_stiffness();

/// The least eigenvalue that a response may have over the half-space's own compliance: -1 would
/// leave no compliance at all, and the contact's equations have no solution below it.
inline constexpr double kLeastResponse = -0.75;

/// Makes the response M of a footing such that the whole surface under it, half-space and body, is
/// a compliance: S^(1/2) M S^(1/2) >= kLeastResponse, with S of a disc that holds the contact, so
/// that t' (A + Q M Q') t >= (1 + kLeastResponse) t' A t for all tractions t. Where it is, not a
/// bit changes. What finite elements and the fit to ports say of thin walls and of contacts wider
/// than the ports' distance may break it. Takes nothing from the heap.
/// @return true if it had to be changed
bool make_definite(const DiscStiffness& disc, const Elasticity& elasticity, const Footing& footing,
                   FootingResponse& response);

}  // namespace torsion
