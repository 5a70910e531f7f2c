#include "ecs/state.hpp"

namespace torsion::engine {
namespace {

template <class AnyTable>
void fill_with_zeros(AnyTable& table, std::uint32_t rows) {
  table.reserve(rows);
  table.assign_zeros(rows);
}

}  // namespace

void State::reserve(const Capacities& capacities, const Settings& settings) {
  const std::uint32_t cells_of_all = capacities.regions * settings.grid_side * settings.grid_side;
  const std::uint32_t footed = capacities.ports > 0 ? capacities.regions : 0;
  clock = Clock{};
  fill_with_zeros(bodies, capacities.bodies);
  fill_with_zeros(tools, capacities.tools);
  fill_with_zeros(tools_over_bodies, capacities.tools * capacities.bodies);
  regions.reserve(capacities.regions);
  fill_with_zeros(cells, cells_of_all);
  fill_with_zeros(patch_cells, capacities.patch_bodies > 0 ? cells_of_all : 0);
  fill_with_zeros(mdr_layers, capacities.mdr_bodies > 0 ? capacities.regions * kMdrLayers : 0);
  fill_with_zeros(layer_influences, capacities.regions * capacities.layer_influences);
  fill_with_zeros(support_fits, footed);
  fill_with_zeros(couplings, footed > 0 ? footed * (footed - 1) / 2 : 0);
  for (std::uint32_t row = 0; row < bodies.size(); ++row) {
    bodies.at<BodyPose>(row) = BodyPose{};
  }
  for (std::uint32_t row = 0; row < tools.size(); ++row) {
    tools.at<ToolPose>(row) = ToolPose{};
    tools.at<ToolMotion>(row) = ToolMotion{};
    tools.at<ToolWrench>(row) = ToolWrench{};
  }
}

}  // namespace torsion::engine
