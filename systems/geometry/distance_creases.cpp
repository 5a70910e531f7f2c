#include "systems/geometry/distance_creases.hpp"

#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace torsion::engine {
namespace {

constexpr unsigned kCorners = 8;

// Cosine of 30 degrees, from which on modellers call an edge sharp: the facets of a round thing of
// more than 12 sides are smooth.
constexpr double kSharpEdge = 0.866;

// Cosine of 15 degrees: a cell whose corners differ by less holds no sharp edge, or next to nothing
// of one.
constexpr float kFlatEnough = 0.966F;

// Of the cell: where contacts do not ask any more, and where no corner of a cell with some of the
// surface can be.
constexpr double kAbove = 0.1;
constexpr double kFarthestPlane = 0.7;
constexpr std::size_t kMostPlanes = 8;
constexpr double kOnFaces = 1e-4;  // of the cell: the planes are those of the faces

/// What a sample counts. Contacts ask at the surface and below it; outside of a convex edge, where
/// the distance is that to the edge itself, planes are only near it.
double weight_of(const Distance& exact, double spacing) {
  return exact.value <= kAbove * spacing ? 1.0 : 0.05;
}

glm::vec3 offset_of(std::size_t sample, double spacing) {
  const auto [x, y, z] = crease_sample(sample);
  return {spacing * x, spacing * y, spacing * z};
}

/// The surface's tangent plane at the place nearest to a sample.
DistanceNode plane_at(const Distance& exact, const glm::vec3& offset) {
  const glm::vec3 normal(exact.gradient);
  return {glm::vec4(normal, static_cast<float>(exact.value) - glm::dot(normal, offset))};
}

double error_at(std::span<const DistanceNode> planes, const glm::vec3& offset, bool concave,
                const Distance& exact) {
  return std::abs(static_cast<double>(distance_at_crease(planes, offset, concave).w) - exact.value);
}

bool has_sharp_edge(const std::array<Distance, kCreaseSamples>& exact) {
  for (std::size_t i = 0; i < kCreaseSamples; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (glm::dot(exact[i].gradient, exact[j].gradient) < kSharpEdge) {
        return true;
      }
    }
  }
  return false;
}

/// Planes of one kind: that at the worst sample, as long as there are samples that they miss.
std::vector<DistanceNode> choose_planes(double spacing,
                                        const std::array<Distance, kCreaseSamples>& exact,
                                        bool concave) {
  std::vector<DistanceNode> planes{plane_at(exact[0], offset_of(0, spacing))};
  while (planes.size() < kMostPlanes) {
    std::size_t worst = 0;
    double most = 0.0;
    for (std::size_t sample = 0; sample < kCreaseSamples; ++sample) {
      const double error = weight_of(exact[sample], spacing) *
                           error_at(planes, offset_of(sample, spacing), concave, exact[sample]);
      if (error > most) {
        worst = sample;
        most = error;
      }
    }
    if (most <= kOnFaces * spacing) {
      break;
    }
    planes.push_back(plane_at(exact[worst], offset_of(worst, spacing)));
  }
  return planes;
}

}  // namespace

glm::vec4 distance_at_crease(std::span<const DistanceNode> planes, const glm::vec3& offset,
                             bool concave) {
  glm::vec4 found(0.0F);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const glm::vec4& plane = planes[i].gradient_and_distance;
    const float distance = plane.w + glm::dot(glm::vec3(plane), offset);
    if (i == 0 || (concave ? distance < found.w : distance > found.w)) {
      found = glm::vec4(glm::vec3(plane), distance);
    }
  }
  return found;
}

bool may_have_crease(const CellNodes& nodes, double spacing) {
  const auto above = static_cast<float>(kFarthestPlane * spacing);
  bool near = false;
  for (unsigned i = 0; i < kCorners; ++i) {
    near = near || nodes.at(i).w <= above;
  }
  if (!near) {
    return false;
  }
  for (unsigned i = 0; i < kCorners; ++i) {
    for (unsigned j = 0; j < i; ++j) {
      if (glm::dot(glm::vec3(nodes.at(i)), glm::vec3(nodes.at(j))) < kFlatEnough) {
        return true;
      }
    }
  }
  return false;
}

std::array<double, 3> crease_sample(std::size_t sample) {
  const auto along = [&](unsigned axis) {
    return static_cast<double>(sample >> 2 * axis & 3U) / 3.0;
  };
  return {along(0), along(1), along(2)};
}

CreaseFit fit_crease(const CellNodes& nodes, double spacing,
                     const std::array<Distance, kCreaseSamples>& exact) {
  const auto sum_of_squares = [&](const auto& error) {
    double sum = 0.0;
    for (std::size_t sample = 0; sample < kCreaseSamples; ++sample) {
      sum += weight_of(exact[sample], spacing) * error(sample) * error(sample);
    }
    return sum;
  };
  CreaseFit best;
  if (!has_sharp_edge(exact)) {
    return best;
  }
  double least = sum_of_squares([&](std::size_t sample) {
    const auto found =
        static_cast<double>(distance_in_cell(nodes, crease_sample(sample), spacing).w);
    return found - exact[sample].value;
  });
  for (const bool concave : {false, true}) {
    std::vector<DistanceNode> planes = choose_planes(spacing, exact, concave);
    const double sum = sum_of_squares([&](std::size_t sample) {
      return error_at(planes, offset_of(sample, spacing), concave, exact[sample]);
    });
    if (sum < least) {
      least = sum;
      best = {std::move(planes), concave};
    }
  }
  return best;
}

}  // namespace torsion::engine
