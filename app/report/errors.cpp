#include "app/report/errors.hpp"

#include <algorithm>
#include <cmath>

namespace torsion::engine {
namespace {

/// The largest difference over the largest reference; a value that is no number is infinitely
/// wrong.
std::optional<double> largest_difference(const std::vector<PathPoint>& path,
                                         double PathPoint::*reference,
                                         const std::vector<double>& values) {
  double largest = 0.0;
  double scale = 0.0;
  bool compared = false;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double wanted = path[i].*reference;
    if (std::isnan(wanted)) {
      continue;
    }
    compared = true;
    const double difference = std::abs(values[i] - wanted);
    largest = std::isfinite(difference) ? std::max(largest, difference)
                                        : std::numeric_limits<double>::infinity();
    scale = std::max(scale, std::abs(wanted));
  }
  return compared && scale > 0.0 ? std::optional(largest / scale) : std::nullopt;
}

}  // namespace

CaseErrors errors_of(const ReferenceCase& reference_case, const CaseRun& run) {
  CaseErrors errors;
  errors.force = largest_difference(reference_case.path, &PathPoint::force, run.forces);
  errors.torque = largest_difference(reference_case.path, &PathPoint::torque, run.torques);
  const ReferenceField& field = reference_case.field;
  if (!field.radii.empty()) {
    double sum = 0.0;
    double whole = 0.0;
    for (std::size_t i = 0; i < field.radii.size(); ++i) {
      const double difference = run.twists[i] - field.twists[i];
      sum += difference * difference * field.radii[i];  // as much surface as lies there
      whole += field.twists[i] * field.twists[i] * field.radii[i];
    }
    errors.twist = std::sqrt(sum / whole);
  }
  return errors;
}

}  // namespace torsion::engine
