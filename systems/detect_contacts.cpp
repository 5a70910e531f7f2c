#include "systems/detect_contacts.hpp"

#include <algorithm>
#include <array>

#include <glm/gtc/quaternion.hpp>

#include "systems/fault.hpp"
#include "systems/frames.hpp"
#include "systems/group_points.hpp"
#include "systems/scratch.hpp"

namespace torsion {
namespace {

constexpr int kDescentSteps = 24;
constexpr double kSmallestStep =
    1e-3;  // of the sample spacing: finer does not change the depth by a micrometre

/// One tool over one body while it is searched.
struct Search {
  const World& world;
  Scratch& scratch;
  Range body_parts;
  OwnedRows tool;
  Pose tool_in_body;
};

/// Leaves of the tree whose distances are asked for together.
struct LeafBlock {
  static constexpr std::size_t kLeaves = 64;
  std::array<std::uint32_t, kLeaves> balls;
  std::array<glm::dvec3, kLeaves> points;  // m, body
  std::array<Distance, kLeaves> distances;
  std::size_t count = 0;
};

/// Takes the samples whose ball reaches into the body. Empties the block.
void take_leaves(Search& search, LeafBlock& block) {
  Scratch& scratch = search.scratch;
  signed_distances(search.world, search.body_parts, std::span(block.points).first(block.count),
                   std::span(block.distances).first(block.count));
  for (std::size_t i = 0; i < block.count; ++i) {
    const SurfaceBall& ball =
        search.world.balls.at<SurfaceBall>(search.tool.balls.first + block.balls[i]);
    const double distance = block.distances[i].value;
    if (distance <= ball.radius) {
      const std::uint32_t sample = search.tool.samples.first + ball.sample;
      scratch.sample_distance[sample] = distance;
      scratch.sample_stamp[sample] = scratch.stamp;
      scratch.sample_point[sample] = kNoRow;
      scratch.candidates.push_back({sample, distance});
    }
  }
  block.count = 0;
}

/// Walks the tool's tree of balls: keeps the samples whose ball reaches into the body. The distance
/// is at least |distance| in every part, so a ball farther away than its radius holds no contact.
void find_candidates(Search& search) {
  const auto balls = search.world.balls.rows<SurfaceBall>(search.tool.balls);
  const auto samples = search.world.samples.rows<SurfaceSample>(search.tool.samples);
  search.scratch.candidates.clear();
  search.scratch.stamp += 1;
  const glm::dmat3 turn = glm::mat3_cast(search.tool_in_body.rotation);
  const auto in_body = [&](const glm::dvec3& point) {
    return turn * point + search.tool_in_body.position;
  };
  LeafBlock block;
  for (std::uint32_t row = 0; row < balls.size();) {
    const SurfaceBall& ball = balls[row];
    if (ball.sample != kNoRow) {
      block.balls[block.count] = row;
      block.points[block.count] = in_body(samples[ball.sample].position);
      block.count += 1;
      if (block.count == LeafBlock::kLeaves) {
        take_leaves(search, block);
      }
      row += 1;
    } else {
      const double distance =
          signed_distance(search.world, search.body_parts, in_body(ball.center)).value;
      row = distance > ball.radius ? ball.skip : row + 1;
    }
  }
  take_leaves(search, block);
}

/// Lowest among its neighbours; between equals the first. A neighbour that was not reached is
/// farther away.
bool is_local_minimum(const Search& search, const Candidate& candidate) {
  const SurfaceSample& sample = search.world.samples.at<SurfaceSample>(candidate.sample);
  for (const std::uint32_t neighbour : sample.neighbours) {
    const std::uint32_t row = search.tool.samples.first + neighbour;
    if (neighbour == kNoRow || search.scratch.sample_stamp[row] != search.scratch.stamp) {
      continue;
    }
    const double distance = search.scratch.sample_distance[row];
    if (distance < candidate.distance ||
        (distance == candidate.distance && row < candidate.sample)) {
      return false;
    }
  }
  return true;
}

/// Slides a point on the tool's surface towards the body, with step halving.
/// @return the point, m, body, and its distance to the body
ContactPoint descend(const Search& search, const Candidate& start) {
  const SurfaceSample& sample = search.world.samples.at<SurfaceSample>(start.sample);
  const Pose& pose = search.tool_in_body;
  glm::dvec3 point = sample.position;  // tool frame
  Distance to_body = signed_distance(search.world, search.body_parts, to_outer(pose, point));
  double step = 0.5 * sample.spacing;
  for (int iteration = 0; iteration < kDescentSteps && step > kSmallestStep * sample.spacing;
       ++iteration) {
    const glm::dvec3 normal = signed_distance(search.world, search.tool.parts, point).gradient;
    const glm::dvec3 uphill = glm::conjugate(pose.rotation) * to_body.gradient;
    const glm::dvec3 along = uphill - normal * glm::dot(uphill, normal);
    const double slope = glm::length(along);
    if (slope < 1e-9) {
      break;
    }
    glm::dvec3 trial = point - along * (step / slope);
    const Distance off_surface = signed_distance(search.world, search.tool.parts, trial);
    trial -= off_surface.gradient * off_surface.value;
    const Distance trial_distance =
        signed_distance(search.world, search.body_parts, to_outer(pose, trial));
    if (trial_distance.value < to_body.value) {
      point = trial;
      to_body = trial_distance;
    } else {
      step *= 0.5;
    }
  }
  return {to_outer(pose, point), -to_body.value, 0};
}

void add_point(Scratch& scratch, std::uint32_t sample, const ContactPoint& point) {
  if (scratch.points.size() < scratch.points.capacity()) {
    scratch.sample_point[sample] = static_cast<std::uint32_t>(scratch.points.size());
    scratch.points.push_back(point);
  }
}

/// Pairs of contact points whose samples are neighbours, with rows counted from `first`.
void pair_neighbours(const Search& search, std::uint32_t first) {
  Scratch& scratch = search.scratch;
  for (const Candidate& candidate : scratch.candidates) {
    const std::uint32_t point = scratch.sample_point[candidate.sample];
    if (point == kNoRow) {
      continue;
    }
    const SurfaceSample& sample = search.world.samples.at<SurfaceSample>(candidate.sample);
    for (const std::uint32_t neighbour : sample.neighbours) {
      const std::uint32_t row = search.tool.samples.first + neighbour;
      if (neighbour != kNoRow && scratch.sample_stamp[row] == scratch.stamp &&
          scratch.sample_point[row] != kNoRow) {
        scratch.near_pairs.push_back({point - first, scratch.sample_point[row] - first});
      }
    }
  }
}

/// Deeper than half of the body, or with half of the tool's surface inside it, no side is "out" any
/// more.
bool too_deep(const Search& search, const Bounds& bounds, std::span<const ContactPoint> points) {
  const glm::dvec3 size = bounds.highest - bounds.lowest;
  const double deepest = 0.5 * std::min({size.x, size.y, size.z});
  const auto beyond = [deepest](const ContactPoint& point) {
    return point.depth >= deepest;
  };
  return 2 * points.size() > search.tool.samples.count || std::ranges::any_of(points, beyond);
}

void find_points(Search& search) {
  find_candidates(search);
  Scratch& scratch = search.scratch;
  for (const Candidate& candidate : scratch.candidates) {
    if (candidate.distance < 0.0) {
      const glm::dvec3& position =
          search.world.samples.at<SurfaceSample>(candidate.sample).position;
      add_point(scratch, candidate.sample,
                {to_outer(search.tool_in_body, position), -candidate.distance, 0});
    } else if (is_local_minimum(search, candidate)) {
      const ContactPoint lowest = descend(search, candidate);
      if (lowest.depth > 0.0) {
        add_point(scratch, candidate.sample, lowest);
      }
    }
  }
}

}  // namespace

void detect_contacts(StepContext& context) {
  World& world = context.world;
  Scratch& scratch = context.scratch;
  scratch.points.clear();
  scratch.near_pairs.clear();
  scratch.pairs.clear();
  for (std::uint32_t tool = 0; tool < world.tools.size(); ++tool) {
    for (std::uint32_t body = 0; body < world.bodies.size(); ++body) {
      const auto first = static_cast<std::uint32_t>(scratch.points.size());
      Search search{world, scratch, world.bodies.at<OwnedRows>(body).parts,
                    world.tools.at<OwnedRows>(tool),
                    relative(world.bodies.at<Pose>(body), world.tools.at<ToolPose>(tool).now)};
      find_points(search);
      const Range points{first, static_cast<std::uint32_t>(scratch.points.size()) - first};
      const auto first_near = static_cast<std::uint32_t>(scratch.near_pairs.size());
      pair_neighbours(search, first);
      const Range near{first_near,
                       static_cast<std::uint32_t>(scratch.near_pairs.size()) - first_near};
      scratch.pairs.push_back({tool, body, points, near, 0});
      if (too_deep(search, world.bodies.at<Bounds>(body),
                   {scratch.points.data() + first, points.count})) {
        raise(world.clock.at<Clock>(0), Fault::kTooDeep);
      }
    }
  }
}

void group_contact_points(StepContext& context) {
  Scratch& scratch = context.scratch;
  for (ContactPair& pair : scratch.pairs) {
    const std::span<ContactPoint> points(scratch.points.data() + pair.points.first,
                                         pair.points.count);
    scratch.cluster_points.clear();
    for (const ContactPoint& point : points) {
      scratch.cluster_points.push_back(point.position);
    }
    const std::span<std::uint32_t> order(scratch.order);
    const std::span<std::uint32_t> groups = order.subspan(order.size() / 2);
    const double threshold = context.world.bodies.at<BodyModels>(pair.body).region_threshold;
    const std::span<const NearPair> near(scratch.near_pairs.data() + pair.near.first,
                                         pair.near.count);
    pair.clusters = group_points(scratch.cluster_points, near, threshold,
                                 order.first(order.size() / 2), scratch.parent, groups);
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i].cluster = groups[i];
    }
  }
}

}  // namespace torsion
