#include "systems/contact/group_regions.hpp"

#include <algorithm>
#include <cmath>

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/region_grid.hpp"
#include "systems/contact/region_wrenches.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/support/body_law.hpp"
#include "systems/math/frames.hpp"

namespace torsion::engine {
namespace {

constexpr auto kTakesOver = static_cast<std::uint32_t>(RegionEvent::kTakesOver);
constexpr auto kBodyFollows = static_cast<std::uint32_t>(RegionEvent::kBodyFollows);

/// The cells of a region that contact points lie on.
struct RegionCells {
  RegionCells(const Model& model, const State& state, std::uint32_t region)
      : finder(moved_grid_in_body(state.regions.at<RegionFrame>(region),
                                  state.regions.at<RegionCarrier>(region),
                                  state.regions.at<RegionSupport>(region)),
               state.regions.at<RegionFrame>(region).half_size, model.settings.grid_side),
        cells(state.cells.rows<CellGeometry>(state.regions.at<RegionIdentity>(region).cells)) {}

  /// Share of a point that lies over the region: 1 on its covered cells, a little on the other
  /// cells of its grid.
  [[nodiscard]] double overlap_with(const glm::dvec3& point) const {
    const auto cell = finder.under(point);
    if (!cell) {
      return 0.0;
    }
    return cells[cell->j * finder.side + cell->i].coverage > 0.0 ? 1.0 : 1e-2;
  }

  CellFinder finder;
  std::span<const CellGeometry> cells;
};

/// Ends a region. Another region, `heir`, may take over what it exerted.
void end_region(const Model& model, State& state, std::uint32_t region, std::uint32_t heir) {
  if (heir != kNoRow) {
    RegionWrench& wrench = state.regions.at<RegionWrench>(heir);
    const RegionWrench& ended = state.regions.at<RegionWrench>(region);
    wrench.on_tool.force += ended.on_tool.force;
    wrench.on_tool.torque += ended.on_tool.torque;
    wrench.event_now = kTakesOver;
    const ContactLaw& law = law_of(model, state.regions.at<RegionIdentity>(heir).body);
    if (law.end != nullptr) {
      law.end(state, region, heir);
    }
  }
}

/// Whether a region on the body took over in the last step.
bool any_took_over(const State& state, std::uint32_t body) {
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    if (state.regions.at<RegionIdentity>(region).body == body &&
        state.regions.at<RegionWrench>(region).event_now == kTakesOver) {
      return true;
    }
  }
  return false;
}

/// Clears the events of the last step. Where the body has compliance, its answer to a region that
/// took over another begins in the next step and moves all its regions. Of several answers that
/// follow each other within the fade, a waiting region waits for the first only: otherwise its
/// force would stand still.
void end_events(const Model& model, State& state) {
  for (std::uint32_t body = 0; body < model.bodies.size(); ++body) {
    const bool begins_to_follow =
        body_law_of(model, body).moves_as_a_whole && any_took_over(state, body);
    for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
      RegionWrench& wrench = state.regions.at<RegionWrench>(region);
      std::uint32_t& event = wrench.event_now;
      if (state.regions.at<RegionIdentity>(region).body != body) {
        continue;
      }
      if (begins_to_follow && (event == kTakesOver || wrench.event_share == 0.0)) {
        event = kBodyFollows;
      } else if (event >= kBodyFollows && event + 1 < kBodyFollows + kFollowingSteps) {
        event += 1;
      } else {
        event = static_cast<std::uint32_t>(RegionEvent::kNone);
      }
    }
  }
}

/// A block of cells that no region uses. There are as many blocks as rows, so where a row is free a
/// block is.
Range free_cells(const Model& model, const State& state) {
  const std::uint32_t side = model.settings.grid_side;
  const std::uint32_t count = side * side;
  for (std::uint32_t block = 0; block < state.regions.capacity(); ++block) {
    const Range cells{block * count, count};
    const auto uses = [&](const RegionIdentity& region) {
      return region.cells == cells;
    };
    if (std::ranges::none_of(state.regions.column<RegionIdentity>(), uses)) {
      return cells;
    }
  }
  return {};
}

std::uint32_t regions_on(const State& state, std::uint32_t body) {
  return static_cast<std::uint32_t>(
      std::ranges::count(state.regions.column<RegionIdentity>(), body, &RegionIdentity::body));
}

