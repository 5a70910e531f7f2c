#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/contact/region_grid.hpp"
#include "systems/half_space/influence.hpp"
#include "systems/math/frames.hpp"
#include "systems/patch/grid.hpp"

namespace torsion::engine {
namespace {

constexpr double kFill = 0.81;       // of a new grid by the cells with pressure
constexpr double kLeastFill = 0.62;  // likewise, so that it is not at once found too large
constexpr double kSharp = 1.25;      // overlap over what is loaded: a round contact has 1.4
constexpr double kRectangularOverlap = 0.85;  // of its box is covered; of an ellipse's 0.79

glm::dvec2 origin_shift(const PlaneBox& box, const glm::dvec2& middle_cell, const glm::dvec2& cell,
                        std::uint32_t side) {
  return 0.5 * (box.lowest + box.highest) - (middle_cell - 0.5 * static_cast<double>(side)) * cell;
}

/// How many cells lie between the rims, and their shape.
struct CellsBetween {
  double x = 1.0;
  double y = 1.0;
  std::int32_t aspect = 0;
};

/// The cell counts for which the error of the rims along y is smallest while the rims along x are
/// exact, and which are many.
CellsBetween choose_cells(const glm::dvec2& size, std::uint32_t side) {
  constexpr double kCoarse = 0.3;  // relative error of the torque per cell's width over the contact
  constexpr double kKnown = 0.02;  // relative: the rims are not known better
  const double most = std::floor(fill_of_new(side) * static_cast<double>(side));
  const double least = kLeastFill * static_cast<double>(side);
  CellsBetween best;
  double least_cost = 1e300;
  for (std::int32_t aspect = -kMostAspect; aspect <= kMostAspect; ++aspect) {
    for (double x = 1.0; x <= most; x += 1.0) {
      const double wanted = size.y / size.x * x * std::ldexp(1.0, aspect);
      const double y = std::max(std::round(wanted), 1.0);
      if (y > most || std::max(x, y) < least) {
        continue;
      }
      const double cost =
          std::max(std::abs(wanted - y) / y, kKnown) + kCoarse * (1.0 / x + 1.0 / y);
      if (cost < least_cost) {
        least_cost = cost;
        best = {x, y, aspect};
      }
    }
  }
  return best;
}

/// Place of the middle of so many cells, counted from the corner, for which rims fall between
/// cells.
double middle_of(double cells, double wanted) {
  return std::round(wanted - 0.5 * cells) + 0.5 * cells;
}

/// Whether the covered cells cover so much of their box as those of a punch with straight rims.
bool cover_their_box(const Grid& grid, double covered, const PlaneBox& box) {
  const glm::dvec2 size = box.highest - box.lowest;
  return covered * cell_area(grid.frame, grid.side) > kRectangularOverlap * size.x * size.y;
}

}  // namespace

double fill_of_new(std::uint32_t side) {
  constexpr double kLess = 0.04;  // of a cell
  const double free = static_cast<double>(patch_spare(side)) + 1.0 + kLess;
  return std::min(kFill, std::max(1.0 - free / static_cast<double>(side), 0.5));
}

GridLayout layout_around(const PlaneBox& loaded, std::uint32_t side) {
  const glm::dvec2 half = 0.5 * (loaded.highest - loaded.lowest);
  const glm::dvec2 half_size = tabulated_half_size(half / fill_of_new(side));
  return {half_size, origin_shift(loaded, patch_middle(side),
                                  2.0 * half_size / static_cast<double>(side), side)};
}

GridLayout layout_between_rims(const PlaneBox& covered, bool sharp_x, bool sharp_y,
                               std::uint32_t side) {
  // An overlap that is thinner than the longest cells allow leaves room beside it.
  const glm::dvec2 covers = covered.highest - covered.lowest;
  const glm::dvec2 size =
      glm::max(covers, glm::dvec2(std::ldexp(std::max(covers.x, covers.y), -kMostAspect)));
  const double most = std::floor(fill_of_new(side) * static_cast<double>(side));
  CellsBetween cells{most, most, 0};
  glm::dvec2 cell = size / most;
  if (sharp_x && sharp_y) {
    cells = choose_cells(size, side);
    cell.x = size.x / cells.x;
    cell.y = std::ldexp(cell.x, -cells.aspect);
  } else {
    const double ratio = std::log2(cell.x / cell.y);
    // The other axis takes the size that the cells' shape leaves, but at least what it needs.
    const auto aspect = static_cast<std::int32_t>(std::clamp(
        sharp_x ? std::floor(ratio) : std::ceil(ratio), -1.0 * kMostAspect, 1.0 * kMostAspect));
    (sharp_x ? cell.y : cell.x) = std::ldexp(sharp_x ? cell.x : cell.y, sharp_x ? -aspect : aspect);
  }
  const glm::dvec2 wanted = patch_middle(side);
  const glm::dvec2 middle(sharp_x ? middle_of(cells.x, wanted.x) : wanted.x,
                          sharp_y ? middle_of(cells.y, wanted.y) : wanted.y);
  return {0.5 * static_cast<double>(side) * cell, origin_shift(covered, middle, cell, side)};
}

void lay_along_contact(const Grid& grid, const RegionPoints& contact, double depth,
                       const glm::dvec2& loaded) {
  restart_heights(grid, depth);
  CellBits covered = find_cells(grid, contact);
  CellMoments moments = covered_moments(grid);
  ContactAxes axes = contact_axes(grid, moments);
  if (std::abs(axes.angle) > kAligned * axes.allowance) {
    turn_axes(grid.frame, axes.angle);
    restart_heights(grid, depth);
    covered = find_cells(grid, contact);
    moments = covered_moments(grid);
    axes = contact_axes(grid, moments);
  }
  const PlaneBox box = covered_box(grid, covered);
  if (box.empty() || !cover_their_box(grid, moments.weight, box)) {
    return;
  }
  const bool sharp_x = loaded.x == 0.0 || axes.size.x < kSharp * loaded.x;
  const bool sharp_y = loaded.y == 0.0 || axes.size.y < kSharp * loaded.y;
  if (!sharp_x && !sharp_y) {
    return;
  }
  // The pressure ends in the middle of a wider overlap.
  const glm::dvec2 half(sharp_x ? 0.5 * axes.size.x : 0.5 * loaded.x,
                        sharp_y ? 0.5 * axes.size.y : 0.5 * loaded.y);
  const GridLayout layout =
      layout_between_rims({axes.middle - half, axes.middle + half}, sharp_x, sharp_y, grid.side);
  shift_origin(grid, layout.shift);
  grid.frame.half_size = layout.half_size;
}

void shift_origin(const Grid& grid, const glm::dvec2& shift) {
  const glm::dvec3 before = grid.frame.origin;
  lay(grid, shift, grid.frame.half_size);
  const double turn = glm::length(grid.carrier.rotation);
  if (turn > 0.0) {
    const glm::dvec3 way = grid.frame.origin - before;
    grid.carrier.translation += glm::angleAxis(turn, grid.carrier.rotation / turn) * way - way;
  }
}

namespace {

constexpr int kMostPasses = 12;
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
  static constexpr double kNearer = 0.5;     // of what was left to do
  static constexpr double kCentered = 1e-9;  // so little is left
  static constexpr double kBlurred = 1e-5;   // distances to a mesh may say no more
  static constexpr int kMostStalled = 5;

