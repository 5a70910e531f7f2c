#include "systems/patch_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "systems/contact_models/influence.hpp"
#include "systems/contact_models/patch_cells.hpp"
#include "systems/frames.hpp"
#include "systems/grid_cells.hpp"
#include "systems/region_wrenches.hpp"

namespace torsion {
namespace {

constexpr double kFill = 0.81;          // of a new grid by the cells with pressure
constexpr double kSmallestFill = 0.74;  // over that: below it the grid is laid anew, smaller
constexpr double kSteepest = 0.25;      // smallest cosine that is divided by
constexpr double kSure = 1.3;           // over the point load's far field: what certainly touches

/// A box of cells; `end` is one past the last.
struct CellBox {
  glm::ivec2 first{0};
  glm::ivec2 end{0};
};

/// The cells with pressure; empty when there are none.
CellBox loaded_cells(const Grid& grid) {
  const auto tractions = grid.world.cells.rows<CellTraction>(grid.identity.cells);
  const auto side = static_cast<int>(grid.side);
  CellBox box{{side, side}, {0, 0}};
  std::size_t cell = 0;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i, ++cell) {
      if (tractions[cell].pressure > 0.0) {
        box.first = glm::min(box.first, glm::ivec2(i, j));
        box.end = glm::max(box.end, glm::ivec2(i + 1, j + 1));
      }
    }
  }
  return box;
}

glm::dvec2 cell_size(const Grid& grid) {
  return 2.0 * cell_half_size(grid);
}

bool reaches_edge(const Grid& grid, const CellBox& box) {
  const auto side = static_cast<int>(grid.side);
  const auto spare = static_cast<int>(patch_spare(grid.side));
  return box.first.x < 1 + spare || box.first.y < 1 || box.end.x > side - 1 || box.end.y > side - 1;
}

/// No more than what leaves a free row on either side, or the next step would lay it anew: of a
/// contact in the middle half a cell more on either side has no cell's centre in it.
double fill_of_new(std::uint32_t side) {
  constexpr double kLess = 0.04;  // of a cell
  const double free = static_cast<double>(patch_spare(side)) + 1.0 + kLess;
  return std::min(kFill, std::max(1.0 - free / static_cast<double>(side), 0.5));
}

/// Takes in the contact points outside the grid that lie deeper than the pressure can have pushed
/// the surface away there.
void include_lobes(const Grid& grid, std::uint32_t region, const RegionPoints& contact,
                   CellBox& box) {
  const World& world = grid.world;
  const double force = world.regions.at<RegionNormal>(region).force;
  const double modulus = world.bodies.at<Elasticity>(grid.identity.body).contact_modulus();
  const glm::dvec3 center =
      body_to_grid(grid.frame, world.regions.at<RegionGeometry>(region).equivalent_point);
  const RegionSupport& support = world.regions.at<RegionSupport>(region);
  for (const ContactPoint& point : points_of(grid.scratch, contact)) {
    if (point.cluster != contact.cluster) {
      continue;
    }
    const glm::dvec3 place = body_to_grid(grid.frame, point.position);
    if (std::abs(place.x) < grid.frame.half_size.x && std::abs(place.y) < grid.frame.half_size.y) {
      continue;
    }
    const double distance = glm::length(glm::dvec2(place - center));
    // Points are found against the rest shape: what the whole body has sunk there is no overlap.
    const double sunk = -glm::dot(
        grid.frame.normal,
        support.translation + glm::cross(support.rotation, point.position - support.about));
    // Far field of a point load, F / (pi E* r): Johnson, Contact Mechanics, 1985, (3.22a).
    if ((point.depth - sunk) * std::numbers::pi * modulus * distance > kSure * force) {
      const glm::dvec2 at =
          (glm::dvec2(place) / grid.frame.half_size + 1.0) * 0.5 * static_cast<double>(grid.side);
      const glm::ivec2 cell(glm::floor(at));
      box.first = glm::min(box.first, cell);
      box.end = glm::max(box.end, cell + 1);
    }
  }
}

/// Catmull-Rom's weights at a place between the second and the third of four values.
std::array<double, 4> cubic_weights(double x) {
  return {x * (-0.5 + x * (1.0 - 0.5 * x)), 1.0 + x * x * (-2.5 + 1.5 * x),
          x * (0.5 + x * (2.0 - 1.5 * x)), x * x * (-0.5 + 0.5 * x)};
}

/// What the cells were before the grid moved.
struct Before {
  std::span<const double> held_x, held_y;  // m
  std::span<const CellTraction> tractions;
  int side;
  int spare;  // columns that hold nothing
};

