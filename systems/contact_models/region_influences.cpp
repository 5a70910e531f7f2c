#include "systems/contact_models/region_influences.hpp"

#include <cmath>

#include "systems/contact_models/layer_influence.hpp"
#include "systems/contact_models/layer_kernel.hpp"
#include "systems/contact_models/layer_thickness.hpp"
#include "systems/patch_grid.hpp"

namespace torsion {
namespace {

constexpr double kThicker = 0.01;  // relative: less is not worth new tables

bool serves(const LayerGrid& filled, double thickness, const glm::dvec2& half_size) {
  return filled.half_size == half_size &&
         std::abs(thickness - filled.thickness) < kThicker * filled.thickness;
}

}  // namespace

RegionInfluences region_influences(World& world, std::uint32_t region) {
  static_assert(sizeof(Influence) == sizeof(double));
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  const double poisson_ratio = world.bodies.at<Elasticity>(identity.body).poisson_ratio;
  const std::uint32_t side = world.settings.at<Settings>(0).grid_side;
  const auto rows =
      world.influences.rows<Influence>(world.bodies.at<OwnedRows>(identity.body).influences);
  const std::span<const double> values(&rows.front().value, rows.size());
  const std::size_t count = influence_count(side);
  RegionInfluences result;
  result.tables = influence_tables(values.first(count), side, patch_aspect(frame.half_size));
  result.coupled = poisson_ratio < 0.5;
  const double thickness = values.size() > count
                               ? layer_thickness(world, identity.body, frame.normal, frame.origin)
                               : 0.0;
  LayerGrid& filled = world.regions.at<LayerGrid>(region);
  if (thickness <= 0.0) {
    result.changed = filled.thickness > 0.0;
    filled = LayerGrid{};
    return result;
  }
  const auto own_count = static_cast<std::uint32_t>(layer_influence_count(side));
  const std::uint32_t block = block_of(identity);
  const auto own_rows = world.layer_influences.rows<Influence>({block * own_count, own_count});
  const std::span<double> own(&own_rows.front().value, own_rows.size());
  if (!serves(filled, thickness, frame.half_size)) {
    const glm::dvec2 cell = 2.0 * frame.half_size / (static_cast<double>(side) * thickness);
    fill_layer_influences(result.tables, values.subspan(count), poisson_ratio, cell, own);
    filled = {thickness, frame.half_size};
    result.changed = true;
  }
  result.tables = layer_influence_tables(own, side);
  result.coupled = true;
  return result;
}

}  // namespace torsion
