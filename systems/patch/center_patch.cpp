// The grid of a new region of contact model `patch`.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/contact/region_grid.hpp"
#include "systems/half_space/influence.hpp"
#include "systems/patch/grid.hpp"
#include "systems/patch/growth.hpp"

namespace torsion::engine {
namespace {

constexpr int kMostPasses = 12;
constexpr double kCentered = 1e-9;         // of the grid: so little is left to do
constexpr double kFound = 1e-6;            // likewise, of a band, of which cells often tell less
constexpr double kCellsAcross = 3.0;       // a band, from which its direction can be told
constexpr double kCellsTurned = 1.5;       // likewise, of one that lies nearly along the grid
constexpr double kCellsBetweenRims = 2.0;  // at least, where rims run between cells
constexpr double kBand = 0.2;       // width over length: of a contact that is longer than its grid
constexpr double kNearGrid = 2e-3;  // of the grid: so near, cells keep what they know of the tool
constexpr double kLeastShare = 1.0 / 32;  // of its size, that a grid has after a pass

/// How a pass moves and resizes a grid, in its plane, m.
struct GridStep {
  glm::dvec2 shift{0.0};
  glm::dvec2 growth{0.0};  // of the half sides

  GridStep& operator+=(const GridStep& other) {
    shift += other.shift;
    growth += other.growth;
    return *this;
  }
};

GridStep operator+(GridStep a, const GridStep& b) {
  return a += b;
}

GridStep operator*(double scale, const GridStep& step) {
  return {scale * step.shift, scale * step.growth};
}

double product(const GridStep& a, const GridStep& b) {
  return glm::dot(a.shift, b.shift) + glm::dot(a.growth, b.growth);
}

/// Solves x = g(x) from the residuals g(x) - x at the places visited (Anderson, J. ACM 12 (1965)
/// 547, with the last two steps): on meshes, each plain pass leaves three quarters of the residual.
class FixedPoint {
 public:
  /// @param left  residual at the place to which the last step has led
  /// @return the step to take
  GridStep next(const GridStep& left) {
    if (any_) {
      std::swap(changes_[0], changes_[1]);
      changes_[0] = {step_, left + -1.0 * left_};
      count_ = std::min<std::size_t>(count_ + 1, changes_.size());
    }
    any_ = true;
    left_ = left;
    step_ = left;
    GridStep rest = left;
    // By Gram and Schmidt: each change of the residual removes its component. The older change is
    // made normal to the newer one first.
    std::array<Change, 2> normal = changes_;
    for (std::size_t k = 0; k < count_; ++k) {
      for (std::size_t before = 0; before < k; ++before) {
        const double part = product(normal[k].left, normal[before].left) /
                            product(normal[before].left, normal[before].left);
        normal[k].left += -part * normal[before].left;
        normal[k].step += -part * normal[before].step;
      }
      const double square = product(normal[k].left, normal[k].left);
      if (square <= kSame * product(changes_[k].left, changes_[k].left) || square == 0.0) {
        count_ = k;
        break;
      }
      const double part = product(rest, normal[k].left) / square;
      rest += -part * normal[k].left;
      step_ += -part * (normal[k].step + normal[k].left);
    }
    if (product(step_, step_) > kFarthest * kFarthest * product(left, left)) {
      step_ = left;
    }
    return step_;
  }

  void forget() {
    count_ = 0;
    any_ = false;
  }

 private:
  static constexpr double kSame = 1e-4;     // of a change's square: it says nothing that is new
  static constexpr double kFarthest = 8.0;  // times what is left

  struct Change {
    GridStep step;  // gone
    GridStep left;  // how much more there is left to do then
  };
  std::array<Change, 2> changes_;  // the last one first
  std::size_t count_ = 0;
  GridStep left_;
  GridStep step_;
  bool any_ = false;
};

double largest_share(const GridStep& step, const glm::dvec2& half_size) {
  const glm::dvec2 share = glm::max(glm::abs(step.shift), glm::abs(step.growth)) / half_size;
  return std::max(share.x, share.y);
}

/// Whether passes converge.
class Progress {
 public:
  /// @param left  the residual, as a share of the grid
  void note(double left) {
    const bool nearer = left < kNearer * least_;
    stalled_ = nearer ? 0 : stalled_ + 1;
    blurred_ = !nearer && left < kBlurred;
    least_ = std::min(least_, left);
  }
  [[nodiscard]] bool is_at_end() const {
    return least_ < kCentered || blurred_ || stalled_ > kMostStalled;
  }
  /// Steps as along a staircase (the rim of a flat face moves by whole cells) do not converge.
  [[nodiscard]] bool stalls() const { return stalled_ > 2; }

