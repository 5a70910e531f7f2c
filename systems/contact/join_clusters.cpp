#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "ecs/assert.hpp"
#include "systems/contact/grid_cells.hpp"
#include "systems/contact/group_regions.hpp"
#include "systems/geometry/bounds.hpp"
#include "systems/geometry/distance.hpp"
#include "systems/math/disjoint_sets.hpp"
#include "systems/math/frames.hpp"

namespace torsion::engine {
namespace {

constexpr double kLeastCoverage = 0.1;
constexpr double kLeastAgreement = 0.9;  // cosine between the normals of regions that may be one

/// A region's covered cells, and which contact points lie on them.
struct RegionCover {
  RegionCover(const Model& model, const State& state, std::uint32_t region)
      : frame(state.regions.at<RegionFrame>(region)),
        finder(moved_grid_in_body(frame, state.regions.at<RegionCarrier>(region),
                                  state.regions.at<RegionSupport>(region)),
               frame.half_size, model.settings.grid_side),
        normal(glm::cross(finder.tangent_x, finder.tangent_y)),
        cells(state.cells.rows<CellGeometry>(state.regions.at<RegionIdentity>(region).cells)) {}

  /// Covered by more than what the slope at the rim may show of a contact that ends before this
  /// cell.
  [[nodiscard]] bool is_covered(const CellPlace& cell) const {
    return cells[std::size_t{cell.j} * finder.side + cell.i].coverage >= kLeastCoverage;
  }

  /// The covered cell that a point lies on, if any.
  [[nodiscard]] std::optional<CellPlace> under(const glm::dvec3& point) const {
    const auto cell = finder.under(point);
    if (!cell || !is_covered(*cell)) {
      return std::nullopt;
    }
    return is_near(point, *cell) ? cell : std::nullopt;
  }

  /// A point belongs to a cell if it is not far above or below it: on a slope of two to one the
  /// tool's surface rises by two cells across one.
  [[nodiscard]] bool is_near(const glm::dvec3& point, const CellPlace& cell) const {
    const double reach = 4.0 * std::max(frame.half_size.x, frame.half_size.y) / finder.side;
    const double height = glm::dot(point - finder.origin, normal);
    return std::abs(height - cells[std::size_t{cell.j} * finder.side + cell.i].height) < reach;
  }

  /// m, body: where the tool's surface is in a cell.
  [[nodiscard]] glm::dvec3 place_of(const CellPlace& cell) const {
    const glm::dvec2 center = cell_center(frame, finder.side, cell.i, cell.j);
    return finder.origin + finder.tangent_x * center.x + finder.tangent_y * center.y +
           normal * cells[std::size_t{cell.j} * finder.side + cell.i].height;
  }

  [[nodiscard]] CellBits bits() const {
    CellBits covered{};
    for (std::uint32_t j = 0; j < finder.side; ++j) {
      for (std::uint32_t i = 0; i < finder.side; ++i) {
        covered[j] |= is_covered({i, j}) ? std::uint64_t{1} << i : 0;
      }
    }
    return covered;
  }

