#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/fit/measured_table.hpp"
#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// Which column of a file is meant by a name of ours, and by what its numbers are multiplied.
struct ColumnSource {
  std::string name;    // as in a trace (docs/guide.md)
  std::string column;  // of the file
  double factor = 1.0;
};

/// "NAME=COLUMN" or "NAME=COLUMN*FACTOR", as force_y_N=Fy*-1e-3. The error says what was expected.
Result<ColumnSource> read_column_source(const std::string& text);

/// Where a tool was at the measurement's times. What was not measured, its animation says.
struct MeasuredMotion {
  std::vector<glm::dvec3> positions;  // m; empty: not measured
  std::vector<glm::dquat> rotations;  // unit; empty: not measured
};

/// One measured component of a wrench on a tool, in the world's axes.
struct MeasuredQuantity {
  std::string name;             // as in a trace
  std::uint32_t tool = 0;       // row
  std::uint32_t component = 0;  // 0 to 2: force, N; 3 to 5: torque, N m
  std::vector<double> values;

  [[nodiscard]] bool is_torque() const { return component >= 3; }
};

/// Motions and wrenches of a scene's tools, over time.
struct Measurement {
  std::vector<double> times;            // s, rising
  std::vector<MeasuredMotion> motions;  // (tools)
  std::vector<MeasuredQuantity> quantities;
  // m, tool frame: what measured torques are about; none: the mass centre, as in a trace.
  std::optional<glm::dvec3> torque_about;

  /// The number of all measured values.
  [[nodiscard]] std::size_t size() const { return quantities.size() * times.size(); }
};

inline constexpr std::size_t kFewestRows = 10;

/// Takes from a table what it has of a trace's columns. Fails where there are no times, no forces
/// and no torques, a position or rotation in part, or numbers that cannot be.
/// @param sources  names that the file has others for
Result<Measurement> read_measurement(const MeasuredTable& table, const SceneDescription& scene,
                                     std::span<const ColumnSource> sources);

/// The tool's pose at `time` [s]: measured, linear between the rows, or as its animation has it.
Pose measured_pose(const Measurement& measurement, const SceneDescription& scene,
                   std::uint32_t tool, double time);

}  // namespace torsion::engine
