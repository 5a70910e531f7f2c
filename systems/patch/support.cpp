#include "systems/patch/support.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>

#include "systems/contact/support/contact_load.hpp"
#include "systems/contact/support/support_fit.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/lanes.hpp"
#include "systems/math/wide_lanes.hpp"

namespace torsion::engine {
namespace {

// A body's compliances over those of its contact (yielding_ratio), above which the solver takes
// them into account.
constexpr double kSoft = 0.5;
constexpr std::size_t kAxisColumn = kSupportColumn;
constexpr std::size_t kTermsAtOnce = 5;  // whose sums all machines have registers for
static_assert(kSupportTerms % kTermsAtOnce == 0);

/// Moments of tractions with the terms, summed over the cells.
/// @param cells    a multiple of kLanes, of terms and tractions
/// @param moments  (kAxisColumn) out
template <class Wide>
TORSION_LANES void find_moments(const double* __restrict terms, const double* __restrict traction,
                                std::size_t cells, double* __restrict moments) {
  for (std::size_t first = 0; first < kSupportTerms; first += kTermsAtOnce) {
    Wide sums[kTermsAtOnce] = {};
    for (std::size_t cell = 0; cell < cells; cell += kLanes) {
      const Wide load = lanes_at<Wide>(traction + cell);
      for (std::size_t k = 0; k < kTermsAtOnce; ++k) {
        sums[k] += lanes_at<Wide>(terms + (first + k) * cells + cell) * load;
      }
    }
    for (std::size_t k = 0; k < kTermsAtOnce; ++k) {
      double at[kLanes];
      store_lanes(sums[k], at);
      moments[first + k] =
          ((at[0] + at[4]) + (at[2] + at[6])) + ((at[1] + at[5]) + (at[3] + at[7]));
    }
  }
}

/// polynomials = response times moments.
template <class Wide>
TORSION_LANES void respond(const double* __restrict response, const double* __restrict moments,
                           double* __restrict polynomials) {
  constexpr std::size_t kVectors = 3 * kAxisColumn / kLanes;
  Wide sums[kVectors] = {};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      const double moment = moments[axis * kAxisColumn + k];
      const double* const column = response + (axis * kAxisColumn + k) * 3 * kAxisColumn;
      for (std::size_t row = 0; row < kVectors; ++row) {
        sums[row] += moment * lanes_at<Wide>(column + row * kLanes);
      }
    }
  }
  for (std::size_t row = 0; row < kVectors; ++row) {
    store_lanes(sums[row], polynomials + row * kLanes);
  }
}

/// displacements += the sum of the terms times their values.
template <class Wide>
TORSION_LANES void add_terms(const double* __restrict terms, const double* __restrict values,
                             std::size_t cells, double* __restrict displacements) {
  for (std::size_t cell = 0; cell < cells; cell += kLanes) {
    Wide sum = lanes_at<Wide>(displacements + cell);
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      sum += values[k] * lanes_at<Wide>(terms + k * cells + cell);
    }
    store_lanes(sum, displacements + cell);
  }
}

/// The terms (support_terms) at places of the grid, whose coordinates are origin + turn times
/// place.
/// @param cells  rows from one term to the next
TORSION_WIDEST
void find_terms(const glm::dvec2& origin, const glm::dmat2& turn, std::size_t cells,
                const double* __restrict place_x, const double* __restrict place_y,
                double* __restrict terms) {
  const glm::dvec2 from = origin;
  const glm::dmat2 by = turn;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const double at_x = from.x + (by[0].x * place_x[cell] + by[1].x * place_y[cell]);
    const double at_y = from.y + (by[0].y * place_x[cell] + by[1].y * place_y[cell]);
    const double inside = 1.0 / larger(std::sqrt(at_x * at_x + at_y * at_y), 1.0);
    const double x = at_x * inside;
    const double y = at_y * inside;
    const double xx = x * x;
    const double xy = x * y;
    const double yy = y * y;
    double* const to = terms + cell;
    to[0] = 1.0;
    to[cells] = x;
    to[2 * cells] = y;
    to[3 * cells] = xx;
    to[4 * cells] = xy;
    to[5 * cells] = yy;
    to[6 * cells] = xx * x;
    to[7 * cells] = xx * y;
    to[8 * cells] = yy * x;
    to[9 * cells] = yy * y;
    to[10 * cells] = xx * xx;
    to[11 * cells] = xx * xy;
    to[12 * cells] = xx * yy;
    to[13 * cells] = xy * yy;
    to[14 * cells] = yy * yy;
  }
}

