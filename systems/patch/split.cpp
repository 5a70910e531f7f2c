#include "systems/patch/split.hpp"

#include <algorithm>

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/grid_summary.hpp"
#include "systems/contact/support/body_law.hpp"
#include "systems/patch/cells.hpp"
#include "systems/patch/energy.hpp"
#include "systems/patch/grid.hpp"

namespace torsion {
namespace {

void copy_cells(World& world, Range from, Range to) {
  const PatchRows theirs = patch_rows(world, from);
  const PatchRows mine = patch_rows(world, to);
  std::ranges::copy(world.cells.rows<CellGeometry>(from),
                    world.cells.rows<CellGeometry>(to).begin());
  std::ranges::copy(theirs.tractions, mine.tractions.begin());
}

template <class Component>
void copy_component(World& world, std::uint32_t from, std::uint32_t region) {
  world.regions.at<Component>(region) = world.regions.at<Component>(from);
}

/// Lets go of the cells that are not in the region's contact.
/// @return the pressure that is left, Pa, summed over the cells
double keep_covered(World& world, std::uint32_t region) {
  const PatchRows rows = patch_rows(world, world.regions.at<RegionIdentity>(region).cells);
  double sum = 0.0;
  for (std::size_t cell = 0; cell < rows.tractions.size(); ++cell) {
    if (rows.geometry[cell].coverage <= 0.0) {
      rows.tractions[cell] = CellTraction{};
    }
    sum += rows.tractions[cell].pressure;
  }
  return sum;
}

/// Cells that are as near to the one region's contact as to the other's count in both.
void halve_shared(World& world, std::uint32_t from, std::uint32_t region) {
  const PatchRows theirs = patch_rows(world, world.regions.at<RegionIdentity>(from).cells);
  const PatchRows mine = patch_rows(world, world.regions.at<RegionIdentity>(region).cells);
  for (std::size_t cell = 0; cell < mine.tractions.size(); ++cell) {
    if (theirs.geometry[cell].coverage > 0.0 && mine.geometry[cell].coverage > 0.0) {
      for (CellTraction* const each : {&theirs.tractions[cell], &mine.tractions[cell]}) {
        each->pressure *= 0.5;
        each->traction *= 0.5;
      }
    }
  }
}

/// The region that was copied; its row may have changed since.
std::uint32_t copied_from(const World& world, const PatchState& state) {
  const auto regions = world.regions.column<RegionIdentity>();
  const auto found = std::ranges::find(
      regions, state.copy_of - 1, [](const RegionIdentity& region) { return block_of(region); });
  TORSION_ASSERT(found != regions.end());
  return static_cast<std::uint32_t>(found - regions.begin());
}

/// Lays the grid around what is left, at once: in the next step that would be a second event.
void lay_around_rest(StepContext& context, std::uint32_t region) {
  const Grid grid = grid_of(context, region);
  const RegionPoints& contact = context.scratch.region_points[block_of(grid.identity)];
  lay_around_loaded(context, region, contact);
  find_cells(grid, contact);
  context.world.regions.at<RegionGeometry>(region) = summarize_cells(grid);
  // They are held where they will have moved to without the other region's tractions.
  std::ranges::fill(patch_rows(context.world, grid.identity.cells).surface.known, 0.0);
}

void share_out(StepContext& context, std::uint32_t from, std::uint32_t region) {
  World& world = context.world;
  halve_shared(world, from, region);
  const double left = keep_covered(world, from);
  const double taken = keep_covered(world, region);
  lay_around_rest(context, from);
  lay_around_rest(context, region);
  const BodyLaw& body = body_law_of(world, world.regions.at<RegionIdentity>(from).body);
  if (body.split != nullptr) {
    body.split(world, from, region);
  }
  if (left + taken > 0.0) {
    split_energy(world, from, region, taken / (left + taken));
  }
  for (const std::uint32_t each : {from, region}) {
    PatchState& state = world.regions.at<PatchState>(each);
    state.moved = 1;
    state.resized = 1;
  }
}

}  // namespace

void copy_patch(World& world, std::uint32_t from, std::uint32_t region) {
  if (world.regions.at<PatchState>(from).started == 0) {
    return;
  }
  const Range cells = world.regions.at<RegionIdentity>(from).cells;
  copy_cells(world, cells, world.regions.at<RegionIdentity>(region).cells);
  copy_component<RegionFrame>(world, from, region);
  copy_component<RegionCarrier>(world, from, region);
  copy_component<RegionGeometry>(world, from, region);
  copy_component<RegionMotion>(world, from, region);
  copy_component<RegionFriction>(world, from, region);
  copy_component<PatchState>(world, from, region);
  world.regions.at<PatchState>(region).copy_of = cells.first / cells.count + 1;
}

void share_out_patch(StepContext& context, std::uint32_t region) {
  PatchState& state = context.world.regions.at<PatchState>(region);
  if (state.copy_of != 0) {
    share_out(context, copied_from(context.world, state), region);
    state.copy_of = 0;
  }
}

}  // namespace torsion
