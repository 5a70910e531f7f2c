#pragma once

// Keeps what a body adds to its half-space from taking more away than there is.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>

#include "ecs/components.hpp"
#include "ecs/state.hpp"

namespace torsion::engine {

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

/// Makes the response M of a support fit such that the whole surface under it, half-space and body,
/// is a compliance: S^(1/2) M S^(1/2) >= kLeastResponse, with S of a disc that holds the contact,
/// so that t' (A + Q M Q') t >= (1 + kLeastResponse) t' A t for all tractions t. Where it is, not a
/// bit changes. What finite elements and the fit to ports say of thin walls and of contacts wider
/// than the ports' distance may break it. Takes nothing from the heap.
/// @return true if it had to be changed
bool make_definite(const DiscStiffness& disc, const Elasticity& elasticity,
                   const SupportFit& support_fit, SupportResponse& response);

// What the whole body's own compliance adds to the displacements of a grid's cells.

/// A linear map from tractions of the cells to displacements of them, of as many dimensions as
/// there are terms: displacement = Q M Q' force, with Q the terms at the cells and M the support
/// fit's response. Tractions and displacements are those of PatchColumns: on the body, z into it.
struct PatchSupport {
  const SupportResponse* response = nullptr;  // null: the body deflects as a half-space does
  const SupportFit* support_fit = nullptr;
  const RegionReaction* reaction = nullptr;  // null: other regions do not answer within the step
  glm::dmat3 to_body{1.0};                   // from x, y, z of the columns
  double area = 0.0;                         // m^2, of a cell
  bool soft = false;                         // deflects by much beside the contact itself
  bool refitted = false;                     // the response is not that of the last step
  std::size_t cells = 0;    // rows of a term: those of the cells and zeros up to whole lanes, which
                            // all columns that tractions come from or displacements go to have, too
  std::span<double> terms;  // (kSupportTerms x cells)
  std::span<const double> place_x, place_y;  // m, grid: the cells' centres
  // Of what is soft: what moves the cells as one, and yields, m/N times a cell's area: along z by
  // the moments of tractions along z with 1, x, y; and along the surface by those of the sideways
  // ones, x, y, turning about the grid's origin.
  glm::dmat3 sinks{0.0};
  glm::dmat3 slides{0.0};
};

/// The cells' centres.
struct PatchCenters {
  std::span<const double> x, y;  // m, grid, (side x side)
};

/// One grid's tractions or displacements; an empty column is zero or not asked for.
struct PatchField {
  std::span<double> x, y, z;
};

/// The polynomials of the three axes, kSupportColumn each, body axes.
using SupportPolynomials = std::array<double, std::size_t{3} * kSupportColumn>;

/// What tractions move, and the energy that the body holds of it.
struct SupportMotion {
  SupportPolynomials polynomials{};  // m
  double energy = 0.0;               // J
};

/// The region's, or none. Finds the support's response again when that has been refitted.
/// @param terms  (kSupportTerms x whole lanes of cells) out
PatchSupport patch_support(const Model& model, State& state, std::uint32_t region,
                           const DiscStiffness& disc, const PatchCenters& centers,
                           std::span<double> terms);

/// @param change  tractions are a change: of the other regions' answer only that to them
SupportMotion support_by(const PatchSupport& support, const PatchField& tractions, bool change);

/// The motion that the region's RegionSupport has of it already.
SupportPolynomials known_support(const State& state, std::uint32_t region);

/// displacements += what tractions move; nothing without a response.
void add_support(const PatchSupport& support, const PatchField& tractions,
                 const PatchField& displacements);

/// displacements += the polynomials at the cells.
void add_polynomials(const PatchSupport& support, const SupportPolynomials& polynomials,
                     const PatchField& displacements);

}  // namespace torsion::engine
