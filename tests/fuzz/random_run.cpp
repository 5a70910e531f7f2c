#include "tests/fuzz/random_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "systems/contact/strain.hpp"
#include "systems/geometry/distance.hpp"
#include "systems/math/frames.hpp"
#include "systems/scratch.hpp"

namespace torsion::engine::test {
namespace {

/// From 0 to 1 with no jump of speed or acceleration.
double smooth(double share) {
  const double t = std::clamp(share, 0.0, 1.0);
  return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

/// How far each part of the way is gone at a step.
struct Progress {
  double press = 0.0;
  double move = 0.0;
  double away = 0.0;
};

/// @param hold  steps for which the tools are held still
Progress progress_at(double step, int hold) {
  const auto done = [step](int begin, int steps) {
    return smooth((step - begin) / steps);
  };
  const int back = kHeld + hold;
  const int lift = back + kMove;
  return {done(kCome, kPress) - done(lift, kPress), done(kCome + kPress, kMove) - done(back, kMove),
          1.0 - done(0, kCome) + done(lift + kPress, kCome)};
}

int all_steps(int hold) {
  return kHeld + hold + kMove + kPress + kCome;
}

Pose in_axes(const RandomWay& way, const Pose& pose) {
  return {way.axes * pose.position, way.axes * pose.rotation};
}

/// Height of a tool's frame at which its surface samples just touch the body, m: what lies between
/// them touches a little earlier. By bisection.
double touching_height(const World& world, std::uint32_t tool, const RandomWay& way, double size) {
  const Range parts = world.model.bodies.at<OwnedRows>(0).parts;
  const auto samples =
      world.model.samples.rows<SurfaceSample>(world.model.tools.at<OwnedRows>(tool).samples);
  const auto inside = [&](double height) {
    const Pose pose = in_axes(way, {{way.beside.x, height, way.beside.y}, way.rotation});
    return std::ranges::any_of(samples, [&](const SurfaceSample& sample) {
      return signed_distance(world.model, parts, to_outer(pose, sample.position)).value < 0.0;
    });
  };
  double low = -0.5 * size;
  double high = 3.0 * size;
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (low + high);
    (inside(middle) ? low : high) = middle;
  }
  return high;
}

Pose pose_at(const RandomWay& way, double touching, double size, const Progress& progress) {
  const double clear = 1e-3 * way.depth;
  const double height =
      touching + clear - (way.depth + clear) * progress.press + 0.02 * size * progress.away;
  const glm::dvec2 beside = way.beside + way.slide * progress.move;
  const glm::dquat turn = glm::angleAxis(way.turn * progress.move, glm::dvec3(0.0, 1.0, 0.0));
  return in_axes(way, {{beside.x, height, beside.y}, turn * way.rotation});
}

/// Whether a tool that is pressed lies beside its body's rest shape with all points: friction has
/// dragged the body after it.
bool only_drags(const Simulation& simulation, std::uint32_t tool) {
  const auto touches = [tool](const ContactPair& pair) {
    return pair.tool == tool && pair.points.count > 0;
  };
  return std::ranges::none_of(simulation.scratch->contact.pairs, touches) &&
         simulation.world.state.tools.at<ToolWrench>(tool).total.force != glm::dvec3(0.0);
}

/// Whether a region is on a side of the body as its tool sees it, which comes down on it.
/// @param ways  of the tools, in the body's axes
bool meets_a_side(const World& world, std::span<const RandomWay> ways) {
  constexpr double kUpwards = 0.4;
  for (std::uint32_t region = 0; region < world.state.regions.size(); ++region) {
    const RandomWay& way = ways[world.state.regions.at<RegionIdentity>(region).tool];
    const glm::dvec3 up = way.axes * glm::dvec3(0.0, 1.0, 0.0);
    if (glm::dot(world.state.regions.at<RegionFrame>(region).normal, up) < kUpwards) {
      return true;
    }
  }
  return false;
}

/// Adds what a step's regions say of themselves.
void look_at_regions(const World& world, int step, Run& run) {
  constexpr double kUnsolved = 0.1;
  // Of the normal force: what a step may owe its energy (patch/energy.cpp), 2 % of it in a round
  // contact; a long one turns more easily for its radius.
  constexpr double kDrag = 0.05;
  double residual = 0.0;
  bool pressed = false;
  bool strained = false;
  for (std::uint32_t region = 0; region < world.state.regions.size(); ++region) {
    const double force = world.state.regions.at<RegionNormal>(region).force;
    if (force <= 0.0) {
      continue;
    }
    const Friction& friction =
        world.model.bodies.at<Friction>(world.state.regions.at<RegionIdentity>(region).body);
    const double most = std::max(friction.static_friction, friction.dynamic_friction) + kDrag;
    const double share = glm::length(world.state.regions.at<RegionFriction>(region).force) /
                         std::max(most * force, std::numeric_limits<double>::min());
    if (share > run.friction) {
      run.friction = share;
      run.friction_step = step;
    }
    pressed = true;
    strained = strained || traction_over_modulus(world.model, world.state, region) > kLargeTraction;
    residual = std::max(residual, world.state.regions.at<PatchState>(region).residual);
  }
  run.pressed += pressed ? 1 : 0;
  run.unsolved += residual > kUnsolved ? 1 : 0;
  run.strained += strained ? 1 : 0;
}

// Steps for which a contact that a tool lifts off from may be without points: its body answers
// late.
constexpr int kLate = 5;

/// What events have done to a force fades in 10 ms (region_wrenches.cpp).
int hold_steps(double rate) {
  return std::max(60, static_cast<int>(std::ceil(0.012 * rate))) + kStill;
}

/// The rate, or a lower one at which no step is half a jump (tool_motion.cpp).
double slow_enough_rate(const std::vector<std::vector<Pose>>& poses, double rate) {
  constexpr double kSpeed = 10.0;       // m/s
  constexpr double kTurnSpeed = 250.0;  // rad/s
  for (std::size_t step = 1; step < poses.size(); ++step) {
    for (std::size_t tool = 0; tool < poses[step].size(); ++tool) {
      const Pose& from = poses[step - 1][tool];
      const Pose& to = poses[step][tool];
      const double turn =
          2.0 * std::acos(std::min(1.0, std::abs(glm::dot(from.rotation, to.rotation))));
      rate = std::min(rate, kSpeed / std::max(glm::distance(from.position, to.position), 1e-300));
      rate = std::min(rate, kTurnSpeed / std::max(turn, 1e-300));
    }
  }
  return rate;
}

}  // namespace

std::vector<std::vector<Pose>> poses_of(const RandomScene& random, const World& world, int hold,
                                        int parts) {
  std::vector<double> heights;
  for (std::uint32_t tool = 0; tool < random.ways.size(); ++tool) {
    heights.push_back(touching_height(world, tool, random.ways[tool], random.size));
  }
  std::vector<std::vector<Pose>> poses;
  for (int step = 0; step <= parts * all_steps(hold); ++step) {
    const Progress progress = progress_at(static_cast<double>(step) / parts, hold);
    std::vector<Pose>& now = poses.emplace_back();
    for (std::size_t tool = 0; tool < random.ways.size(); ++tool) {
      now.push_back(pose_at(random.ways[tool], heights[tool], random.size, progress));
    }
  }
  return poses;
}

std::optional<Journey> journey_of(const RandomScene& random) {
  const Result<Simulation> simulation = prepare(random.scene, random.options);
  if (!simulation) {
    return std::nullopt;
  }
  Journey journey{random, hold_steps(random.options.rate), {}};
  journey.poses = poses_of(random, simulation.value().world, journey.hold);
  journey.scene.options.rate = slow_enough_rate(journey.poses, random.options.rate);
  return journey;
}

Run run(Simulation& simulation, std::span<const RandomWay> ways,
        const std::vector<std::vector<Pose>>& poses) {
  Run run;
  const World& world = simulation.world;
  run.forces.resize(world.model.tools.size());
  run.torques.resize(world.model.tools.size());
  run.let_go.resize(world.model.tools.size());
  std::vector<int> dragged(world.model.tools.size(), 0);
  for (std::size_t index = 0; index < poses.size(); ++index) {
    step(simulation, poses[index]);
    double work = 0.0;
    for (std::uint32_t tool = 0; tool < world.model.tools.size(); ++tool) {
      const ToolWrench& wrench = world.state.tools.at<ToolWrench>(tool);
      run.forces[tool].push_back(wrench.total.force);
      run.torques[tool].push_back(wrench.total.torque);
      work += wrench.work;
      if (only_drags(simulation, tool)) {
        dragged[tool] += 1;
      } else {
        if (dragged[tool] > kLate) {
          run.let_go[tool].push_back(index);
        }
        dragged[tool] = 0;
      }
    }
    run.work.push_back(work);
    run.into_a_side = run.into_a_side || meets_a_side(world, ways);
    look_at_regions(world, static_cast<int>(index), run);
    const std::uint32_t faults = world.state.clock.faults;
    run.fault_step = faults != 0 && run.faults == 0 ? static_cast<int>(index) : run.fault_step;
    run.faults |= faults;
  }
  return run;
}

}  // namespace torsion::engine::test
