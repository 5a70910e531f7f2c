#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/contact/support/support_fit.hpp"
#include "systems/half_space/curved_influence.hpp"
#include "systems/half_space/layer.hpp"
#include "systems/patch/grid.hpp"
#include "systems/patch/region.hpp"

namespace torsion::engine {
namespace {

constexpr double kThicker = 0.01;    // relative: less is not worth new tables
constexpr double kBent = 0.1;        // likewise, of what the curvature adds
constexpr double kSameAxes = 0.999;  // cosine: a grid that has turned by 2.6 degrees has others

bool is_layer_like(const LayerGrid& filled, double thickness, const glm::dvec2& half_size) {
  return filled.half_size == half_size &&
         std::abs(thickness - filled.thickness) < kThicker * filled.thickness;
}

/// Whether tables are nearly those of the bend, compared at their ends, where the bend is largest
/// beside the half-space's values.
bool are_bent_like(const InfluenceTables& tables, const InfluenceTables& half_space,
                   const SurfaceBend& bend, double poisson_ratio, const glm::dvec2& cell) {
  const CurvedResponse response = curved_response(bend.curvature, poisson_ratio);
  const std::uint32_t end = tables.side - 1;
  double most = 0.0;
  double change = 0.0;
  for (const glm::uvec2& place : {glm::uvec2(end, 0), glm::uvec2(0, end), glm::uvec2(end, end)}) {
    const std::size_t at = tables.index(0, 0, place.x, place.y);
    for (std::size_t kind = 0; kind < kCurvedKinds; ++kind) {
      const double is = curved_displacement(response[kind], cell * glm::dvec2(place), bend.reach) *
                        cell.y / (8.0 * std::numbers::pi);
      const double was = tables.kinds[kind][at] - half_space.kinds[kind][at];
      most = std::max(most, std::abs(is));
      change = std::max(change, std::abs(is - was));
    }
  }
  return change <= kBent * most;
}

/// The tables that one region works with.
struct RegionTables {
  const Model& model;
  State& state;
  std::uint32_t region;
  RegionInfluences& result;        // the half-space's to begin with
  std::span<const double> kernel;  // of a layer, if the body is one
  LayerGrid& filled;

  [[nodiscard]] std::span<double> own() const {
    const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
    const auto count = static_cast<std::uint32_t>(layer_influence_count(result.tables.side));
    const auto rows = state.layer_influences.rows<Influence>({block_of(identity) * count, count});
    return {&rows.front().value, rows.size()};
  }
  [[nodiscard]] glm::dvec2 cell() const {
    return 2.0 * state.regions.at<RegionFrame>(region).half_size /
           static_cast<double>(result.tables.side);
  }
};

void take_layer(const RegionTables& at, double thickness, double poisson_ratio) {
  const glm::dvec2& half_size = at.state.regions.at<RegionFrame>(at.region).half_size;
  if (!is_layer_like(at.filled, thickness, half_size)) {
    fill_layer_influences(at.result.tables, at.kernel, poisson_ratio, at.cell() / thickness,
                          at.own());
    at.filled = {thickness, half_size, {}};
    at.result.changed = true;
  }
  at.result.tables = layer_influence_tables(at.own(), at.result.tables.side);
  at.result.coupled = true;
}

/// For a body with body model compliance, whose ports determine how far the curvature reaches. They
/// apply from the second step of the region, when it has a support fit.
void take_bend(const RegionTables& at, double poisson_ratio) {
  const RegionFrame& frame = at.state.regions.at<RegionFrame>(at.region);
  const RegionIdentity& identity = at.state.regions.at<RegionIdentity>(at.region);
  const SupportFit& support_fit = at.state.support_fits.at<SupportFit>(block_of(identity));
  const bool was_bent = at.filled.thickness == 0.0 && at.filled.half_size.x > 0.0;
  const bool same_grid = at.filled.half_size == frame.half_size &&
                         glm::dot(at.filled.tangent_x, frame.tangent_x) > kSameAxes;
  const bool laid =
      at.state.support_fits.at<SupportResponse>(block_of(identity)).serial != support_fit.serial;
  const InfluenceTables own = layer_influence_tables(at.own(), at.result.tables.side);
  if (laid || (was_bent && !same_grid)) {
    const SurfaceBend bend = find_surface_bend(at.model, identity.body, support_fit, frame,
                                               std::max(frame.half_size.x, frame.half_size.y));
    if (bend.reach == 0.0) {
      at.result.changed = was_bent;
      at.filled = LayerGrid{};
      return;
    }
    if (!same_grid || !was_bent ||
        !are_bent_like(own, at.result.tables, bend, poisson_ratio, at.cell())) {
      fill_curved_influences(at.result.tables, curved_response(bend.curvature, poisson_ratio),
                             at.cell(), bend.reach, at.own());
      at.filled = {0.0, frame.half_size, frame.tangent_x};
      at.result.changed = true;
    }
  }
  if (at.filled.half_size.x > 0.0) {
    at.result.tables = own;
  }
}

}  // namespace

RegionInfluences region_influences(const Model& model, State& state, std::uint32_t region) {
  static_assert(sizeof(Influence) == sizeof(double));
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const double poisson_ratio = model.bodies.at<Elasticity>(identity.body).poisson_ratio;
  const std::uint32_t side = model.settings.grid_side;
  const auto rows =
      model.influences.rows<Influence>(model.bodies.at<OwnedRows>(identity.body).influences);
  const std::span<const double> values(&rows.front().value, rows.size());
  RegionInfluences result;
  result.tables = influence_tables(values, side, table_aspect(frame.half_size));
  result.coupled = poisson_ratio < 0.5;
  const std::span<const double> kernel = layer_kernel(model, identity.body);
  const double thickness =
      !kernel.empty() ? layer_thickness(model, identity.body, frame.normal, frame.origin) : 0.0;
  const RegionTables at{model, state, region, result, kernel, state.regions.at<LayerGrid>(region)};
  const std::uint32_t block = block_of(identity);
  const SupportFit* const support_fit =
      state.support_fits.empty() ? nullptr : &state.support_fits.at<SupportFit>(block);
  if (thickness > 0.0) {
    take_layer(at, thickness, poisson_ratio);
  } else if (support_fit != nullptr && support_fit->reach > 0.0 && support_fit->on_layer == 0 &&
             !state.layer_influences.empty() && may_bend(model, identity.body)) {
    take_bend(at, poisson_ratio);
  } else {
    result.changed = at.filled.half_size.x > 0.0;
    at.filled = LayerGrid{};
  }
  return result;
}

}  // namespace torsion::engine
