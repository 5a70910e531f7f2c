#include "app/run_page/page_file.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/run_page/run_page.hpp"

namespace torsion::engine {
namespace {

/// s: between two moments of a run of this length.
double interval_of(double seconds) {
  constexpr double kUsual = 0.1;    // s
  constexpr double kFewest = 40.0;  // moments
  constexpr double kMost = 100.0;
  return std::max(std::min(kUsual, seconds / kFewest), seconds / kMost);
}

}  // namespace

PageFile::PageFile(OutputFile file, const Session& session, std::uint64_t steps)
    : file_(std::move(file)),
      shapes_(session),
      dt_(session.simulation.world.model.dt),
      interval_(std::max(dt_, interval_of(dt_ * static_cast<double>(steps)))) {}

Result<PageFile> PageFile::create(const std::filesystem::path& path, const Session& session,
                                  std::uint64_t steps) {
  if (steps == 0) {
    return Error{"--html " + path.string() + ": a run without a step has nothing to show"};
  }
  Result<OutputFile> file = OutputFile::create(path);
  if (!file) {
    return file.error();
  }
  return PageFile(std::move(file).value(), session, steps);
}

void PageFile::watch(const Session& session, std::uint64_t step) {
  const auto interval_at = [this](std::uint64_t of) {
    // Half a step, so that no rounding decides.
    return std::floor((static_cast<double>(of) + 0.5) * dt_ / interval_);
  };
  if (step == 0 || interval_at(step) > interval_at(step - 1)) {
    shapes_.add(session, dt_ * static_cast<double>(step));
  }
}

Result<Done> PageFile::finish(const Session& session) {
  file_.write(run_page(session, shapes_));
  return file_.commit();
}

}  // namespace torsion::engine