  double least_ = 1.0;
  int stalled_ = 0;
  bool blurred_ = false;
};

/// Middle of the overlap in the grid's plane, weighted with its depth, m.
glm::dvec2 overlap_middle(const Grid& grid) {
  double sum = 0.0;
  glm::dvec2 moment(0.0);
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++cell) {
      const double weight = grid.cells[cell].coverage * std::max(grid.cells[cell].depth, 0.0);
      sum += weight;
      moment += weight * cell_center(grid.frame, grid.side, i, j);
    }
  }
  return sum > 0.0 ? moment / sum : glm::dvec2(0.0);
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

/// Passes over a grid with constant axes until it lies around the contact.
void find_middle(const Grid& grid, const RegionPoints& contact, double start_depth) {
  // Of the half sides: the wanted place of the contact's middle.
  const glm::dvec2 off = patch_middle(grid.side) / static_cast<double>(grid.side) * 2.0 - 1.0;
  grid.frame.half_size = glm::dvec2(std::max(grid.frame.half_size.x, grid.frame.half_size.y));
  const double most = most_growth(grid, contact);
  FixedPoint seeker;
  Progress progress;
  bool seen_whole = false;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const CellBits covered = find_cells(grid, contact);
    const PlaneBox box = covered_box(grid, covered);
    if (box.empty()) {
      return;
    }
    const glm::dvec2 before = grid.frame.half_size;
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
        return;
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
}

}  // namespace

void center_patch(const Grid& grid, const RegionPoints& contact, double start_depth) {
  find_middle(grid, contact, start_depth);
  const ContactAxes axes = contact_axes(grid, covered_moments(grid));
  if (axes.is_askew()) {
    turn_axes(grid.frame, axes.angle);
    // What fits along the grid's diagonal then fits along its sides.
    grid.frame.half_size *= std::numbers::sqrt2;
    restart_heights(grid, start_depth);
    find_middle(grid, contact, start_depth);
  }
  if (axes.is_long()) {
    lay_along_contact(grid, contact, start_depth, glm::dvec2(0.0));
    restart_heights(grid, start_depth);
    find_cells(grid, contact);
  }
}

}  // namespace torsion::engine
