#include "systems/contact/support/support_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "systems/math/lanes.hpp"
#include "systems/math/linear_algebra.hpp"

namespace torsion::engine {
glm::dvec3 displacement_at(const SupportField& field, const glm::dvec3& point) {
  const glm::dvec3 from = point - field.origin;
  const auto terms = support_terms(support_coordinates(
      glm::dvec2(glm::dot(field.along_x, from), glm::dot(field.along_y, from))));
  glm::dvec3 moved(0.0);
  for (std::size_t k = 0; k < kSupportTerms; ++k) {
    moved += terms[k] * field.terms[k];
  }
  return moved;
}

namespace {

constexpr std::size_t kLeastPorts = 14;  // that a support fit has, if the body has them
constexpr double kBeyond = 1.3;          // reach over the contact's longer half axis
constexpr double kLeastFacing = 0.4;     // cosine between a port's normal and the contact's
constexpr double kMoved = 0.04;          // of its reach: a contact moved farther is fitted again
constexpr double kGrown = 1.12;          // likewise the contact's radius
constexpr double kTurned = 0.9997;       // likewise the cosine of the normal
/// A smaller contact moves the body between its ports as one of this radius would, over the reach.
/// What couples do to a contact goes with its radius to the third power, forces with the first: of
/// contacts far smaller still, rounding would be all of the one.
constexpr double kPoint = 1e-4;
/// Added to the diagonal against oscillating fits where ports are few, over the sum of the weights,
/// by degree. Constants and slopes are left free.
constexpr std::array<double, 5> kStiffer{0.0, 0.0, 1e-6, 1e-5, 1e-4};

double stiffer(int degree, double size) {
  const double base = kStiffer[static_cast<std::size_t>(degree)];
  return base * std::pow(size, -2.0 * degree);
}

/// Distance within which there are kLeastPorts ports; where the body has fewer, a little more than
/// the farthest one's.
double distance_to_enough(const PortCompliance& body, const ContactEllipse& contact) {
  std::array<double, kLeastPorts> nearest;
  nearest.fill(kNeverSeen);
  for (const CompliancePort& port : body.ports) {
    const double distance = seen_distance(port, contact.center, contact.normal);
    if (distance < nearest.back()) {
      nearest.back() = distance;
      for (std::size_t i = kLeastPorts - 1; i > 0 && nearest[i] < nearest[i - 1]; --i) {
        std::swap(nearest[i], nearest[i - 1]);
      }
    }
  }
  double farthest = 0.0;
  for (const double distance : nearest) {
    farthest = distance < kNeverSeen ? distance : farthest;
  }
  return nearest.back() < kNeverSeen ? farthest : 1.2 * farthest;
}

/// Ports within reach, widest spread first (choose_ports), and their weights.
void find_ports(const PortCompliance& body, const ContactEllipse& contact, double size,
                SupportFit& support_fit, std::array<double, kSupportPorts>& weights) {
  support_fit.count = 0;
  for (std::uint32_t port = 0; port < body.ports.size() && support_fit.count < kSupportPorts;
       ++port) {
    const double share =
        seen_distance(body.ports[port], contact.center, contact.normal) / support_fit.reach;
    if (share < 1.0) {
      const double inner = 1.0 - share * share;
      weights[support_fit.count] = inner * inner / (share * share + 0.5 * size * size);
      support_fit.ports[support_fit.count++] = port;
    }
  }
}

/// Weighted least squares: terms = (A' W A + stiffer)^-1 A' W displacements.
void fit_terms(const PortCompliance& body, const std::array<double, kSupportPorts>& weights,
               double size, SupportFit& support_fit) {
  constexpr std::size_t kStride = kSupportTerms + 1;  // even, for vectors
  std::array<double, kSupportTerms * kStride> normal{};
  support_fit.fit = {};
  double sum = 0.0;
  for (std::size_t p = 0; p < support_fit.count; ++p) {
    const auto terms =
        support_terms(coordinates_in(support_fit, body.ports[support_fit.ports[p]].position));
    sum += weights[p];
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      const double weighted = weights[p] * terms[k];
      support_fit.fit[k][p] = weighted;
      for (std::size_t l = 0; l < kSupportTerms; ++l) {
        normal[k * kStride + l] += weighted * terms[l];
      }
    }
  }
  for (std::size_t k = 0; k < kSupportTerms; ++k) {
    // The last summand keeps terms that no port determines at zero.
    normal[k * (kStride + 1)] += sum * (stiffer(kSupportDegrees[k], size) + 1e-12);
  }
  solve_symmetric(kSupportTerms, kStride, normal.data(), kSupportPorts, support_fit.fit[0].data(),
                  1e-13 * sum);
}

/// Moments of a unit force or couple on the contact along each axis, with the pressure of a rigid
/// disc.
std::array<SupportMoments, 6> moments_of_wrenches(const SupportFit& support_fit,
                                                  const ContactEllipse& contact) {
  std::array<DiscForces, 6> spread;
  for (std::size_t c = 0; c < 6; ++c) {
    glm::dvec3 force(0.0);
    glm::dvec3 couple(0.0);
    (c < 3 ? force : couple)[static_cast<int>(c % 3)] = 1.0;
    spread[c] = spread_wrench(contact, &DiscPoint::disc_share, force, couple);
  }
  std::array<SupportMoments, 6> moments{};
  for (std::size_t q = 0; q < kDiscPoints; ++q) {
    const glm::dvec2 place = disc_points()[q].place;
    const glm::dvec3 arm = contact.axis_1 * place.x + contact.axis_2 * place.y;
    const auto terms = support_terms(coordinates_in(support_fit, contact.center + arm));
    for (std::size_t c = 0; c < 6; ++c) {
      for (std::size_t k = 0; k < kSupportTerms; ++k) {
        moments[c][k] += spread[c][q] * terms[k];
      }
    }
  }
  return moments;
}

}  // namespace