/// Between the old cells around `place` (in cells, from the first one's centre).
struct Resampled {
  glm::dvec2 held{0.0};  // m
  bool known = false;    // whether there is one
  CellTraction traction;
};

bool inside(const Before& before, const glm::ivec2& cell) {
  return cell.x >= before.spare && cell.y >= 0 && cell.x < before.side && cell.y < before.side;
}

/// On a cell's centre but for rounding: there, so that mirror images fall on the same side of it.
glm::dvec2 on_centers(const glm::dvec2& place) {
  constexpr double kOnCenter = 1e-6;
  const glm::dvec2 nearest = glm::round(place);
  return {std::abs(place.x - nearest.x) < kOnCenter ? nearest.x : place.x,
          std::abs(place.y - nearest.y) < kOnCenter ? nearest.y : place.y};
}

Resampled resample(const Before& before, const glm::dvec2& cells) {
  const glm::dvec2 place = on_centers(cells);
  const glm::dvec2 low = glm::floor(place);
  const glm::dvec2 part = place - low;
  const glm::ivec2 corner(low);
  Resampled result;
  const std::array<double, 2> linear_x{1.0 - part.x, part.x};
  const std::array<double, 2> linear_y{1.0 - part.y, part.y};
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 2; ++x) {
      const glm::ivec2 at = corner + glm::ivec2(x, y);
      if (inside(before, at)) {
        const double weight =
            linear_x[static_cast<std::size_t>(x)] * linear_y[static_cast<std::size_t>(y)];
        const CellTraction& from =
            before.tractions[static_cast<std::size_t>(at.y * before.side + at.x)];
        result.traction.pressure += weight * from.pressure;
        result.traction.traction += weight * from.traction;
        result.traction.kinetic_share += weight * from.kinetic_share;
      }
    }
  }
  // The displacement is smooth: four points a way keep it, two would wear it down.
  const glm::ivec2 between(part.x > 0.0 ? 1 : 0, part.y > 0.0 ? 1 : 0);
  if (!inside(before, corner - between) || !inside(before, corner + 2 * between)) {
    return result;
  }
  const std::array<double, 4> cubic_x = cubic_weights(part.x);
  const std::array<double, 4> cubic_y = cubic_weights(part.y);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      const glm::ivec2 at = corner + between * glm::ivec2(x - 1, y - 1);
      const double weight =
          cubic_x[static_cast<std::size_t>(x)] * cubic_y[static_cast<std::size_t>(y)];
      const auto cell = static_cast<std::size_t>(at.y * before.side + at.x);
      result.held += weight * glm::dvec2(before.held_x[cell], before.held_y[cell]);
    }
  }
  result.known = true;
  return result;
}

/// Where the cells of the new grid are among those of the old one: old = origin + scale * new.
struct CellMove {
  glm::dvec2 origin{0.0};
  glm::dvec2 scale{1.0};
};

void copy_cells(const Grid& grid, const PatchSurface& surface) {
  std::ranges::copy(surface.held_x, grid.scratch.held_before.x.begin());
  std::ranges::copy(surface.held_y, grid.scratch.held_before.y.begin());
  std::ranges::copy(grid.world.cells.rows<CellTraction>(grid.identity.cells),
                    grid.scratch.tractions_before.begin());
}

void move_cells(const Grid& grid, const CellMove& move, double depth) {
  const PatchRows rows = patch_rows(grid.world, grid.identity.cells);
  copy_cells(grid, rows.surface);
  const HeldBefore& held = grid.scratch.held_before;
  const Before before{held.x, held.y, grid.scratch.tractions_before, static_cast<int>(grid.side),
                      static_cast<int>(patch_spare(grid.side))};
  grid.world.patch_cells.zero(grid.identity.cells);
  std::size_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      const glm::dvec2 here(static_cast<double>(i), static_cast<double>(j));
      const Resampled from = resample(before, move.origin + move.scale * here);
      rows.surface.held_x[cell] = from.held.x;
      rows.surface.held_y[cell] = from.held.y;
      rows.surface.known[cell] = from.known ? 1.0 : 0.0;
      rows.tractions[cell] = from.traction;
      grid.cells[cell].height = -depth;
    }
  }
}

/// Puts the origin back on the body's rest surface.
void back_to_surface(const Grid& grid) {
  RegionFrame& frame = grid.frame;
  const Distance surface = signed_distance(
      grid.world, grid.world.bodies.at<OwnedRows>(grid.identity.body).parts, frame.origin);
  frame.origin -= frame.normal *
                  (surface.value / std::max(glm::dot(surface.gradient, frame.normal), kSteepest));
}

