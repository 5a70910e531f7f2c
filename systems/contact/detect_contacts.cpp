#include "systems/contact/detect_contacts.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "systems/contact/group_points.hpp"
#include "systems/contact/moved_surface.hpp"
#include "systems/contact/region_wrenches.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/math/disjoint_sets.hpp"
#include "systems/math/frames.hpp"

namespace torsion::engine {
namespace {

constexpr int kDescentSteps = 48;
constexpr int kMostMissed = 2;  // at a corner of the tool no way along a kink goes down
constexpr double kSmallestStep =
    1e-3;  // of the sample spacing: finer does not change the depth by a micrometre
constexpr double kAlongKink = 0.05;  // of the slope beside a kink: below it the point is a minimum

/// One tool over one body while it is searched.
struct ContactSearch {
  const Model& model;
  ContactScratch& scratch;
  Range body_parts;
  OwnedRows tool;
  Pose tool_in_body;
};

/// Balls of the tree whose distances are asked for together: as many as a few vectors hold.
struct BallBlock {
  static constexpr std::size_t kBalls = 64;
  alignas(64) std::array<double, kBalls> x, y, z;   // m, tool
  alignas(64) std::array<double, kBalls> distance;  // m, to the body
};

/// Marks the samples whose ball reaches into the body, and lists the balls of the level below that
/// have to be tested.
/// @param rows  of the tool's balls, at most BallBlock::kBalls of them
void look_at(ContactSearch& search, std::span<const SurfaceBall> balls,
             std::span<const std::uint32_t> rows, BallBlock& block) {
  ContactScratch& scratch = search.scratch;
  const std::size_t count = rows.size();
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3& center = balls[rows[i]].center;
    block.x[i] = center.x;
    block.y[i] = center.y;
    block.z[i] = center.z;
  }
  const auto front = [count](std::array<double, BallBlock::kBalls>& column) {
    return std::span(column).first(count);
  };
  distance_values(search.model, search.body_parts, search.tool_in_body,
                  {front(block.x), front(block.y), front(block.z)}, front(block.distance));
  for (std::size_t i = 0; i < count; ++i) {
    const SurfaceBall& ball = balls[rows[i]];
    const double distance = block.distance[i];
    if (ball.sample == kNoRow) {
      // Written so that a distance that is NaN is searched further and found by the check for
      // faults.
      const std::uint32_t end = distance > ball.radius ? 0 : ball.skip;
      for (std::uint32_t below = rows[i] + 1; below < end; below = balls[below].skip) {
        scratch.walk.push_back(below);
      }
    } else if (distance <= ball.radius) {
      scratch.found_samples[ball.sample / 64] |= std::uint64_t{1} << (ball.sample % 64);
      scratch.sample_states[search.tool.samples.first + ball.sample].distance = distance;
    }
  }
}

/// Walks the tool's tree of balls, level by level, and keeps the samples whose ball reaches into
/// the body, in the order of the samples. The body's nearest point is at least |distance| away, so
/// a ball with a smaller radius than that has no contact.
void find_candidates(ContactSearch& search) {
  ContactScratch& scratch = search.scratch;
  const auto balls = search.model.balls.rows<SurfaceBall>(search.tool.balls);
  scratch.candidates.clear();
  scratch.walk.clear();
  scratch.stamp += 1;
  const std::span<std::uint64_t> found =
      std::span(scratch.found_samples).first((search.tool.samples.count + 63) / 64);
  std::ranges::fill(found, 0);
  if (!balls.empty()) {
    scratch.walk.push_back(0);
  }
  BallBlock block;
  for (std::size_t first = 0; first < scratch.walk.size();) {
    const std::size_t count = std::min(BallBlock::kBalls, scratch.walk.size() - first);
    look_at(search, balls, std::span(scratch.walk).subspan(first, count), block);
    first += count;
  }
  for (std::size_t word = 0; word < found.size(); ++word) {
    for (std::uint64_t bits = found[word]; bits != 0; bits &= bits - 1) {
      const auto sample = search.tool.samples.first + static_cast<std::uint32_t>(word * 64) +
                          static_cast<std::uint32_t>(std::countr_zero(bits));
      SampleState& state = scratch.sample_states[sample];
      state.stamp = scratch.stamp;
      state.point = kNoRow;
      scratch.candidates.push_back({sample, state.distance});
    }
  }
}

/// Whether no neighbouring sample is deeper; of equally deep ones the first counts. A neighbour
/// that the search did not reach is farther away from the body.
bool is_local_minimum(const ContactSearch& search, const Candidate& candidate) {
  const SurfaceSample& sample = search.model.samples.at<SurfaceSample>(candidate.sample);
  for (const std::uint32_t neighbour : sample.neighbours) {
    if (neighbour == kNoRow) {
      continue;
    }
    const std::uint32_t row = search.tool.samples.first + neighbour;
    const SampleState& state = search.scratch.sample_states[row];
    if (state.stamp == search.scratch.stamp &&
        (state.distance < candidate.distance ||
         (state.distance == candidate.distance && row < candidate.sample))) {
      return false;
    }
  }
  return true;
}

/// Whether no neighbour of a sample is in contact.
bool stands_alone(const ContactSearch& search, const Candidate& candidate) {
  const SurfaceSample& sample = search.model.samples.at<SurfaceSample>(candidate.sample);
  return std::ranges::none_of(sample.neighbours, [&search](std::uint32_t neighbour) {
    if (neighbour == kNoRow) {
      return false;
    }
    const SampleState& state = search.scratch.sample_states[search.tool.samples.first + neighbour];
    return state.stamp == search.scratch.stamp && state.distance < 0.0;
  });
}

/// A point of the tool's surface, and what the body's distance is there.
struct SurfacePoint {
  glm::dvec3 position;  // m, tool
  double distance;      // m, to the body
  glm::dvec3 gradient;  // of that, tool
};

SurfacePoint surface_point(const ContactSearch& search, const glm::dvec3& position) {
  const Pose& pose = search.tool_in_body;
  const Distance to_body =
      signed_distance(search.model, search.body_parts, to_outer(pose, position));
  return {position, to_body.value, glm::conjugate(pose.rotation) * to_body.gradient};
}

/// The gradient along the tool's surface.
glm::dvec3 gradient_along(const ContactSearch& search, const SurfacePoint& point) {
  const glm::dvec3 normal =
      signed_distance(search.model, search.tool.parts, point.position).gradient;
  return point.gradient - normal * glm::dot(point.gradient, normal);
}

/// The shortest vector that ends between the ends of two. Where two gradients meet at a kink, a
/// function decreases against it on both sides; steepest descent ends there (Wolfe, Math. Program.
/// Study 3 (1975) 145).
glm::dvec3 shortest_between(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 way = b - a;
  const double square = glm::dot(way, way);
  const double share = square > 0.0 ? glm::clamp(-glm::dot(a, way) / square, 0.0, 1.0) : 0.0;
  return a + share * way;
}

/// Slides a point on the tool's surface towards the body, with step halving. At an edge of the body
/// it goes on along that.
/// @return the point, m, body, and its distance to the body
ContactPoint descend(const ContactSearch& search, const Candidate& start) {
  const SurfaceSample& sample = search.model.samples.at<SurfaceSample>(start.sample);
  SurfacePoint point = surface_point(search, sample.position);
  glm::dvec3 steepest = gradient_along(search, point);
  glm::dvec3 uphill = steepest;
  bool bent = false;  // whether the way is not the steepest, but goes along a kink
  int missed = 0;     // such ways from this point that did not go down
  double step = 0.5 * sample.spacing;
  for (int iteration = 0; iteration < kDescentSteps && step > kSmallestStep * sample.spacing;
       ++iteration) {
    const double slope = glm::length(uphill);
    if (slope < 1e-9) {
      break;
    }
    glm::dvec3 place = point.position - uphill * (step / slope);
    const Distance off_surface = signed_distance(search.model, search.tool.parts, place);
    place -= off_surface.gradient * off_surface.value;
    const SurfacePoint trial = surface_point(search, place);
    if (trial.distance < point.distance) {
      point = trial;
      steepest = gradient_along(search, point);
      uphill = steepest;
      bent = false;
      missed = 0;
      continue;
    }
    missed += bent ? 1 : 0;
    if (!bent && missed < kMostMissed) {
      // Downhill from here is uphill from there: a minimum lies between, or a kink to go along.
      uphill = shortest_between(steepest, gradient_along(search, trial));
      if (glm::length(uphill) >= kAlongKink * slope) {
        bent = true;
        continue;
      }
    }
    step *= 0.5;
    uphill = steepest;
    bent = false;
  }
  return {to_outer(search.tool_in_body, point.position), -point.distance, 0};
}

void add_point(ContactScratch& scratch, std::uint32_t sample, const ContactPoint& point) {
  if (scratch.points.size() < scratch.points.capacity()) {
    scratch.sample_states[sample].point = static_cast<std::uint32_t>(scratch.points.size());
    scratch.points.push_back(point);
  }
}

/// Links the points of one sample with those of its neighbours that come before it, or after it, in
/// the order of samples.
void link_neighbours(const ContactSearch& search, std::uint32_t row, std::uint32_t first,
                     double threshold, bool after, PointLinks& links) {
  const ContactScratch& scratch = search.scratch;
  const std::uint32_t point = scratch.sample_states[row].point;
  for (const std::uint32_t neighbour : search.model.samples.at<SurfaceSample>(row).neighbours) {
    if (neighbour == kNoRow || (search.tool.samples.first + neighbour > row) != after) {
      continue;
    }
    const SampleState& state = scratch.sample_states[search.tool.samples.first + neighbour];
    if (state.stamp != scratch.stamp || state.point == kNoRow ||
        links.parent[state.point - first] == links.parent[point - first]) {
      continue;
    }
    const glm::dvec3 gap = scratch.points[state.point].position - scratch.points[point].position;
    if (glm::dot(gap, gap) < threshold * threshold &&
        link(links.parent, state.point - first, point - first)) {
      links.sets -= 1;
    }
  }
}

/// Links points of neighbouring samples that are closer than `threshold`, until all are one set.
/// Neighbourhood is mutual as a rule, so that the neighbours before each sample mostly do.
/// @param first  of the points
/// @return how many sets are left
std::uint32_t link_points(const ContactSearch& search, std::uint32_t first, double threshold) {
  ContactScratch& scratch = search.scratch;
  PointLinks links =
      no_links(std::span(scratch.parent).subspan(first, scratch.points.size() - first));
  for (const bool after : {false, true}) {
    for (const Candidate& candidate : scratch.candidates) {
      if (links.sets <= 1) {
        return links.sets;
      }
      if (scratch.sample_states[candidate.sample].point != kNoRow) {
        link_neighbours(search, candidate.sample, first, threshold, after, links);
      }
    }
  }
  return links.sets;
}

/// When the tool is deeper than half of the body, or half of its surface is inside, the nearest
/// point of the body's surface no longer says on which side the tool came in.
bool too_deep(const ContactSearch& search, const Bounds& bounds,
              std::span<const ContactPoint> points) {
  const glm::dvec3 size = bounds.highest - bounds.lowest;
  const double deepest = 0.5 * std::min({size.x, size.y, size.z});
  const auto beyond = [deepest](const ContactPoint& point) {
    return point.depth >= deepest;
  };
  return 2 * points.size() > search.tool.samples.count || std::ranges::any_of(points, beyond);
}

void find_points(ContactSearch& search) {
  find_candidates(search);
  ContactScratch& scratch = search.scratch;
  for (const Candidate& candidate : scratch.candidates) {
    // A single sample in contact is represented by the lowest point near it, and so is one beside a
    // contact. So the force does not jump where the sample comes into contact, and two samples that
    // are not neighbours, at the rim of the same contact, meet at its bottom instead of making two
    // contacts.
    const bool inside = candidate.distance < 0.0;
    if (inside && !stands_alone(search, candidate)) {
      const glm::dvec3& position =
          search.model.samples.at<SurfaceSample>(candidate.sample).position;
      add_point(scratch, candidate.sample,
                {to_outer(search.tool_in_body, position), -candidate.distance, 0});
    } else if (inside || is_local_minimum(search, candidate)) {
      const ContactPoint lowest = descend(search, candidate);
      if (lowest.depth > 0.0) {
        add_point(scratch, candidate.sample, lowest);
      }
    }
  }
}

bool has_region(const State& state, std::uint32_t tool, std::uint32_t body) {
  return std::ranges::any_of(state.regions.column<RegionIdentity>(),
                             [tool, body](const RegionIdentity& region) {
                               return region.tool == tool && region.body == body;
                             });
}

/// A tool's first contact is sought where the material is. One that has regions is seen by each of
/// them from its own material; only where it has left the rest shape is it asked whether it would
/// touch the material as the other tools have it.
/// @param search  its pose may be changed
/// @return whether it would
bool find_points_of_pair(const StepContext& context, std::uint32_t tool, std::uint32_t body,
                         ContactSearch& search) {
  ContactScratch& scratch = search.scratch;
  const Pose at_rest = search.tool_in_body;
  const auto moved = [&] {
    return seen_from_moved_surface(context, tool, body, at_rest);
  };
  if (!has_region(context.state, tool, body)) {
    search.tool_in_body = moved().value_or(at_rest);
    find_points(search);
    return false;
  }
  const std::size_t before = scratch.points.size();
  find_points(search);
  const std::optional<Pose> pose = scratch.points.size() > before ? std::nullopt : moved();
  if (!pose) {
    return false;
  }
  search.tool_in_body = *pose;
  find_points(search);
  const bool touches = scratch.points.size() > before;
  // They are where the material was at rest, and its regions are not.
  scratch.points.resize(before);
  for (const Candidate& candidate : scratch.candidates) {
    scratch.sample_states[candidate.sample].point = kNoRow;
  }
  return touches;
}

}  // namespace

