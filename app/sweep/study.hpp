#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/scene_variants.hpp"
#include "app/sweep/wanted_columns.hpp"
#include "ecs/result.hpp"

namespace torsion::engine {

/// One --set of a sweep: a node's key and the values that it takes.
struct Axis {
  std::string name;                 // NODE.KEY
  std::vector<std::string> values;  // as they are set; at least one
};

inline constexpr std::uint64_t kMostRuns = 10'000'000;

/// "NODE.KEY=VALUES", where VALUES are values with commas between, FIRST:LAST:COUNT at equal
/// distances, or FIRST:LAST:COUNTlog at equal ratios. The error says what was expected.
Result<Axis> read_axis(const std::string& setting);

/// A scene with values over what it says, once for every combination of them.
struct Study {
  std::unique_ptr<const SceneVariants> variants;
  double seconds = 0.0;              // s, of each run
  std::vector<Axis> axes;            // the last one changes fastest
  std::vector<WantedColumn> wanted;  // of each run besides

  [[nodiscard]] std::uint64_t runs() const;
  /// The settings of a run, NODE.KEY=VALUE.
  [[nodiscard]] std::vector<std::string> settings_of(std::uint64_t run) const;
  /// The first line of the table: a column an axis, then what a run comes to.
  [[nodiscard]] std::string header() const;
};

/// Runs one combination, in one thread. The same study gives the same line, whatever else runs.
/// @return its line of the table, without an end of line; fails where it cannot be prepared
Result<std::string> run_one(const Study& study, std::uint64_t run);

}  // namespace torsion::engine