/// Lays the grid so that `box` of its cells is in its middle.
/// @return how the cells moved
CellMove move_frame(const Grid& grid, const CellBox& box) {
  const double side = static_cast<double>(grid.side);
  const glm::dvec2 off = patch_middle(grid.side) - 0.5 * side;
  const glm::dvec2 size = cell_size(grid);
  const glm::dvec2 half = 0.5 * size * glm::dvec2(box.end - box.first);
  const glm::dvec2 wanted = patch_half_size(half / fill_of_new(grid.side));
  glm::dvec2 middle = 0.5 * glm::dvec2(box.first + box.end);  // in cells from the grid's corner
  CellMove move;
  const glm::dvec2 growth = wanted / grid.frame.half_size;
  // With a free row or column on either side, or the next step would lay it anew.
  const glm::ivec2 room = glm::ivec2(static_cast<int>(grid.side)) - (box.end - box.first) -
                          glm::ivec2(static_cast<int>(patch_spare(grid.side)), 0);
  const bool keeps_size =
      growth.x == growth.y && growth.x > 0.8 && growth.x < 1.2 && std::min(room.x, room.y) >= 2;
  if (keeps_size) {
    move.origin = glm::round(middle - off - 0.5 * side);
    middle = 0.5 * side + move.origin;
  } else {
    move.scale = growth;
    middle -= off * growth;
    move.origin = middle - 0.5 - 0.5 * (side - 1.0) * growth;
    grid.frame.half_size = wanted;
  }
  grid.frame.origin += tangent_to_body(grid.frame, (middle - 0.5 * side) * size);
  back_to_surface(grid);
  return move;
}

}  // namespace

bool has_patch(const World& world, const RegionIdentity& region) {
  return world.bodies.at<BodyModels>(region.body).contact == ContactModel::kPatch;
}

std::int32_t patch_aspect(const glm::dvec2& half_size) {
  const double ratio = std::log2(half_size.x / half_size.y);
  return static_cast<std::int32_t>(
      std::clamp(std::round(ratio), -1.0 * kMostAspect, 1.0 * kMostAspect));
}

glm::dvec2 patch_middle(std::uint32_t side) {
  const double half = 0.5 * static_cast<double>(side);
  return {half + 0.5 * patch_spare(side), half};
}

std::uint32_t patch_spare(std::uint32_t side) {
  constexpr std::uint32_t kCoarsest = 6;
  return side % 2 == 0 && side >= kCoarsest ? 1 : 0;
}

glm::dvec2 patch_half_size(const glm::dvec2& least, std::int32_t aspect) {
  const double ratio = std::ldexp(1.0, aspect);
  const double half = std::max(least.x, least.y * ratio);
  return {half, half / ratio};
}

glm::dvec2 patch_half_size(const glm::dvec2& least) {
  return patch_half_size(least, patch_aspect(least));
}

void follow_patch(StepContext& context, std::uint32_t region, const RegionPoints& contact) {
  const Grid grid = grid_of(context, region);
  CellBox box = loaded_cells(grid);
  if (box.end.x == 0) {
    return;
  }
  if (!reaches_edge(grid, box)) {
    // Only then: a contact that has outgrown its grid has points outside of it anyway, and which
    // ones is chance.
    include_lobes(grid, region, contact, box);
  }
  const glm::ivec2 extent = box.end - box.first;
  const bool too_small =
      std::max(extent.x, extent.y) <
      static_cast<int>(kSmallestFill * fill_of_new(grid.side) * static_cast<double>(grid.side));
  if (!reaches_edge(grid, box) && !too_small) {
    return;
  }
  const double depth = context.world.regions.at<RegionGeometry>(region).largest_depth;
  const glm::dvec3 origin = grid.frame.origin;
  const CellMove move = move_frame(grid, box);
  move_cells(grid, move, depth);
  std::uint32_t& event = context.world.regions.at<RegionWrench>(region).event_now;
  if (event == 0 && move.scale != glm::dvec2(1.0)) {
    event = static_cast<std::uint32_t>(RegionEvent::kGridLaidAnew);
  }
  // The material's motion is told at the grid's origin, which has moved.
  RegionCarrier& carrier = context.world.regions.at<RegionCarrier>(region);
  const double turn = glm::length(carrier.rotation);
  if (turn > 0.0) {
    const glm::dvec3 way = grid.frame.origin - origin;
    carrier.translation += glm::angleAxis(turn, carrier.rotation / turn) * way - way;
  }
  PatchState& state = context.world.regions.at<PatchState>(region);
  state.moved = 1;
  state.resized = move.scale != glm::dvec2(1.0) ? 1 : 0;
}

}  // namespace torsion