/// The terms at the centres of the region's cells.
void find_columns(const SupportFit& support_fit, const RegionFrame& frame, std::size_t cells,
                  const PatchSupport& support) {
  const glm::dvec3 from = frame.origin - support_fit.origin;
  const glm::dvec2 origin(glm::dot(support_fit.tangent_x, from),
                          glm::dot(support_fit.tangent_y, from));
  const glm::dmat2 turn(glm::dot(support_fit.tangent_x, frame.tangent_x),
                        glm::dot(support_fit.tangent_y, frame.tangent_x),
                        glm::dot(support_fit.tangent_x, frame.tangent_y),
                        glm::dot(support_fit.tangent_y, frame.tangent_y));
  find_terms(origin / support_fit.reach, turn / support_fit.reach, support.cells,
             support.place_x.data(), support.place_y.data(), support.terms.data());
  for (std::size_t k = 0; cells < support.cells && k < kSupportTerms; ++k) {
    std::fill_n(&support.terms[k * support.cells + cells], support.cells - cells, 0.0);
  }
}

using Wrenches = std::array<std::array<glm::dvec3, 2>, 3>;  // force and couple of three tractions

/// Mutual work of three tractions through a 6 x 6 compliance.
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

/// 6 x 6: a region's compliance by the body, including the other regions' reactions.
std::array<double, 36> yielding_of(const SupportFit& support_fit, const RegionReaction& reaction) {
  std::array<double, 36> motion = support_fit.own;
  for (std::size_t k = 0; reaction.active != 0 && k < motion.size(); ++k) {
    motion[k] -= reaction.motion[k];
  }
  return motion;
}

/// Adds the other regions' reaction to the tractions' wrench, as a rigid motion.
/// @param change  the tractions are a change since the other regions reacted
void add_answer(const PatchSupport& support, const SupportPolynomials& moments, bool change,
                SupportPolynomials& polynomials) {
  const SupportFit& support_fit = *support.support_fit;
  const RegionReaction& reaction = *support.reaction;
  const auto moment = [&moments](std::size_t k) {
    return glm::dvec3(moments[k], moments[kAxisColumn + k], moments[2 * kAxisColumn + k]);
  };
  const glm::dvec3 arm_x = support_fit.reach * support_fit.tangent_x;
  const glm::dvec3 arm_y = support_fit.reach * support_fit.tangent_y;
  const glm::dvec3 force = moment(0);
  const glm::dvec3 couple = glm::cross(arm_x, moment(1)) + glm::cross(arm_y, moment(2));
  const std::array<double, 6> wrench{force.x, force.y, force.z, couple.x, couple.y, couple.z};
  std::array<double, 6> moved{};
  for (std::size_t column = 0; column < 6; ++column) {
    const double more = wrench[column] - (change ? 0.0 : reaction.wrench[column]);
    for (std::size_t row = 0; row < 6; ++row) {
      moved[row] -= reaction.motion[column * 6 + row] * more;
    }
  }
  const glm::dvec3 rotation(moved[3], moved[4], moved[5]);
  const std::array<glm::dvec3, 3> terms{glm::dvec3(moved[0], moved[1], moved[2]),
                                        glm::cross(rotation, arm_x), glm::cross(rotation, arm_y)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < terms.size(); ++k) {
      polynomials[axis * kAxisColumn + k] += terms[k][static_cast<int>(axis)];
    }
  }
}

/// How much the body deflects beside its contact: the sum of its compliances over those of the
/// contact.
double yielding_ratio(const Model& model, const RegionIdentity& region,
                      const SupportFit& support_fit, const std::array<double, 36>& yielding) {
  const Elasticity& elasticity = model.bodies.at<Elasticity>(region.body);
  const double a = support_fit.radius;
  // The contact's compliances: at most those of a disc that is pressed, 1 / (2 E* a), and tilted, 3
  // / (4 E* a^3). Johnson, Contact Mechanics, 1985, (3.36) and 3.5.
  const double force = 2.0 * elasticity.contact_modulus() * a;
  const double couple = 4.0 / 3.0 * elasticity.contact_modulus() * a * a * a;
  double sum = 0.0;
  for (std::size_t k = 0; k < 6; ++k) {
    sum += yielding[7 * k] * (k < 3 ? force : couple);
  }
  return sum;
}

void find_yielding(const SupportFit& support_fit, const std::array<double, 36>& yielding,
                   const RegionFrame& frame, PatchSupport& support) {
  const glm::dvec3 arm = frame.origin - support_fit.center;
  const glm::dvec3& x = support.to_body[0];
  const glm::dvec3& y = support.to_body[1];
  const glm::dvec3& z = support.to_body[2];
  const glm::dvec3 none(0.0);
  support.sinks = between(
      yielding, {{{z, glm::cross(arm, z)}, {none, glm::cross(x, z)}, {none, glm::cross(y, z)}}},
      support.area);
  support.slides = between(
      yielding, {{{x, glm::cross(arm, x)}, {y, glm::cross(arm, y)}, {none, glm::cross(x, y)}}},
      support.area);
}

}  // namespace

