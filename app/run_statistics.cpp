#include "app/run_statistics.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace torsion {
namespace {

constexpr double kFirstBin = 0.125;  // us
constexpr double kBinsPerDoubling = 2.0;

double lower_edge(std::size_t bin) {
  return bin == 0 ? 0.0 : kFirstBin * std::exp2(static_cast<double>(bin) / kBinsPerDoubling);
}

}  // namespace

void TimeHistogram::add(double microseconds) {
  const double position =
      kBinsPerDoubling * std::log2(std::max(microseconds, kFirstBin) / kFirstBin);
  bins_[std::min(static_cast<std::size_t>(position), kBins - 1)] += 1;
  count_ += 1;
  largest_ = std::max(largest_, microseconds);
}

double TimeHistogram::quantile(double share) const {
  const double wanted = share * static_cast<double>(count_);
  double before = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const auto here = static_cast<double>(bins_[bin]);
    if (here > 0.0 && before + here >= wanted) {
      const double low = lower_edge(bin);
      return std::min(largest_, low + (lower_edge(bin + 1) - low) * (wanted - before) / here);
    }
    before += here;
  }
  return largest_;
}

std::vector<TimeHistogram::Bin> TimeHistogram::bins() const {
  std::vector<Bin> all;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    if (bins_[bin] != 0) {
      all.push_back({lower_edge(bin), lower_edge(bin + 1), bins_[bin]});
    }
  }
  return all;
}

std::string TimeHistogram::text() const {
  std::string text;
  for (const Bin& bin : bins()) {
    text +=
        fmt::format("  {:10.1f} to {:10.1f} us  {:8d}  {:7.3f} %\n", bin.from, bin.to, bin.count,
                    100.0 * static_cast<double>(bin.count) / static_cast<double>(count_));
  }
  return text;
}

void RunStatistics::add_step(const World& world, double step_us) {
  steps += 1;
  contact_steps += world.regions.size() > 0 ? 1U : 0U;
  step_times.add(step_us);
  most_regions = std::max(most_regions, world.regions.size());
  for (const ToolWrench& wrench : world.tools.column<ToolWrench>()) {
    peak_force = std::max(peak_force, glm::length(wrench.total.force));
    peak_torque = std::max(peak_torque, glm::length(wrench.total.torque));
  }
}

}  // namespace torsion