void detect_contacts(StepContext& context) {
  const Model& model = context.model;
  State& state = context.state;
  ContactScratch& scratch = context.scratch;
  scratch.points.clear();
  scratch.pairs.clear();
  for (std::uint32_t tool = 0; tool < model.tools.size(); ++tool) {
    for (std::uint32_t body = 0; body < model.bodies.size(); ++body) {
      const auto first = static_cast<std::uint32_t>(scratch.points.size());
      ContactSearch search{
          model, scratch, model.bodies.at<OwnedRows>(body).parts, model.tools.at<OwnedRows>(tool),
          relative(state.bodies.at<BodyPose>(body).now, state.tools.at<ToolPose>(tool).now)};
      const bool touches_moved = find_points_of_pair(context, tool, body, search);
      const Range points{first, static_cast<std::uint32_t>(scratch.points.size()) - first};
      const std::uint32_t sets =
          link_points(search, first, model.bodies.at<BodyModels>(body).region_threshold);
      scratch.pairs.push_back({tool, body, points, sets, search.tool_in_body, touches_moved});
      if (too_deep(search, model.bodies.at<Bounds>(body),
                   {scratch.points.data() + first, points.count})) {
        raise(state.clock, Fault::kTooDeep);
      }
    }
  }
}

}  // namespace torsion::engine