  const RegionFrame& frame;
  CellFinder finder;
  glm::dvec3 normal;
  std::span<const CellGeometry> cells;
};

bool several_clusters_on(const RegionCover& cover, std::span<const ContactPoint> points) {
  std::uint32_t first = kNoRow;
  return std::ranges::any_of(points, [&](const ContactPoint& point) {
    if (point.cluster == first || !cover.under(point.position)) {
      return false;
    }
    const bool another = first != kNoRow;
    first = point.cluster;
    return another;
  });
}

void link_joined(const RegionCover& cover, std::span<const ContactPoint> points,
                 std::span<std::uint32_t> parent) {
  CellBits free = cover.bits();
  for (const ContactPoint& start : points) {
    const auto cell = cover.under(start.position);
    const std::uint64_t bit = cell ? std::uint64_t{1} << cell->i : 0;
    if (!cell || (free[cell->j] & bit) == 0) {
      continue;  // reached before, and linked
    }
    CellBits reached{};
    reached[cell->j] = bit;
    free[cell->j] &= ~bit;
    while (spread_one_step(cover.finder.side, free, reached)) {
    }
    for (const ContactPoint& point : points) {
      const auto other = cover.under(point.position);
      if (other && (reached[other->j] >> other->i & 1U) != 0) {
        link(parent, start.cluster, point.cluster);
      }
    }
  }
}

/// The cluster of a point on a region's covered cells, or kNoRow.
std::uint32_t cluster_on(const RegionCover& cover, std::span<const ContactPoint> points) {
  const auto on = std::ranges::find_if(
      points, [&](const ContactPoint& point) { return cover.under(point.position).has_value(); });
  return on == points.end() ? kNoRow : on->cluster;
}

bool covers_touch(const RegionCover& one, const RegionCover& other) {
  const double reach = glm::length(one.frame.half_size) + glm::length(other.frame.half_size);
  if (glm::distance(one.finder.origin, other.finder.origin) > reach ||
      glm::dot(one.normal, other.normal) < kLeastAgreement) {
    return false;
  }
  CellBits beside = other.bits();
  CellBits all;
  all.fill(~std::uint64_t{0});
  spread_one_step(other.finder.side, all, beside);
  for (std::uint32_t j = 0; j < one.finder.side; ++j) {
    for (std::uint32_t i = 0; i < one.finder.side; ++i) {
      if (one.is_covered({i, j})) {
        const glm::dvec3 place = one.place_of({i, j});
        const auto cell = other.finder.under(place);
        if (cell && (beside[cell->j] >> cell->i & 1U) != 0 && other.is_near(place, *cell)) {
          return true;
        }
      }
    }
  }
  return false;
}

/// Numbers the sets of clusters 0, 1, ... and writes the numbers to the points.
void renumber(std::span<std::uint32_t> parent, std::span<std::uint32_t> numbers,
              std::span<ContactPoint> points, ContactPair& pair) {
  std::uint32_t count = 0;
  for (std::uint32_t cluster = 0; cluster < pair.clusters; ++cluster) {
    const std::uint32_t root = root_of(parent, cluster);
    numbers[cluster] = root == cluster ? count++ : numbers[root];
  }
  for (ContactPoint& point : points) {
    point.cluster = numbers[point.cluster];
  }
  pair.clusters = count;
}

std::uint32_t regions_of(const State& state, const ContactPair& pair) {
  return static_cast<std::uint32_t>(std::ranges::count_if(
      state.regions.column<RegionIdentity>(),
      [&pair](const RegionIdentity& region) { return is_of_pair(region, pair); }));
}

/// Links the clusters on a region's cells with each other and with those of the regions that it
/// touches.
void join_on(const Model& model, const State& state, std::uint32_t region, const ContactPair& pair,
             std::span<const ContactPoint> points, std::span<std::uint32_t> parent) {
  const RegionCover cover(model, state, region);
  if (several_clusters_on(cover, points)) {
    link_joined(cover, points, parent);
  }
  const std::uint32_t cluster = cluster_on(cover, points);
  for (std::uint32_t other = 0; cluster != kNoRow && other < state.regions.size(); ++other) {
    if (other == region || !is_of_pair(state.regions.at<RegionIdentity>(other), pair)) {
      continue;
    }
    const RegionCover beside(model, state, other);
    if (!covers_touch(cover, beside)) {
      continue;
    }
    const std::uint32_t neighbour = cluster_on(beside, points);
    if (neighbour != kNoRow) {
      link(parent, cluster, neighbour);
    }
  }
}

/// Bounding boxes of the clusters' points.
class ClusterBoxes {
 public:
  ClusterBoxes(std::span<const ContactPoint> points, std::uint32_t clusters) : count_(clusters) {
    boxes_.fill(bounds_of(std::span<const glm::dvec3>()));
    for (const ContactPoint& point : points) {
      if (point.cluster < boxes_.size()) {
        Bounds& box = boxes_[point.cluster];
        box.lowest = glm::min(box.lowest, point.position);
        box.highest = glm::max(box.highest, point.position);
      }
    }
  }

  /// How many clusters, of those it has a box for, may have points on a region or beside it.
  [[nodiscard]] bool has_all() const { return count_ <= boxes_.size(); }

  [[nodiscard]] bool near(std::uint32_t one, std::uint32_t other, double reach) const {
    return boxes_meet(boxes_[one], boxes_[other], reach);
  }

  [[nodiscard]] std::size_t near(const State& state, std::uint32_t region) const {
    if (!has_all()) {
      return count_;
    }
    const RegionFrame& frame = state.regions.at<RegionFrame>(region);
    const glm::dvec3 middle = frame.origin + state.regions.at<RegionCarrier>(region).translation +
                              state.regions.at<RegionSupport>(region).translation;
    const double reach =
        2.0 * (glm::length(frame.half_size) + state.regions.at<Overlap>(region).largest_depth);
    return static_cast<std::size_t>(
        std::count_if(boxes_.begin(), boxes_.begin() + count_, [&](const Bounds& box) {
          return boxes_meet(box, {middle, middle}, reach);
        }));
  }

