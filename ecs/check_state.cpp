#include "ecs/check_state.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace torsion::engine {
namespace {

// Collects the first thing that is wrong; further calls change nothing.
struct Findings {
  std::string first;

  void require(bool holds, std::string_view table, std::uint32_t row, std::string_view what) {
    if (!holds && first.empty()) {
      first.append(table).append(" row ").append(std::to_string(row)).append(": ").append(what);
    }
  }
};

bool inside(Range range, std::uint32_t size) {
  return range.first <= size && range.count <= size - range.first;
}

void check_sizes(const Model& model, const State& state, Findings& findings) {
  findings.require(state.bodies.size() == model.bodies.size(), "bodies", 0,
                   "there must be as many as the scene has");
  findings.require(state.tools.size() == model.tools.size(), "tools", 0,
                   "there must be as many as the scene has");
  findings.require(state.tools_over_bodies.size() == state.tools.size() * state.bodies.size(),
                   "tools_over_bodies", 0, "there must be one for each tool and body");
  const std::uint64_t side = model.settings.grid_side;
  const std::uint64_t regions = state.regions.capacity();
  findings.require(state.cells.size() == regions * side * side, "cells", 0,
                   "there must be one grid for each region");
  findings.require(state.patch_cells.empty() || state.patch_cells.size() == state.cells.size(),
                   "patch_cells", 0, "there must be as many as cells, or none");
  findings.require(state.mdr_layers.empty() || state.mdr_layers.size() == regions * kMdrLayers,
                   "mdr_layers", 0, "there must be a row for each layer of each region, or none");
  const std::uint64_t tables = 16 * side * (2 * side - 1);  // kInfluenceKinds tables of one grid
  findings.require(
      state.layer_influences.empty() || state.layer_influences.size() == regions * tables,
      "layer_influences", 0, "there must be one grid's for each region, or none");
  const std::uint64_t support_fits = state.support_fits.size();
  findings.require(support_fits == 0 || support_fits == regions, "support_fits", 0,
                   "there must be one for each region, or none");
  findings.require(
      state.couplings.size() == (support_fits == 0 ? 0 : support_fits * (support_fits - 1) / 2),
      "couplings", 0, "there must be one for each two regions, or none");
}

/// Of a region that is otherwise sound.
void check_support_fit(const Model& model, const State& state, const RegionIdentity& region,
                       std::uint32_t row, Findings& findings) {
  const std::uint32_t block = region.cells.first / std::max(region.cells.count, 1U);
  if (block >= state.support_fits.size()) {
    findings.require(false, "regions", row, "its support fit is not there");
    return;
  }
  const SupportFit& support_fit = state.support_fits.at<SupportFit>(block);
  const std::uint32_t ports = model.bodies.at<OwnedRows>(region.body).ports.count;
  const bool few = support_fit.count <= kSupportPorts;
  findings.require(
      few && std::all_of(support_fit.ports.begin(), support_fit.ports.begin() + support_fit.count,
                         [ports](std::uint32_t port) { return port < ports; }),
      "support_fits", block, "the ports that it stands on are not there");
}

void check_regions(const Model& model, const State& state, Findings& findings) {
  const std::uint32_t count = model.settings.grid_side * model.settings.grid_side;
  for (std::uint32_t row = 0; row < state.regions.size(); ++row) {
    const auto& region = state.regions.at<RegionIdentity>(row);
    findings.require(region.body < model.bodies.size(), "regions", row, "its body is not there");
    findings.require(region.tool < model.tools.size(), "regions", row, "its tool is not there");
    findings.require(inside(region.cells, state.cells.size()) && region.cells.count == count &&
                         region.cells.first % count == 0,
                     "regions", row, "its cells are not there");
    if (findings.first.empty() && !state.support_fits.empty()) {
      check_support_fit(model, state, region, row, findings);
    }
  }
}

}  // namespace

Result<Done> check_state(const Model& model, const State& state) {
  Findings findings;
  check_sizes(model, state, findings);
  if (findings.first.empty()) {
    check_regions(model, state, findings);
  }
  if (!findings.first.empty()) {
    return Error{findings.first};
  }
  return Done{};
}

}  // namespace torsion::engine
