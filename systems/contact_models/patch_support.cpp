#include "systems/contact_models/patch_support.hpp"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>

#include "systems/body_models/contact_load.hpp"
#include "systems/body_models/footing_response.hpp"
#include "systems/body_models/support_field.hpp"
#include "systems/frames.hpp"
#include "systems/widest.hpp"

namespace torsion {
namespace {

constexpr std::size_t kColumn = kSupportColumn;
constexpr std::size_t kLanes = 8;  // partial sums, the same ones in vectors of any width

/// Moments of tractions with the terms, sums over the cells.
/// @param moments  (kColumn) out
TORSION_WIDEST
void find_moments(const double* __restrict terms, const double* __restrict traction,
                  std::size_t cells, double* __restrict moments) {
  for (std::size_t k = 0; k < kSupportTerms; ++k) {
    const double* const term = terms + k * cells;
    std::array<double, kLanes> sums{};
    std::size_t cell = 0;
    for (; cell + kLanes <= cells; cell += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        sums[lane] += term[cell + lane] * traction[cell + lane];
      }
    }
    for (std::size_t lane = 0; cell < cells; ++cell, ++lane) {
      sums[lane] += term[cell] * traction[cell];
    }
    moments[k] =
        ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
  }
}

/// polynomials += response times moments.
TORSION_WIDEST
void respond(const double* __restrict response, const double* __restrict moments,
             double* __restrict polynomials) {
  constexpr std::size_t kRows = 3 * kColumn;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      const double moment = moments[axis * kColumn + k];
      const double* const column = response + (axis * kColumn + k) * kRows;
      for (std::size_t row = 0; row < kRows; ++row) {
        polynomials[row] += moment * column[row];
      }
    }
  }
}

/// displacements += the sum of the terms times their values.
TORSION_WIDEST
void add_terms(const double* __restrict terms, const double* __restrict values, std::size_t cells,
               double* __restrict displacements) {
  for (std::size_t k = 0; k < kSupportTerms; ++k) {
    const double* const term = terms + k * cells;
    const double value = values[k];
    for (std::size_t cell = 0; cell < cells; ++cell) {
      displacements[cell] += value * term[cell];
    }
  }
}

/// The terms at the centres of the region's cells, and these.
void find_columns(const Footing& footing, const RegionFrame& frame, std::uint32_t side,
                  const PatchSupport& support) {
  const glm::dvec3 from = frame.origin - footing.origin;
  const glm::dvec2 origin(glm::dot(footing.tangent_x, from), glm::dot(footing.tangent_y, from));
  const glm::dmat2 turn(
      glm::dot(footing.tangent_x, frame.tangent_x), glm::dot(footing.tangent_y, frame.tangent_x),
      glm::dot(footing.tangent_x, frame.tangent_y), glm::dot(footing.tangent_y, frame.tangent_y));
  std::size_t cell = 0;
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      const glm::dvec2 center = cell_center(frame, side, i, j);
      const glm::dvec2 at = (origin + turn * center) / footing.reach;
      const auto values = support_terms(support_coordinates(at));
      for (std::size_t k = 0; k < kSupportTerms; ++k) {
        support.terms[k * support.cells + cell] = values[k];
      }
      support.place_x[cell] = center.x;
      support.place_y[cell] = center.y;
    }
  }
}

using Wrenches = std::array<std::array<glm::dvec3, 2>, 3>;  // force and couple of three tractions

/// Motions by three tractions as those do work on them, through a 6 x 6 compliance.
glm::dmat3 between(const std::array<double, 36>& compliance, const Wrenches& wrenches,
                   double area) {
  const auto part = [](const std::array<glm::dvec3, 2>& wrench, std::size_t k) {
    return wrench[k / 3][static_cast<int>(k % 3)];
  };
  glm::dmat3 motions(0.0);
  for (int to = 0; to < 3; ++to) {
    for (int from = 0; from < 3; ++from) {
      for (std::size_t row = 0; row < 6; ++row) {
        for (std::size_t column = 0; column < 6; ++column) {
          motions[from][to] += area * compliance[column * 6 + row] *
                               part(wrenches[static_cast<std::size_t>(to)], row) *
                               part(wrenches[static_cast<std::size_t>(from)], column);
        }
      }
    }
  }
  return motions;
}

/// Whether the body gives way by so much, beside its contact, that the solver has to know.
bool yields_much(const World& world, const RegionIdentity& region, const Footing& footing) {
  constexpr double kMuch = 0.5;
  const Elasticity& elasticity = world.bodies.at<Elasticity>(region.body);
  const double a = footing.radius;
  // The sum of its compliances over those of a contact: at most that of a disc pressed, 1 / (2 E*
  // a), and tilted, 3 / (4 E* a^3). Johnson, Contact Mechanics, 1985, (3.36) and 3.5.
  const double force = 2.0 * elasticity.contact_modulus() * a;
  const double couple = 4.0 / 3.0 * elasticity.contact_modulus() * a * a * a;
  double sum = 0.0;
  for (std::size_t k = 0; k < 6; ++k) {
    sum += footing.own[7 * k] * (k < 3 ? force : couple);
  }
  return sum > kMuch;
}