 private:
  std::array<Bounds, std::size_t{2} * kMaxRegionsPerBody> boxes_;
  std::uint32_t count_;
};

/// The point of a cluster that is nearest to a place, its first one where places are not numbers.
const glm::dvec3& nearest_of(std::uint32_t cluster, std::span<const ContactPoint> points,
                             const glm::dvec3& place) {
  const glm::dvec3* nearest = nullptr;
  double least = 0.0;
  for (const ContactPoint& point : points) {
    if (point.cluster != cluster) {
      continue;
    }
    const glm::dvec3 gap = point.position - place;
    if (nearest == nullptr || glm::dot(gap, gap) < least) {
      least = glm::dot(gap, gap);
      nearest = &point.position;
    }
  }
  TORSION_ASSERT(nearest != nullptr);
  return *nearest;
}

/// A point of the tool's surface in the body.
struct SurfacePlace {
  glm::dvec3 position{0.0};  // m, body
  Distance to_body;
};

SurfacePlace place_on_tool(const Model& model, const ContactPair& pair, const glm::dvec3& near) {
  const Range tool = model.tools.at<OwnedRows>(pair.tool).parts;
  glm::dvec3 place = to_inner(pair.tool_in_body, near);
  const Distance off_surface = signed_distance(model, tool, place);
  place -= off_surface.value * off_surface.gradient;
  const glm::dvec3 position = to_outer(pair.tool_in_body, place);
  return {position, signed_distance(model, model.bodies.at<OwnedRows>(pair.body).parts, position)};
}

/// Whether the tool's surface is inside the body all the way from one point of it to another, and
/// goes on as it began.
/// @param step  m, of the way
bool overlaps_between(const Model& model, const ContactPair& pair, const glm::dvec3& from,
                      const glm::dvec3& to, double step) {
  const double steps = std::ceil(glm::distance(from, to) / step);
  SurfacePlace last = place_on_tool(model, pair, from);
  for (double k = 1.0; k <= steps; k += 1.0) {
    const SurfacePlace next = place_on_tool(model, pair, glm::mix(from, to, k / steps));
    if ((k < steps && next.to_body.value >= 0.0) ||
        glm::distance(last.position, next.position) > 2.0 * step ||
        glm::dot(last.to_body.gradient, next.to_body.gradient) < kLeastAgreement) {
      return false;
    }
    last = next;
  }
  return true;
}

/// Links clusters between which the tool's surface is inside the body. Samples are sparse along a
/// line.
void link_through_overlap(const Model& model, const ContactPair& pair, const ClusterBoxes& boxes,
                          std::span<const ContactPoint> points, std::span<std::uint32_t> parent) {
  constexpr double kReach = 10.0;  // of the spacing of samples
  constexpr double kStep = 0.6;    // likewise
  const std::uint32_t first = model.tools.at<OwnedRows>(pair.tool).samples.first;
  const double spacing = model.samples.at<SurfaceSample>(first).spacing;
  for (std::uint32_t one = 0; boxes.has_all() && one < pair.clusters; ++one) {
    for (std::uint32_t other = one + 1; other < pair.clusters; ++other) {
      if (root_of(parent, one) == root_of(parent, other) ||
          !boxes.near(one, other, kReach * spacing)) {
        continue;
      }
      // Nearly the nearest two.
      glm::dvec3 from = nearest_of(one, points, nearest_of(other, points, points[0].position));
      const glm::dvec3 to = nearest_of(other, points, from);
      from = nearest_of(one, points, to);
      if (glm::distance(from, to) < kReach * spacing &&
          overlaps_between(model, pair, from, to, kStep * spacing)) {
        link(parent, one, other);
      }
    }
  }
}

}  // namespace

void join_clusters(const Model& model, const State& state, ContactScratch& scratch,
                   ContactPair& pair) {
  if (pair.clusters < 2) {
    return;
  }
  const std::span<ContactPoint> points(scratch.points.data() + pair.points.first,
                                       pair.points.count);
  const std::span<std::uint32_t> parent(scratch.parent.data(), pair.clusters);
  std::iota(parent.begin(), parent.end(), 0U);
  const ClusterBoxes boxes(points, pair.clusters);
  // As many clusters as there are regions are those that were apart in the last step. When they
  // grow together their cells tell.
  if (regions_of(state, pair) != pair.clusters) {
    link_through_overlap(model, pair, boxes, points, parent);
  }
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    // A region far from all clusters but one has nothing to join, and no near neighbour.
    if (is_of_pair(state.regions.at<RegionIdentity>(region), pair) &&
        boxes.near(state, region) > 1) {
      join_on(model, state, region, pair, points, parent);
    }
  }
  renumber(parent, scratch.order, points, pair);
}

bool touch(const Model& model, const State& state, std::uint32_t region, std::uint32_t other) {
  return covers_touch({model, state, region}, {model, state, other});
}

}  // namespace torsion::engine