/// Begins a region where there was none, or one that splits off another.
/// @param split_from  kNoRow, or that one
void begin_region(StepContext& context, const ContactPair& pair, std::uint32_t cluster,
                  std::uint32_t split_from) {
  const Model& model = context.model;
  State& state = context.state;
  Clock& clock = state.clock;
  const std::uint32_t row = state.regions.size();
  const bool full =
      regions_on(state, pair.body) >= kMaxRegionsPerBody || row == state.regions.capacity();
  if (full) {
    raise(clock, Fault::kRegionsFull);
    return;
  }
  const Range cells = free_cells(model, state);
  const std::optional<Range> appended = state.regions.append();
  TORSION_ASSERT(appended.has_value());
  state.regions.at<RegionIdentity>(row) = {pair.body, pair.tool, clock.regions_formed, cells};
  clock.regions_formed += 1;
  std::ranges::fill(state.cells.rows<CellGeometry>(cells), CellGeometry{});
  std::ranges::fill(state.cells.rows<CellTraction>(cells), CellTraction{});
  const std::uint32_t block = block_of(state.regions.at<RegionIdentity>(row));
  if (!state.support_fits.empty()) {
    state.support_fits.at<SupportFit>(block) = SupportFit{};
  }
  const ContactLaw& law = law_of(model, pair.body);
  if (law.begin != nullptr) {
    law.begin(model, state, block);
  }
  place_new_grid(context, row, {pair.points, cluster});
  const BodyLaw& body = body_law_of(model, pair.body);
  if (split_from == kNoRow && body.begin != nullptr) {
    body.begin(model, state, row);
  }
  if (split_from != kNoRow && body.begin_split != nullptr) {
    body.begin_split(model, state, split_from, row);
  }
  if (split_from != kNoRow && law.split != nullptr) {
    law.split(state, split_from, row);
  }
  // on_tool stays zero: the force of a new region is faded in.
  state.regions.at<RegionWrench>(row).event_now = static_cast<std::uint32_t>(
      split_from != kNoRow ? RegionEvent::kTakesOver : RegionEvent::kBegins);
}

bool owns_cluster(const ContactScratch& scratch, std::uint32_t region) {
  return std::ranges::any_of(
      scratch.owners, [region](const ClusterOwner& owner) { return owner.region == region; });
}

/// A region continues in the cluster that it overlaps most. The oldest region chooses first, and no
/// other may take the same cluster.
void match_by_overlap(const Model& model, const State& state, ContactScratch& scratch,
                      const ContactPair& pair, std::span<const ContactPoint> points) {
  const auto regions = state.regions.column<RegionIdentity>();
  for (std::uint32_t region = 0; region < regions.size(); ++region) {
    if (!is_of_pair(regions[region], pair)) {
      continue;
    }
    scratch.overlaps.assign(pair.clusters, 0.0);
    const RegionCells cells(model, state, region);
    for (const ContactPoint& point : points) {
      scratch.overlaps[point.cluster] += cells.overlap_with(point.position);
      if (pair.clusters == 1 && scratch.overlaps[0] > 0.0) {
        break;  // there is nothing to choose
      }
    }
    const auto best = std::ranges::max_element(scratch.overlaps);
    if (best == scratch.overlaps.end() || *best <= 0.0) {
      continue;
    }
    ClusterOwner& owner = scratch.owners[static_cast<std::size_t>(best - scratch.overlaps.begin())];
    if (owner.region == kNoRow) {
      owner.region = region;
    }
  }
}

/// A small region may slide or roll farther than its own size in a step. Regions and clusters that
/// are left without a partner are matched if they are nearer than two separate regions can be.
void match_by_distance(const Model& model, const State& state, ContactScratch& scratch,
                       const ContactPair& pair, std::span<const ContactPoint> points) {
  const double threshold = model.bodies.at<BodyModels>(pair.body).region_threshold;
  const auto regions = state.regions.column<RegionIdentity>();
  for (std::uint32_t region = 0; region < regions.size(); ++region) {
    if (!is_of_pair(regions[region], pair) || owns_cluster(scratch, region)) {
      continue;
    }
    double nearest = threshold;
    std::uint32_t cluster = kNoRow;
    for (const ContactPoint& point : points) {
      const double distance =
          glm::distance(point.position, state.regions.at<Contact>(region).equivalent_point);
      if (scratch.owners[point.cluster].region == kNoRow && distance < nearest) {
        nearest = distance;
        cluster = point.cluster;
      }
    }
    if (cluster != kNoRow) {
      scratch.owners[cluster].region = region;
    }
  }
}

/// Fills scratch.owners: which region each cluster continues.
void match_clusters(const Model& model, const State& state, ContactScratch& scratch,
                    const ContactPair& pair, std::span<const ContactPoint> points) {
  scratch.owners.assign(pair.clusters, ClusterOwner{});
  match_by_overlap(model, state, scratch, pair, points);
  match_by_distance(model, state, scratch, pair, points);
}

/// The region that now owns the cluster at this region's old place, or kNoRow.
std::uint32_t heir_of(const Model& model, const State& state, const ContactScratch& scratch,
                      std::uint32_t region, std::span<const ContactPoint> points) {
  const RegionCells cells(model, state, region);
  for (const ContactPoint& point : points) {
    if (cells.overlap_with(point.position) >= 1.0) {
      return scratch.owners[point.cluster].region;
    }
  }
  return kNoRow;
}

/// A cluster without an owner that lies over a living region has split off that region, which is
/// then written to scratch.owners.
void note_splits(const Model& model, State& state, ContactScratch& scratch,
                 std::span<const ContactPoint> points) {
  for (const ContactPoint& point : points) {
    if (scratch.owners[point.cluster].region != kNoRow) {
      continue;
    }
    for (const ClusterOwner& owner : scratch.owners) {
      if (owner.region != kNoRow &&
          RegionCells(model, state, owner.region).overlap_with(point.position) >= 1.0) {
        state.regions.at<RegionWrench>(owner.region).event_now = kTakesOver;
        scratch.owners[point.cluster].split_from = owner.region;
      }
    }
  }
}