 private:
  static constexpr double kNearer = 0.5;    // of what was left to do
  static constexpr double kBlurred = 1e-5;  // distances to a mesh may say no more
  static constexpr int kMostStalled = 5;

  double least_ = 1.0;
  int stalled_ = 0;
  bool blurred_ = false;
};

/// Middle of the overlap in the grid's plane, weighted with its depth, m.
glm::dvec2 overlap_middle(const Grid& grid) {
  double sum = 0.0;
  glm::dvec2 moment(0.0);
  double covered = 0.0;
  glm::dvec2 moment_of_covered(0.0);
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      const double weight = grid.cells[cell].coverage * std::max(grid.cells[cell].depth, 0.0);
      const glm::dvec2 center = cell_center(grid.frame, grid.side, i, j);
      sum += weight;
      moment += weight * center;
      covered += grid.cells[cell].coverage;
      moment_of_covered += grid.cells[cell].coverage * center;
    }
  }
  if (sum > 0.0) {
    return moment / sum;
  }
  // What is narrower than a cell may be deep at no cell's centre.
  return covered > 0.0 ? moment_of_covered / covered : glm::dvec2(0.0);
}

/// How much a grid may grow in one pass: many samples in contact show already how large the contact
/// is.
double most_growth(const Grid& grid, const RegionPoints& contact) {
  constexpr std::ptrdiff_t kMany = 4;
  const auto own = [&contact](const ContactPoint& point) {
    return point.cluster == contact.cluster;
  };
  return std::ranges::count_if(points_of(grid.scratch, contact), own) < kMany ? 16.0 : 1.5;
}

/// By what factor a grid that cuts the contact off must grow (1 if none does), from the depth at
/// its edges, as if the depth fell with the square of the distance.
double growth_beyond_edges(const Grid& grid, const CellBits& covered, double most) {
  constexpr double kLeast = 1.25;
  constexpr double kShallow = 0.25;  // of the largest depth: the next pass finds that as well
  const std::uint32_t last = grid.side - 1;
  const std::uint32_t first = patch_spare(grid.side);
  double edge = -1.0;  // m: the depth of what is cut
  double deepest = 0.0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = first; i < grid.side; ++i) {
      const CellGeometry& cell = grid.cells[j * grid.side + i];
      const bool is_covered = (covered[j] >> i & 1U) != 0;
      const bool outermost = i == first || i == last || j == 0 || j == last;
      if (is_covered) {
        deepest = std::max(deepest, cell.depth);
        if (outermost && cell.coverage >= 1.0) {
          edge = std::max(edge, cell.depth);
        }
      }
    }
  }
  if (edge <= kShallow * deepest) {
    return 1.0;
  }
  const double fall = 1.0 - edge / deepest;
  return fall > 0.0 ? std::clamp(kGridMargin / std::sqrt(fall), kLeast, most) : most;
}

/// Half sides of a grid that holds the whole overlap on both sides of its middle. A grid that cuts
/// it off sees a smaller overlap, and passes would not leave that state.
glm::dvec2 half_size_around(const Grid& grid, const glm::dvec2& middle, const PlaneBox& box) {
  const glm::dvec2 reach = glm::max(box.highest - middle, middle - box.lowest);
  const glm::dvec2 least = kGridMargin * glm::max(reach, glm::dvec2(kSmallestHalf));
  // Cells are made longer only where the overlap is longer by more than a doubling and a half:
  // otherwise they might alternate between two shapes.
  constexpr double kLonger = 0.6;  // of a doubling
  const std::int32_t now = table_aspect(grid.frame.half_size);
  const std::int32_t wanted = table_aspect(least);
  const bool longer = std::abs(wanted) > std::abs(now);
  const bool keeps = longer && std::abs(std::log2(least.x / least.y) - now) < kLonger;
  return tabulated_half_size(least, keeps ? now : wanted);
}

