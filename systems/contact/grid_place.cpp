#include "systems/contact/grid_place.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "systems/contact/law.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion {
namespace {

/// The highest set bit alone.
std::uint64_t last_bit(std::uint64_t bits) {
  return bits == 0 ? 0 : std::uint64_t{1} << (63 - std::countl_zero(bits));
}

}  // namespace

PlaneBox covered_box(const Grid& grid, const CellBits& covered) {
  PlaneBox box;
  std::optional<glm::dvec2> middle;  // of some covered cell
  const glm::dvec2 half = cell_half_size(grid);
  const double step = 2.0 / static_cast<double>(grid.side);
  const auto include = [&](std::uint32_t i, std::uint32_t j) {
    // As cell_center, without its division.
    const glm::dvec2 cell(static_cast<double>(i), static_cast<double>(j));
    const glm::dvec2 center = grid.frame.half_size * ((cell + 0.5) * step - 1.0);
    // At less than half coverage the edge is short of the centre: the reach is negative, and this
    // grows with the coverage without a jump.
    const glm::dvec2 reach = half * (2.0 * grid.cells[j * grid.side + i].coverage - 1.0);
    box.include(center - reach, center + reach);
    middle = center;
  };
  // A cell reaches no farther than a covered neighbour outside of it, so the outermost of each row
  // and all of the outermost rows say it all.
  const auto any = [](std::uint64_t row) {
    return row != 0;
  };
  const auto first = std::ranges::find_if(covered, any) - covered.begin();
  const auto last = covered.rend() - std::find_if(covered.rbegin(), covered.rend(), any) - 1;
  for (std::ptrdiff_t j = first; j <= last; ++j) {
    const auto row = static_cast<std::uint32_t>(j);
    for (std::uint64_t left = covered[row]; left != 0;) {
      include(static_cast<std::uint32_t>(std::countr_zero(left)), row);
      const bool outermost = j == first || j == last;
      left = outermost ? left & (left - 1) : last_bit(left & (left - 1));
    }
  }
  if (box.empty() && middle) {
    box.include(*middle, *middle);
  }
  return box;
}

PlaneBox covered_box(const Grid& grid, const CellBits& covered, double angle) {
  const glm::dvec2 x(std::cos(angle), std::sin(angle));
  const glm::dvec2 y(-x.y, x.x);
  const glm::dvec2 half = cell_half_size(grid);
  PlaneBox box;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint64_t left = covered[j]; left != 0; left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
      const glm::dvec2 center = cell_center(grid.frame, grid.side, i, j);
      const glm::dvec2 at(glm::dot(x, center), glm::dot(y, center));
      const glm::dvec2 reach = half * (2.0 * grid.cells[j * grid.side + i].coverage - 1.0);
      const glm::dvec2 along(glm::dot(glm::abs(x), reach), glm::dot(glm::abs(y), reach));
      box.include(at - along, at + along);
    }
  }
  return box;
}

glm::dvec2 half_size_for(const Grid& grid, const PlaneBox& box) {
  const glm::dvec2 half = 0.5 * (box.highest - box.lowest);
  const ContactLaw& law = law_of(grid.model, grid.identity.body);
  if (law.half_size != nullptr) {
    return law.half_size(kGridMargin * glm::max(half, glm::dvec2(kSmallestHalf)));
  }
  const double least = std::max(0.1 * std::max(half.x, half.y), kSmallestHalf);
  return kGridMargin * glm::max(half, glm::dvec2(least));
}

glm::dvec2 overlap_extent(const State& state, std::uint32_t region) {
  const glm::dvec2 of_grid = state.regions.at<RegionFrame>(region).half_size / kGridMargin;
  const SmoothContact& contact = state.regions.at<SmoothContact>(region);
  return contact.depth > 0.0 ? glm::mix(of_grid, contact.extent, contact.share) : of_grid;
}

glm::dvec3 body_normal(const Grid& grid, const glm::dvec3& point) {
  return glm::normalize(
      signed_distance(grid.model, grid.model.bodies.at<OwnedRows>(grid.identity.body).parts, point)
          .gradient);
}

void lay(const Grid& grid, const glm::dvec2& shift, const glm::dvec2& half_size) {
  RegionFrame& frame = grid.frame;
  frame.half_size = half_size;
  frame.origin += tangent_to_body(frame, shift);
  const Distance surface = signed_distance(
      grid.model, grid.model.bodies.at<OwnedRows>(grid.identity.body).parts, frame.origin);
  frame.origin -= frame.normal *
                  (surface.value / std::max(glm::dot(surface.gradient, frame.normal), kSteepest));
}

void fit(const Grid& grid, const PlaneBox& box) {
  lay(grid, 0.5 * (box.lowest + box.highest), half_size_for(grid, box));
}

void approach(const Grid& grid, const PlaneBox& box, bool moves) {
  constexpr double kShort = 0.05;  // of the half size: a cell is an eighth of it
  constexpr double kLong = 0.2;
  constexpr double kPart = 0.5;
  const glm::dvec2 half = grid.frame.half_size;
  const glm::dvec2 shift = 0.5 * (box.lowest + box.highest);
  const glm::dvec2 growth = half_size_for(grid, box) - half;
  const glm::dvec2 off = glm::max(glm::abs(shift), glm::abs(growth)) / half;
  const double most = std::max(off.x, off.y);
  if (!moves && most < kShort) {
    return;
  }
  const double part = kPart + (1.0 - kPart) * smooth_step((most - kShort) / (kLong - kShort));
  lay(grid, part * shift, half + part * growth);
}

void restart_heights(const Grid& grid, double depth) {
  for (CellGeometry& cell : grid.cells) {
    cell.height = -depth;
  }
}

}  // namespace torsion
