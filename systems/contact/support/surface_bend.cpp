#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "systems/contact/support/support_fit.hpp"
#include "systems/geometry/bounds.hpp"
#include "systems/geometry/distance.hpp"
#include "systems/math/frames.hpp"

namespace torsion::engine {
namespace {

/// Of the elements' length. Ports that are nearer to each other than this influence each other as
/// at this distance, because the elements' loads and the fits of their motions are as wide
/// (model/finite_elements/loads.cpp). Measured on a sphere 24 elements across: ports at distances
/// of 0, 1, 2, 3 and 4 elements act, less the sphere's rocking, as at 2.1, 2.2, 2.4, 3.2 and 4.
/// Twice this value would change a contact's tangential compliance by 0.4 % at a / R = 0.01.
constexpr double kElementsSee = 2.1;
constexpr double kFlat = 1e-3;  // curvature times reach: less is not worth tables
constexpr double kEdge = 0.9;   // cosine between normals a reach apart: no gentle curve
constexpr double kSpan = 0.5;   // of the reach: where the curvature is measured

double port_spacing(const Model& model, std::uint32_t body) {
  const Bounds& bounds = model.bodies.at<Bounds>(body);
  const glm::dvec3 extent = bounds.highest - bounds.lowest;
  return std::max({extent.x, extent.y, extent.z}) / compliance_elements(bounds);
}

/// The mean logarithm of the distance between the ports at which a force on the contact acts and
/// those whose displacements make the contact's own.
double mean_reach(const Model& model, std::uint32_t body, const SupportFit& support_fit) {
  const auto ports = model.ports.rows<CompliancePort>(model.bodies.at<OwnedRows>(body).ports);
  const double nearest = kElementsSee * port_spacing(model, body);
  const double least = nearest * nearest * nearest * nearest;
  const auto share = [&support_fit](std::size_t port) {
    return glm::dot(support_fit.unit_forces[0][port], glm::dvec3(1.0, 0.0, 0.0));
  };
  double sum = 0.0;
  for (std::size_t i = 0; i < support_fit.count; ++i) {
    sum += share(i) * share(i) * std::log(nearest);
    for (std::size_t j = 0; j < i; ++j) {
      const glm::dvec3 way =
          ports[support_fit.ports[i]].position - ports[support_fit.ports[j]].position;
      const double square = glm::dot(way, way);
      sum += share(i) * share(j) * 0.5 * std::log(square * square + least);
    }
  }
  return std::exp(sum);
}

}  // namespace

SurfaceBend find_surface_bend(const Model& model, std::uint32_t body, const SupportFit& support_fit,
                              const RegionFrame& axes, double across) {
  SurfaceBend bend;
  const double reach = mean_reach(model, body, support_fit);
  const double span = std::max(kSpan * reach, across);
  const Range parts = model.bodies.at<OwnedRows>(body).parts;
  const auto slope = [&](const glm::dvec3& direction) {
    const glm::dvec3 before = glm::normalize(
        signed_distance(model, parts, support_fit.center - span * direction).gradient);
    const glm::dvec3 after = glm::normalize(
        signed_distance(model, parts, support_fit.center + span * direction).gradient);
    const bool gentle =
        std::min(glm::dot(before, axes.normal), glm::dot(after, axes.normal)) > kEdge;
    const glm::dvec3 change = (after - before) / (2.0 * span);
    return gentle
               ? glm::dvec3(glm::dot(change, axes.tangent_x), glm::dot(change, axes.tangent_y), 1.0)
               : glm::dvec3(0.0);
  };
  const glm::dvec3 by_x = slope(axes.tangent_x);
  const glm::dvec3 by_y = slope(axes.tangent_y);
  const SurfaceCurvature curvature{by_x.x, 0.5 * (by_x.y + by_y.x), by_y.y};
  const double most =
      std::max({std::abs(curvature.xx), std::abs(curvature.xy), std::abs(curvature.yy)});
  if (by_x.z * by_y.z > 0.0 && most * reach > kFlat) {
    bend = {curvature, reach};
  }
  return bend;
}

bool may_bend(const Model& model, std::uint32_t body) {
  const auto parts = model.parts.rows<ShapePart>(model.bodies.at<OwnedRows>(body).parts);
  return std::ranges::any_of(parts,
                             [](const ShapePart& part) { return part.kind != ShapeKind::kBox; });
}

}  // namespace torsion::engine