/// Whether the overlap, if it is long, is wider than so many cells.
bool is_wide(const Grid& grid, double least) {
  const ContactAxes axes = contact_axes(grid, covered_moments(grid));
  const glm::dvec2 cell = 2.0 * cell_half_size(grid);
  return !axes.is_long() ||
         axes.allowance * glm::length(axes.size) > least * std::min(cell.x, cell.y);
}

/// Whether the overlap is a band that the grid cuts off, or that is narrower than cells.
bool is_narrow_band(const Grid& grid, const CellBits& covered) {
  constexpr double kLittle = 0.25;  // of the largest depth
  const ContactAxes axes = contact_axes(grid, covered_moments(grid));
  return axes.is_long() && axes.allowance < kBand &&
         (growth_at_edges(grid, covered, kLittle) != glm::dvec2(1.0) ||
          !is_wide(grid, kCellsBetweenRims));
}

/// Lays a square grid's y along a band: the band's middle then runs through the middle of a column
/// (patch_middle), where even cells that are wider than the band see how deep it is.
void turn_along(const Grid& grid, const ContactAxes& axes) {
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  turn_axes(grid.frame, axes.size.x > axes.size.y ? axes.angle + kQuarter : axes.angle);
}

/// The middle of the deepest of the covered cells, m.
glm::dvec2 deepest_cell(const Grid& grid) {
  glm::dvec2 deepest(0.0);
  double depth = -1e300;
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      if (grid.cells[cell].coverage > 0.0 && grid.cells[cell].depth > depth) {
        depth = grid.cells[cell].depth;
        deepest = cell_center(grid.frame, grid.side, i, j);
      }
    }
  }
  return deepest;
}

/// Makes a grid square and so small that the band is some cells wide, and finds its cells.
void shrink_onto_band(const Grid& grid, const RegionPoints& contact, double start_depth) {
  constexpr int kPasses = 4;
  constexpr double kSmaller = 0.25;
  const glm::dvec2 half(std::min(grid.frame.half_size.x, grid.frame.half_size.y));
  lay(grid, glm::dvec2(0.0), half);
  restart_heights(grid, start_depth);
  find_cells(grid, contact);
  for (int pass = 0; pass < kPasses && !is_wide(grid, kCellsAcross); ++pass) {
    const RegionFrame before = grid.frame;
    lay(grid, deepest_cell(grid), kSmaller * grid.frame.half_size);
    restart_heights(grid, start_depth);
    if (covered_box(grid, find_cells(grid, contact)).empty()) {
      grid.frame = before;
      restart_heights(grid, start_depth);
      find_cells(grid, contact);
      return;
    }
  }
}

/// The lengths, as half sides, between which a grid that just holds a band lies.
class LengthBracket {
 public:
  /// @param cut  whether a grid of this length cuts the band off
  void note(double half_length, bool cut) {
    (cut ? longest_cut_ : shortest_whole_) =
        cut ? std::max(longest_cut_, half_length) : std::min(shortest_whole_, half_length);
  }
  /// The length itself, or one between the limits: at the edge of a grid that cuts it off, a band
  /// does not tell how much longer it is, and cells that are as long as the band not how long.
  [[nodiscard]] double within(double half_length) const {
    const bool known = longest_cut_ > 0.0 && shortest_whole_ < kNone;
    return known && (half_length <= longest_cut_ || half_length >= shortest_whole_)
               ? std::sqrt(longest_cut_ * shortest_whole_)
               : half_length;
  }

 private:
  static constexpr double kNone = 1e300;

  double longest_cut_ = 0.0;
  double shortest_whole_ = kNone;
};