void find_yielding(const Footing& footing, const RegionFrame& frame, PatchSupport& support) {
  const glm::dvec3 arm = frame.origin - footing.center;
  const glm::dvec3& x = support.to_body[0];
  const glm::dvec3& y = support.to_body[1];
  const glm::dvec3& z = support.to_body[2];
  const glm::dvec3 none(0.0);
  support.sinks = between(
      footing.own, {{{z, glm::cross(arm, z)}, {none, glm::cross(x, z)}, {none, glm::cross(y, z)}}},
      support.area);
  support.slides = between(
      footing.own, {{{x, glm::cross(arm, x)}, {y, glm::cross(arm, y)}, {none, glm::cross(x, y)}}},
      support.area);
}

}  // namespace

PatchSupport patch_support(World& world, std::uint32_t region, std::span<double> columns) {
  PatchSupport support;
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
  if (world.footings.empty()) {
    return support;
  }
  const std::uint32_t block = identity.cells.first / identity.cells.count;
  const Footing& footing = world.footings.at<Footing>(block);
  if (footing.reach == 0.0 || footing.on_layer != 0) {
    return support;
  }
  FootingResponse& response = world.footings.at<FootingResponse>(block);
  if (response.serial != footing.serial) {
    find_response(ports_of(world, identity.body), footing, response);
  }
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  const std::uint32_t side = world.settings.at<Settings>(0).grid_side;
  support.response = &response;
  support.to_body = {frame.tangent_x, frame.tangent_y, -frame.normal};
  support.area = cell_area(frame, side);
  support.cells = std::size_t{side} * side;
  support.soft = yields_much(world, identity, footing);
  support.terms = columns.first(kSupportTerms * support.cells);
  support.place_x = columns.subspan(kSupportTerms * support.cells, support.cells);
  support.place_y = columns.subspan((kSupportTerms + 1) * support.cells, support.cells);
  find_columns(footing, frame, side, support);
  if (support.soft) {
    find_yielding(footing, frame, support);
  }
  return support;
}

SupportPolynomials support_by(const PatchSupport& support, const PatchField& tractions) {
  SupportPolynomials moments{};
  for (int axis = 0; axis < 3; ++axis) {
    const std::span<double>& along =
        axis == 0 ? tractions.x : (axis == 1 ? tractions.y : tractions.z);
    if (along.empty()) {
      continue;
    }
    const glm::dvec3 way = support.area * support.to_body[axis];
    std::array<double, kColumn> sums{};
    find_moments(support.terms.data(), along.data(), support.cells, sums.data());
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      moments[k] += way.x * sums[k];
      moments[kColumn + k] += way.y * sums[k];
      moments[2 * kColumn + k] += way.z * sums[k];
    }
  }
  SupportPolynomials polynomials{};
  respond(support.response->terms.data(), moments.data(), polynomials.data());
  return polynomials;
}

void add_support(const PatchSupport& support, const PatchField& tractions,
                 const PatchField& displacements) {
  if (support.response != nullptr) {
    add_polynomials(support, support_by(support, tractions), displacements);
  }
}

SupportPolynomials known_support(const World& world, std::uint32_t region) {
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
  const Footing& footing = world.footings.at<Footing>(identity.cells.first / identity.cells.count);
  const RegionSupport& known = world.regions.at<RegionSupport>(region);
  const glm::dvec3 rotation = known.rotation - known.rotation_by_others;
  const std::array<glm::dvec3, 3> terms{known.translation - known.translation_by_others +
                                            glm::cross(rotation, footing.origin - known.about),
                                        glm::cross(rotation, footing.tangent_x) * footing.reach,
                                        glm::cross(rotation, footing.tangent_y) * footing.reach};
  SupportPolynomials polynomials{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < terms.size(); ++k) {
      polynomials[axis * kColumn + k] = terms[k][static_cast<int>(axis)];
    }
  }
  return polynomials;
}

void add_polynomials(const PatchSupport& support, const SupportPolynomials& polynomials,
                     const PatchField& displacements) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::span<double>& along =
        axis == 0 ? displacements.x : (axis == 1 ? displacements.y : displacements.z);
    if (along.empty()) {
      continue;
    }
    const glm::dvec3& way = support.to_body[axis];
    std::array<double, kColumn> values{};
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      values[k] = way.x * polynomials[k] + way.y * polynomials[kColumn + k] +
                  way.z * polynomials[2 * kColumn + k];
    }
    add_terms(support.terms.data(), values.data(), support.cells, along.data());
  }
}

}  // namespace torsion
