#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "app/live/live_loop.hpp"

namespace torsion::engine {

/// A row of a session, thinned for plots.
struct PlotPoint {
  double time = 0.0;            // s
  Wrench world;                 // on the tool
  Wrench contact;               // the same along the oldest region's tangents (x, y) and normal (z)
  double turn = 0.0;            // rad: of the tool
  double couple = 0.0;          // N m: of the oldest region
  double radius = 0.0;          // m: of its contact
  std::uint64_t region = 0;     // which that is: LiveRow::contact
  double normal_force = 0.0;    // N: summed over the tool's regions
  double friction_force = 0.0;  // N: the size of their sum
  double arm_torque = 0.0;      // N m: the size of r x F about the mass centre
  double couples = 0.0;         // N m: the size of the sum of the contact couples
  double step_us = 0.0;         // the longest of the rows that the point stands for
  double late_us = 0.0;         // likewise
  double device_hz = 0.0;       // of a device that holds the tool
  std::uint64_t generation = 0;
};

/// The last seconds of one tool. Fixed memory; the oldest goes first.
class History {
 public:
  static constexpr std::size_t kPoints = 4096;
  static constexpr double kPeriod = 4e-3;  // s: between points

  /// @param device_hz  the rate of the device that holds the tool; 0: none does
  void add(const LiveRow& row, double device_hz = 0.0);
  void clear();

  [[nodiscard]] std::size_t size() const { return size_; }
  /// @param i  0: the oldest
  [[nodiscard]] const PlotPoint& operator[](std::size_t i) const {
    return points_[(first_ + i) % kPoints];
  }

 private:
  std::vector<PlotPoint> points_ = std::vector<PlotPoint>(kPoints);
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  double longest_step_ = 0.0;
  double latest_ = 0.0;
};

/// A wrench in the axes of a contact: tangents and normal. World axes where there is none.
Wrench in_contact_axes(const Wrench& world, const glm::dvec3& normal, const glm::dvec3& tangent_x);

}  // namespace torsion::engine
