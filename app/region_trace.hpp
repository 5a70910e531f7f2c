#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/table_file.hpp"
#include "ecs/scene_description.hpp"
#include "ecs/world.hpp"

namespace torsion::engine {

/// Writes one row for each region in each step (docs/guide.md has the columns).
class RegionTrace {
 public:
  static Result<RegionTrace> create(const std::filesystem::path& path);
  void append(const World& world);
  Result<Done> finish() { return file_.finish(); }

 private:
  explicit RegionTrace(TableFile file) : file_(std::move(file)) {}
  TableFile file_;
};

}  // namespace torsion::engine