/// Whether a region's cells are to tell if its contact goes on, because the tool has no points at
/// all: they are few where a tool's samples are far apart, and are sought under the body's rest
/// shape, beside which friction may drag a deflected body until all of the tool's are, and other
/// tools push it. Where there are points, they decide which contacts exist.
bool lives_without_points(const State& state, const ContactPair& pair, std::uint32_t region) {
  return pair.points.count == 0 &&
         (pair.touches_moved || state.regions.at<RegionNormal>(region).force > 0.0);
}

/// The oldest region of the pair whose contact this one shares, or kNoRow: no points tell that, but
/// the cells of both.
std::uint32_t heir_by_cells(const Model& model, const State& state, const ContactScratch& scratch,
                            const ContactPair& pair, std::uint32_t region) {
  for (std::uint32_t other = 0; other < region; ++other) {
    if (is_of_pair(state.regions.at<RegionIdentity>(other), pair) &&
        std::ranges::find(scratch.ended_regions, other) == scratch.ended_regions.end() &&
        touch(model, state, region, other)) {
      return other;
    }
  }
  return kNoRow;
}

/// A region goes on without points, or ends in another one.
void go_on_without_points(StepContext& context, const ContactPair& pair, std::uint32_t region) {
  const Model& model = context.model;
  State& state = context.state;
  const std::uint32_t heir = heir_by_cells(model, state, context.scratch, pair, region);
  if (heir == kNoRow) {
    follow_contact(context, region, {pair.points, kNoRow});
    return;
  }
  end_region(model, state, region, heir);
  context.scratch.ended_regions.push_back(region);
  const ContactLaw& law = law_of(model, pair.body);
  if (law.join != nullptr) {
    law.join(context, region, heir);  // whose grid is where its contact is by now
  }
}

/// Regions that own no cluster go on without points, or end.
void end_or_go_on(StepContext& context, const ContactPair& pair,
                  std::span<const ContactPoint> points) {
  const Model& model = context.model;
  State& state = context.state;
  ContactScratch& scratch = context.scratch;
  const auto regions = state.regions.column<RegionIdentity>();
  for (std::uint32_t region = 0; region < regions.size(); ++region) {
    if (!is_of_pair(regions[region], pair) || owns_cluster(scratch, region)) {
      continue;
    }
    if (lives_without_points(state, pair, region)) {
      go_on_without_points(context, pair, region);
    } else {
      end_region(model, state, region, heir_of(model, state, scratch, region, points));
      scratch.ended_regions.push_back(region);
    }
  }
}

/// Regions whose cluster another region owns hand over what they hold.
void join_regions(StepContext& context, const ContactPair& pair,
                  std::span<const ContactPoint> points) {
  const Model& model = context.model;
  const State& state = context.state;
  const ContactLaw& law = law_of(model, pair.body);
  const auto regions = state.regions.column<RegionIdentity>();
  for (std::uint32_t region = 0; law.join != nullptr && region < regions.size(); ++region) {
    if (is_of_pair(regions[region], pair) && !owns_cluster(context.scratch, region)) {
      const std::uint32_t heir = heir_of(model, state, context.scratch, region, points);
      if (heir != kNoRow) {
        law.join(context, region, heir);
      }
    }
  }
}

/// Erases the rows of regions that have ended.
void erase_ended(State& state, ContactScratch& scratch) {
  // From the last to the first, because rows behind an erased one move up. They were noted in the
  // order of rows.
  for (; !scratch.ended_regions.empty(); scratch.ended_regions.pop_back()) {
    state.regions.erase(scratch.ended_regions.back());
  }
}

}  // namespace

void group_regions(StepContext& context) {
  const Model& model = context.model;
  State& state = context.state;
  ContactScratch& scratch = context.scratch;
  end_events(model, state);
  for (ContactPair& pair : scratch.pairs) {
    join_clusters(model, state, scratch, pair);
    const std::span<const ContactPoint> points(scratch.points.data() + pair.points.first,
                                               pair.points.count);
    match_clusters(model, state, scratch, pair, points);
    note_splits(model, state, scratch, points);
    end_or_go_on(context, pair, points);
    for (std::uint32_t cluster = 0; cluster < pair.clusters; ++cluster) {
      const std::uint32_t owner = scratch.owners[cluster].region;
      if (owner != kNoRow) {
        follow_contact(context, owner, {pair.points, cluster});
      }
    }
    join_regions(context, pair, points);
    for (std::uint32_t cluster = 0; cluster < pair.clusters; ++cluster) {
      const ClusterOwner& owner = scratch.owners[cluster];
      if (owner.region == kNoRow) {
        begin_region(context, pair, cluster, owner.split_from);
      }
    }
    erase_ended(state, scratch);
  }
}

}  // namespace torsion::engine
