#pragma once

// How smooth a run's forces are.

#include <algorithm>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace torsion::engine::test {

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return values.empty() ? 0.0 : *middle;
}

/// Over the steps in which there is a force.
inline double median_length(const std::vector<glm::dvec3>& vectors) {
  std::vector<double> lengths;
  for (const glm::dvec3& vector : vectors) {
    if (vector != glm::dvec3(0.0)) {
      lengths.push_back(glm::length(vector));
    }
  }
  return median(lengths);
}

/// The step that is farthest from the median of its ten neighbours, component by component.
struct Standout {
  std::size_t step = 0;
  double size = 0.0;  // N, or as the vectors
};

/// @param free  share of the neighbours' median that does not count
inline Standout largest_standout(const std::vector<glm::dvec3>& vectors, double free = 0.0) {
  constexpr std::size_t kBeside = 5;
  Standout largest;
  for (std::size_t step = kBeside; step + kBeside < vectors.size(); ++step) {
    glm::dvec3 middle(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> neighbours;
      for (std::size_t k = step - kBeside; k <= step + kBeside; ++k) {
        if (k != step) {
          neighbours.push_back(vectors[k][axis]);
        }
      }
      middle[axis] = median(neighbours);
    }
    const double size = glm::length(vectors[step] - middle) - free * glm::length(middle);
    largest = size > largest.size ? Standout{step, size} : largest;
  }
  return largest;
}

}  // namespace torsion::engine::test