/// Passes over a grid along a band that reaches beyond it, as of an edge on a face. Square cells
/// that the length fits are wider than the band and hardly see it, so only the length grows.
void find_band(const Grid& grid, const RegionPoints& contact, double start_depth) {
  constexpr int kPasses = 10;
  constexpr double kLittle = 0.1;  // of the largest depth
  shrink_onto_band(grid, contact, start_depth);
  turn_along(grid, contact_axes(grid, covered_moments(grid)));
  restart_heights(grid, start_depth);
  FixedPoint seeker;
  LengthBracket lengths;
  for (int pass = 0; pass < kPasses; ++pass) {
    CellBits covered = find_cells(grid, contact);
    const ContactAxes axes = contact_axes(grid, covered_moments(grid));
    // Of a band that is narrower than its cells, those tell no angle.
    if (is_wide(grid, kCellsTurned) && std::abs(axes.angle) > kCentered) {
      turn_axes(grid.frame, axes.angle);
      restart_heights(grid, start_depth);
      covered = find_cells(grid, contact);
    }
    const PlaneBox box = covered_box(grid, covered);
    if (box.empty()) {
      return;
    }
    const glm::dvec2 before = grid.frame.half_size;
    const glm::dvec2 growth = growth_at_edges(grid, covered, kLittle);
    const glm::dvec2 middle = overlap_middle(grid);
    const glm::dvec2 reach =
        glm::max(glm::max(box.highest - middle, middle - box.lowest), glm::dvec2(kSmallestHalf));
    lengths.note(before.y, growth.y > 1.0 || kGridMargin * reach.y > before.y);
    const glm::dvec2 half = tabulated_half_size(
        {growth.x > 1.0 ? growth.x * before.x : kGridMargin * reach.x,
         lengths.within(growth.y > 1.0 ? growth.y * before.y : kGridMargin * reach.y)});
    GridStep step{middle - middle_in_grid(grid.side) * half, half - before};
    const bool whole = growth == glm::dvec2(1.0);
    if (whole && largest_share(step, half) < kFound) {
      return;
    }
    if (whole && table_aspect(half) == table_aspect(before)) {
      step = seeker.next(step);
    } else {
      seeker.forget();
    }
    lay(grid, step.shift, glm::max(before + step.growth, kLeastShare * before));
    turn_normal_to(grid.frame, body_normal(grid, grid.frame.origin));
    restart_heights(grid, start_depth);
  }
  find_cells(grid, contact);
}

/// Passes over a grid with constant axes until it lies around the contact.
/// @return whether that is a narrow band, along which it lies then
bool find_middle(const Grid& grid, const RegionPoints& contact, double start_depth) {
  const glm::dvec2 off = middle_in_grid(grid.side);
  grid.frame.half_size = glm::dvec2(std::max(grid.frame.half_size.x, grid.frame.half_size.y));
  const double most = most_growth(grid, contact);
  FixedPoint seeker;
  Progress progress;
  bool seen_whole = false;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const CellBits covered = find_cells(grid, contact);
    const PlaneBox box = covered_box(grid, covered);
    if (box.empty()) {
      return false;
    }
    const glm::dvec2 before = grid.frame.half_size;
    if (is_narrow_band(grid, covered)) {
      find_band(grid, contact, start_depth);
      return true;
    }
    // Until it has held the whole contact once: later passes cut off little of it.
    const double beyond = seen_whole ? 1.0 : growth_beyond_edges(grid, covered, most);
    seen_whole = beyond == 1.0;
    const glm::dvec2 middle = overlap_middle(grid);
    const glm::dvec2 half = beyond > 1.0 ? beyond * before : half_size_around(grid, middle, box);
    GridStep step{middle - off * half, half - before};
    if (beyond > 1.0) {
      seeker.forget();
    } else {
      progress.note(largest_share(step, half));
      if (progress.is_at_end()) {
        return false;
      }
      if (progress.stalls() || table_aspect(half) != table_aspect(before)) {
        seeker.forget();
      } else {
        step = seeker.next(step);
      }
    }
    lay(grid, step.shift, glm::max(before + step.growth, kLeastShare * before));
    turn_normal_to(grid.frame, body_normal(grid, grid.frame.origin));
    if (largest_share(step, before) > kNearGrid) {
      restart_heights(grid, start_depth);
    }
  }
  find_cells(grid, contact);
  return false;
}

}  // namespace

void center_patch(const Grid& grid, const RegionPoints& contact, double start_depth) {
  const bool is_band = find_middle(grid, contact, start_depth);
  const ContactAxes axes = contact_axes(grid, covered_moments(grid));
  if (!is_band && axes.is_askew()) {
    turn_axes(grid.frame, axes.angle);
    // What fits along the grid's diagonal then fits along its sides.
    grid.frame.half_size *= std::numbers::sqrt2;
    restart_heights(grid, start_depth);
    find_middle(grid, contact, start_depth);
  }
  if (axes.is_long() && is_wide(grid, kCellsBetweenRims)) {
    lay_along_contact(grid, contact, start_depth, glm::dvec2(0.0));
    restart_heights(grid, start_depth);
    find_cells(grid, contact);
  }
}

}  // namespace torsion::engine