double seen_distance(const CompliancePort& port, const glm::dvec3& point,
                     const glm::dvec3& normal) {
  const double facing = (glm::dot(port.normal, normal) - kLeastFacing) / (1.0 - kLeastFacing);
  return facing > 0.0 ? glm::distance(port.position, point) / facing : kNeverSeen;
}

const std::array<DiscPoint, kDiscPoints>& disc_points() {
  static const std::array<DiscPoint, kDiscPoints> points = [] {
    // With r^2 = 1 - t^2 the shares are dt and t^2 dt over 0 to 1: Gauss' three points.
    constexpr std::array<double, 3> kPlaces{0.1127016653792583, 0.5, 0.8872983346207417};
    constexpr std::array<double, 3> kWeights{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    std::array<DiscPoint, kDiscPoints> made;
    for (std::size_t i = 0; i < kDiscPoints; ++i) {
      const std::size_t ring = i / 8;
      const double t = kPlaces[ring];
      const double angle = 0.25 * std::numbers::pi *
                           (static_cast<double>(i % 8) + 0.5 * static_cast<double>(ring % 2));
      const double radius = std::sqrt(1.0 - t * t);
      made[i] = {{radius * std::cos(angle), radius * std::sin(angle)},
                 kWeights[ring] / 8.0,
                 3.0 * t * t * kWeights[ring] / 8.0};
    }
    return made;
  }();
  return points;
}

DiscForces spread_wrench(const ContactEllipse& contact, double DiscPoint::*shares,
                         const glm::dvec3& force, const glm::dvec3& couple) {
  const double about_normal = glm::dot(couple, contact.normal);
  const glm::dvec3 tilt = couple - contact.normal * about_normal;
  double polar = 0.0;
  glm::dmat3 planar(0.0);
  for (const DiscPoint& point : disc_points()) {
    const glm::dvec3 arm = contact.axis_1 * point.place.x + contact.axis_2 * point.place.y;
    polar += point.*shares * glm::dot(arm, arm);
    planar += point.*shares * glm::outerProduct(arm, arm);
  }
  // Normal forces n (arm . g) have the couple sum of (arm . g) arm x n: g = planar^-1 (n x tilt).
  // Divided by polar first: beside n n' a contact of nanometres would be lost in rounding.
  const glm::dvec3 slope =
      glm::inverse(planar / polar + glm::outerProduct(contact.normal, contact.normal)) *
      (glm::cross(contact.normal, tilt) / polar);
  DiscForces forces;
  for (std::size_t q = 0; q < kDiscPoints; ++q) {
    const DiscPoint& point = disc_points()[q];
    const glm::dvec3 arm = contact.axis_1 * point.place.x + contact.axis_2 * point.place.y;
    forces[q] = point.*shares * (force + contact.normal * glm::dot(arm, slope) +
                                 glm::cross(contact.normal, arm) * (about_normal / polar));
  }
  return forces;
}

bool still_fits(const SupportFit& support_fit, const ContactEllipse& contact) {
  return support_fit.reach > 0.0 &&
         glm::distance(support_fit.center, contact.center) < kMoved * support_fit.reach &&
         contact.radius < kGrown * support_fit.radius &&
         support_fit.radius < kGrown * std::max(contact.radius, kPoint * support_fit.reach) &&
         glm::dot(support_fit.normal, contact.normal) > kTurned;
}

glm::dvec2 plain_coordinates_in(const SupportFit& support_fit, const glm::dvec3& point) {
  const glm::dvec3 from = point - support_fit.origin;
  return glm::dvec2(glm::dot(support_fit.tangent_x, from), glm::dot(support_fit.tangent_y, from)) /
         support_fit.reach;
}

glm::dvec2 coordinates_in(const SupportFit& support_fit, const glm::dvec3& point) {
  return support_coordinates(plain_coordinates_in(support_fit, point));
}

void fit_support(const PortCompliance& body, const ContactEllipse& contact,
                 SupportFit& support_fit) {
  support_fit.origin = contact.center;
  support_fit.center = contact.center;
  support_fit.normal = contact.normal;
  const glm::dvec3 other =
      std::abs(contact.normal.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  support_fit.tangent_x = glm::normalize(glm::cross(contact.normal, other));
  support_fit.tangent_y = glm::cross(contact.normal, support_fit.tangent_x);
  const double enough = distance_to_enough(body, contact);
  ContactEllipse loaded = contact;
  if (loaded.radius < kPoint * enough) {
    loaded.radius = kPoint * enough;
    loaded.axis_1 = loaded.radius * support_fit.tangent_x;
    loaded.axis_2 = loaded.radius * support_fit.tangent_y;
  }
  support_fit.radius = loaded.radius;
  const double longer = std::max(glm::length(loaded.axis_1), glm::length(loaded.axis_2));
  support_fit.extent = longer;
  support_fit.reach = std::max(enough, kBeyond * longer);
  std::array<double, kSupportPorts> weights{};
  const double size = std::max(kBeyond * longer / support_fit.reach, 0.05);
  find_ports(body, loaded, size, support_fit, weights);
  fit_terms(body, weights, size, support_fit);
  const std::array<SupportMoments, 6> moments = moments_of_wrenches(support_fit, loaded);
  for (std::size_t c = 0; c < 6; ++c) {
    forces_at_ports(support_fit, moments[c], support_fit.unit_forces[c]);
  }
}

void forces_at_ports(const SupportFit& support_fit, const SupportMoments& moments,
                     PortVectors& forces) {
  for (std::size_t p = 0; p < support_fit.count; ++p) {
    forces[p] = glm::dvec3(0.0);
  }
  for (std::size_t k = 0; k < kSupportTerms; ++k) {
    for (std::size_t p = 0; p < support_fit.count; ++p) {
      forces[p] += support_fit.fit[k][p] * moments[k];
    }
  }
}

void displacements_at_ports(const PortCompliance& body, const SupportFit& support_fit,
                            const PortVectors& forces, PortVectors& displacements) {
  const std::size_t side = 3 * body.ports.size();
  for (std::size_t to = 0; to < support_fit.count; ++to) {
    const ComplianceValue* const rows = &body.values[3 * std::size_t{support_fit.ports[to]} * side];
    glm::dvec3 sum(0.0);
    for (std::size_t from = 0; from < support_fit.count; ++from) {
      const ComplianceValue* const at = rows + 3 * std::size_t{support_fit.ports[from]};
      const glm::dvec3& f = forces[from];
      sum += glm::dvec3(
          at[0].value * f.x + at[1].value * f.y + at[2].value * f.z,
          at[side].value * f.x + at[side + 1].value * f.y + at[side + 2].value * f.z,
          at[2 * side].value * f.x + at[2 * side + 1].value * f.y + at[2 * side + 2].value * f.z);
    }
    displacements[to] = sum;
  }
}

Vector6 rigid_motion(const SupportFit& support_fit, const PortVectors& displacements) {
  Vector6 motion;
  for (std::size_t c = 0; c < 6; ++c) {
    double sum = 0.0;
    for (std::size_t p = 0; p < support_fit.count; ++p) {
      sum += glm::dot(support_fit.unit_forces[c][p], displacements[p]);
    }
    motion[static_cast<Eigen::Index>(c)] = sum;
  }
  return motion;
}

SupportField bending(const SupportFit& support_fit, const PortVectors& displacements,
                     const Vector6& rigid) {
  SupportField field;
  field.origin = support_fit.origin;
  field.along_x = support_fit.tangent_x / support_fit.reach;
  field.along_y = support_fit.tangent_y / support_fit.reach;
  for (std::size_t k = 0; k < kSupportTerms; ++k) {
    for (std::size_t p = 0; p < support_fit.count; ++p) {
      field.terms[k] += support_fit.fit[k][p] * displacements[p];
    }
  }
  const glm::dvec3 translation(rigid[0], rigid[1], rigid[2]);
  const glm::dvec3 rotation(rigid[3], rigid[4], rigid[5]);
  field.terms[0] -= translation + glm::cross(rotation, support_fit.origin - support_fit.center);
  field.terms[1] -= glm::cross(rotation, support_fit.tangent_x) * support_fit.reach;
  field.terms[2] -= glm::cross(rotation, support_fit.tangent_y) * support_fit.reach;
  return field;
}

Matrix6 motion_between(const PortCompliance& body, const SupportFit& to, const SupportFit& from) {
  using RowMatrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  using Columns = Eigen::Matrix<double, 3, 6>;
  static_assert(sizeof(ComplianceValue) == sizeof(double));
  const auto forces_of = [](const SupportFit& support_fit, std::size_t port) {
    Columns forces;
    for (std::size_t c = 0; c < 6; ++c) {
      const glm::dvec3& force = support_fit.unit_forces[c][port];
      forces.col(static_cast<Eigen::Index>(c)) << force.x, force.y, force.z;
    }
    return forces;
  };
  std::array<Columns, kSupportPorts> forces;
  for (std::size_t j = 0; j < from.count; ++j) {
    forces[j] = forces_of(from, j);
  }
  const std::size_t side = 3 * body.ports.size();
  const Eigen::OuterStride<> stride(static_cast<Eigen::Index>(side));
  Matrix6 motion = Matrix6::Zero();
  for (std::size_t i = 0; i < to.count; ++i) {
    Columns moved = Columns::Zero();
    const ComplianceValue* const rows = &body.values[3 * std::size_t{to.ports[i]} * side];
    for (std::size_t j = 0; j < from.count; ++j) {
      const Eigen::Map<const RowMatrix3, 0, Eigen::OuterStride<>> block(
          &rows[3 * std::size_t{from.ports[j]}].value, stride);
      moved.noalias() += block * forces[j];
    }
    motion.noalias() += forces_of(to, i).transpose() * moved;
  }
  return motion;
}

namespace {

/// Values of one port or one row. Terms lie side by side in vectors: no sum is split over lanes.
using TermRow = std::array<double, kSupportColumn>;

TORSION_WIDEST
void add_terms(double scale, const TermRow& __restrict from, double* __restrict to) {
  for (std::size_t k = 0; k < kSupportColumn; ++k) {
    to[k] += scale * from[k];
  }
}

/// The fit with the terms of each port together.
std::array<TermRow, kSupportPorts> terms_by_port(const SupportFit& support_fit) {
  std::array<TermRow, kSupportPorts> terms{};
  for (std::size_t k = 0; k < kSupportTerms; ++k) {
    for (std::size_t p = 0; p < support_fit.count; ++p) {
      terms[p][k] = support_fit.fit[k][p];
    }
  }
  return terms;
}

}  // namespace

void find_response(const PortCompliance& body, const SupportFit& support_fit,
                   SupportResponse& response) {
  response.serial = support_fit.serial;
  response.terms.fill(0.0);
  const std::array<TermRow, kSupportPorts> fit = terms_by_port(support_fit);
  const std::size_t side = 3 * body.ports.size();
  for (std::size_t force = 0; force < 3; ++force) {
    for (std::size_t to = 0; to < support_fit.count; ++to) {
      // Displacement of the port by the unit moments of this axis, along each axis.
      std::array<TermRow, 3> moved{};
      for (std::size_t from = 0; from < support_fit.count; ++from) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double value = body.values[(3 * std::size_t{support_fit.ports[to]} + axis) * side +
                                           3 * std::size_t{support_fit.ports[from]} + force]
                                   .value;
          add_terms(support_fit.share * value, fit[from], moved[axis].data());
        }
      }
      for (std::size_t moment = 0; moment < kSupportTerms; ++moment) {
        double* const column =
            &response.terms[(force * kSupportColumn + moment) * 3 * kSupportColumn];
        for (std::size_t axis = 0; axis < 3; ++axis) {
          add_terms(moved[axis][moment], fit[to], column + axis * kSupportColumn);
        }
      }
    }
  }
}

}  // namespace torsion::engine
