#include "app/run_statistics.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "systems/contact/strain.hpp"

namespace torsion::engine {
namespace {

constexpr double kBinsPerDoubling = 2.0;

}  // namespace

double Histogram::lower_edge(std::size_t bin) const {
  return bin == 0 ? 0.0 : first_ * std::exp2(static_cast<double>(bin) / kBinsPerDoubling);
}

void Histogram::add(double value) {
  constexpr auto kLast = static_cast<double>(kBins - 1);
  // In this order what is no number is in the first bin.
  const double position = kBinsPerDoubling * std::log2(std::max(first_, value) / first_);
  bins_[static_cast<std::size_t>(std::min(position, kLast))] += 1;
  count_ += 1;
  largest_ = std::max(largest_, value);
}

double Histogram::quantile(double share) const {
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

std::vector<Histogram::Bin> Histogram::bins() const {
  std::vector<Bin> all;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    if (bins_[bin] != 0) {
      all.push_back({lower_edge(bin), lower_edge(bin + 1), bins_[bin]});
    }
  }
  return all;
}

std::string Histogram::text() const {
  std::string text;
  for (const Bin& bin : bins()) {
    text +=
        fmt::format("  {:10.1f} to {:10.1f} us  {:8d}  {:7.3f} %\n", bin.from, bin.to, bin.count,
                    100.0 * static_cast<double>(bin.count) / static_cast<double>(count_));
  }
  return text;
}

void PatchStatistics::add(const PatchState& state) {
  residuals.add(state.residual);
  iterations += state.iterations;
  most_iterations = std::max(most_iterations, state.iterations);
}

double PatchStatistics::mean_iterations() const {
  return static_cast<double>(iterations) / static_cast<double>(region_steps());
}

void StrainStatistics::add(const World& world, std::uint32_t region) {
  const double traction = traction_over_modulus(world.model, world.state, region);
  const double tilt = support_tilt(world.state, region);
  region_steps += 1;
  large += traction > kLargeTraction || tilt > kLargeTilt ? 1U : 0U;
  most_traction = std::max(most_traction, traction);
  most_tilt = std::max(most_tilt, tilt);
}

double StrainStatistics::large_share() const {
  return static_cast<double>(large) / static_cast<double>(region_steps);
}

void RunStatistics::add_step(const World& world, double step_us) {
  steps += 1;
  contact_steps += world.state.regions.size() > 0 ? 1U : 0U;
  step_times.add(step_us);
  most_regions = std::max(most_regions, world.state.regions.size());
  for (const ToolWrench& wrench : world.state.tools.column<ToolWrench>()) {
    peak_force = std::max(peak_force, glm::length(wrench.total.force));
    peak_torque = std::max(peak_torque, glm::length(wrench.total.torque));
  }
  for (std::uint32_t region = 0; region < world.state.regions.size(); ++region) {
    const std::uint32_t body = world.state.regions.at<RegionIdentity>(region).body;
    strain.add(world, region);
    if (world.model.bodies.at<BodyModels>(body).contact == ContactModel::kPatch) {
      patch.add(world.state.regions.at<PatchState>(region));
    }
  }
}

}  // namespace torsion::engine