PatchSupport patch_support(const Model& model, State& state, std::uint32_t region,
                           const DiscStiffness& disc, const PatchCenters& centers,
                           std::span<double> terms) {
  PatchSupport support;
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  if (state.support_fits.empty()) {
    return support;
  }
  const std::uint32_t block = identity.cells.first / identity.cells.count;
  const SupportFit& support_fit = state.support_fits.at<SupportFit>(block);
  if (support_fit.reach == 0.0 || support_fit.on_layer != 0) {
    return support;
  }
  SupportResponse& response = state.support_fits.at<SupportResponse>(block);
  if (response.serial != support_fit.serial) {
    find_response(ports_of(model, identity.body), support_fit, response);
    make_definite(disc, model.bodies.at<Elasticity>(identity.body), support_fit, response);
    support.refitted = true;
  }
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const std::uint32_t side = model.settings.grid_side;
  support.response = &response;
  support.to_body = {frame.tangent_x, frame.tangent_y, -frame.normal};
  support.area = cell_area(frame, side);
  support.cells = whole_lanes(centers.x.size());
  support.support_fit = &support_fit;
  const RegionReaction& reaction = state.regions.at<RegionReaction>(region);
  support.reaction = reaction.active != 0 ? &reaction : nullptr;
  const std::array<double, 36> yielding = yielding_of(support_fit, reaction);
  support.soft = yielding_ratio(model, identity, support_fit, yielding) > kSoft;
  support.terms = terms.first(kSupportTerms * support.cells);
  support.place_x = centers.x;
  support.place_y = centers.y;
  find_columns(support_fit, frame, centers.x.size(), support);
  if (support.soft) {
    find_yielding(support_fit, yielding, frame, support);
  }
  return support;
}

SupportMotion support_by(const PatchSupport& support, const PatchField& tractions, bool change) {
  SupportPolynomials moments{};
  for (int axis = 0; axis < 3; ++axis) {
    const std::span<double>& along =
        axis == 0 ? tractions.x : (axis == 1 ? tractions.y : tractions.z);
    if (along.empty()) {
      continue;
    }
    const glm::dvec3 way = support.area * support.to_body[axis];
    std::array<double, kAxisColumn> sums{};
    TORSION_IN_WIDEST(find_moments, support.terms.data(), along.data(), support.cells, sums.data());
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      moments[k] += way.x * sums[k];
      moments[kAxisColumn + k] += way.y * sums[k];
      moments[2 * kAxisColumn + k] += way.z * sums[k];
    }
  }
  SupportMotion motion;
  TORSION_IN_WIDEST(respond, support.response->terms.data(), moments.data(),
                    motion.polynomials.data());
  for (std::size_t k = 0; k < moments.size(); ++k) {
    motion.energy += 0.5 * moments[k] * motion.polynomials[k];
  }
  if (support.reaction != nullptr) {
    add_answer(support, moments, change, motion.polynomials);
  }
  return motion;
}

void add_support(const PatchSupport& support, const PatchField& tractions,
                 const PatchField& displacements) {
  if (support.response != nullptr) {
    add_polynomials(support, support_by(support, tractions, true).polynomials, displacements);
  }
}

SupportPolynomials known_support(const State& state, std::uint32_t region) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  const SupportFit& support_fit = state.support_fits.at<SupportFit>(block_of(identity));
  const RegionSupport& known = state.regions.at<RegionSupport>(region);
  const glm::dvec3 rotation = known.rotation - known.rotation_by_others;
  const std::array<glm::dvec3, 3> terms{
      known.translation - known.translation_by_others +
          glm::cross(rotation, support_fit.origin - known.about),
      glm::cross(rotation, support_fit.tangent_x) * support_fit.reach,
      glm::cross(rotation, support_fit.tangent_y) * support_fit.reach};
  SupportPolynomials polynomials{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < terms.size(); ++k) {
      polynomials[axis * kAxisColumn + k] = terms[k][static_cast<int>(axis)];
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
    std::array<double, kAxisColumn> values{};
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      values[k] = way.x * polynomials[k] + way.y * polynomials[kAxisColumn + k] +
                  way.z * polynomials[2 * kAxisColumn + k];
    }
    TORSION_IN_WIDEST(add_terms, support.terms.data(), values.data(), support.cells, along.data());
  }
}

}  // namespace torsion::engine
