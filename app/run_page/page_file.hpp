#pragma once

#include <cstdint>
#include <filesystem>

#include "app/deformed_scene.hpp"
#include "app/output_file.hpp"
#include "ecs/result.hpp"

namespace torsion::engine {

/// The page of a run (run_page.hpp) that is made while it runs: ten moments a second, more of a
/// short run and fewer of a long one.
class PageFile {
 public:
  /// Opens the file before the run, so that a place that cannot be written is known at once.
  /// Error: it cannot; the run has no step.
  static Result<PageFile> create(const std::filesystem::path& path, const Session& session,
                                 std::uint64_t steps);

  /// Looks at the session after the step of this number; keeps it where it begins an interval.
  void watch(const Session& session, std::uint64_t step);

  /// Writes the file. @pre one step was looked at
  Result<Done> finish(const Session& session);

 private:
  PageFile(OutputFile file, const Session& session, std::uint64_t steps);

  OutputFile file_;
  DeformedRun shapes_;
  double dt_;        // s, of a step
  double interval_;  // s, between two moments that are kept
};

}  // namespace torsion::engine
