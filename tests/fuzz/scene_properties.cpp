#include "tests/fuzz/scene_properties.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "systems/contact/region_wrenches.hpp"
#include "systems/geometry/distance.hpp"
#include "systems/math/frames.hpp"
#include "systems/scratch.hpp"
#include "tests/support/standout.hpp"

namespace torsion::engine::test {
namespace {

// Steps. Slow enough that ten of them are a small part of every motion.
constexpr int kCome = 60;
constexpr int kPress = 150;
constexpr int kMove = 150;
constexpr int kHeld = kCome + kPress + kMove;  // from here on it is held still
constexpr int kStill = 20;                     // steps at the end of that in which nothing changes

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
Progress progress_at(int step, int hold) {
  const auto done = [step](int begin, int steps) {
    return smooth(static_cast<double>(step - begin) / steps);
  };
  const int back = kHeld + hold;
  const int lift = back + kMove;
  return {done(kCome, kPress) - done(lift, kPress), done(kCome + kPress, kMove) - done(back, kMove),
          1.0 - done(0, kCome) + done(lift + kPress, kCome)};
}

int all_steps(int hold) {
  return kHeld + hold + kMove + kPress + kCome;
}

/// What events have done to a force fades in 10 ms (region_wrenches.cpp).
int hold_steps(double rate) {
  return std::max(60, static_cast<int>(std::ceil(0.012 * rate))) + kStill;
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

/// The poses of all tools, step by step.
std::vector<std::vector<Pose>> poses_of(const RandomScene& random, const World& world, int hold) {
  std::vector<double> heights;
  for (std::uint32_t tool = 0; tool < random.ways.size(); ++tool) {
    heights.push_back(touching_height(world, tool, random.ways[tool], random.size));
  }
  std::vector<std::vector<Pose>> poses;
  for (int step = 0; step <= all_steps(hold); ++step) {
    std::vector<Pose>& now = poses.emplace_back();
    for (std::size_t tool = 0; tool < random.ways.size(); ++tool) {
      now.push_back(
          pose_at(random.ways[tool], heights[tool], random.size, progress_at(step, hold)));
    }
  }
  return poses;
}

/// Half the speeds that count as a jump (tool_motion.cpp).
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

struct Run {
  std::vector<std::vector<glm::dvec3>> forces;   // (tools) (steps) N
  std::vector<std::vector<glm::dvec3>> torques;  // N m
  std::vector<double> work;                      // (steps) J, of all tools
  std::vector<std::vector<std::size_t>> let_go;  // (tools) steps in which friction alone let go
  std::uint32_t faults = 0;
  int fault_step = -1;
  bool into_a_side = false;  // whether a tool that moved over the body met a side of it
  double friction = 0.0;     // the largest of a region's over what its pressure can hold
  int friction_step = -1;
  int pressed = 0;   // steps with a force
  int unsolved = 0;  // those that left equations of `patch` far from solved
};

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
    residual = std::max(residual, world.state.regions.at<PatchState>(region).residual);
  }
  run.pressed += pressed ? 1 : 0;
  run.unsolved += residual > kUnsolved ? 1 : 0;
}

// Steps for which a contact that a tool lifts off from may be without points: its body answers
// late.
constexpr int kLate = 5;

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

std::optional<std::string> not_finite(const Run& run) {
  for (const auto& columns : {run.forces, run.torques}) {
    for (const auto& vectors : columns) {
      for (std::size_t step = 0; step < vectors.size(); ++step) {
        const glm::dvec3& v = vectors[step];
        if (!std::isfinite(v.x + v.y + v.z)) {
          return fmt::format("a wrench that is not finite in step {}", step);
        }
      }
    }
  }
  return std::nullopt;
}

/// Coulomb's law, of each region: a sum of tractions that are each within it is, too.
std::optional<std::string> too_much_friction(const Run& run) {
  constexpr double kSlack = 1e-6;
  if (run.friction > 1.0 + kSlack) {
    return fmt::format("friction is {:.3g} of the most that the pressure holds, in step {}",
                       run.friction, run.friction_step);
  }
  return std::nullopt;
}

/// A step whose grid is new may leave something to the next one, not a tenth of all steps.
std::optional<std::string> not_solved(const Run& run) {
  if (10 * run.unsolved > run.pressed) {
    return fmt::format("{} of {} steps have left the equations of patch unsolved", run.unsolved,
                       run.pressed);
  }
  return std::nullopt;
}

/// A contact that nothing but friction holds is gone when it begins to slip: without friction there
/// is none where the tool is. Looks at what is before and after, each by itself.
Standout worst_between(std::span<const glm::dvec3> forces, std::vector<std::size_t> let_go,
                       double free) {
  let_go.push_back(forces.size());
  Standout worst;
  std::size_t first = 0;
  for (const std::size_t end : let_go) {
    const auto part = forces.subspan(first, end - first);
    const Standout one = largest_standout({part.begin(), part.end()}, free);
    if (one.size > worst.size) {
      worst = {first + one.step, one.size};
    }
    first = end;
  }
  return worst;
}

std::optional<std::string> not_smooth(const Run& run) {
  constexpr double kBar = 0.5;
  // Of the force there: one that grows to thirty times its median bends by that in a step.
  constexpr double kFree = 0.05;
  if (run.into_a_side) {
    return std::nullopt;  // a jolt, and another one where it leaves it over the edge
  }
  for (std::size_t tool = 0; tool < run.forces.size(); ++tool) {
    const double median = median_length(run.forces[tool]);
    const Standout worst = worst_between(run.forces[tool], run.let_go[tool], kFree);
    if (worst.size > kBar * median) {
      return fmt::format("tool {}: the force stands out by {:.3g} of the median in step {}", tool,
                         worst.size / median, worst.step);
    }
  }
  return std::nullopt;
}

std::optional<std::string> not_still(const Run& run, int hold) {
  constexpr double kDrift = 0.01;
  const std::size_t end = static_cast<std::size_t>(kHeld + hold) - 1;
  for (std::size_t tool = 0; tool < run.forces.size(); ++tool) {
    const glm::dvec3& last = run.forces[tool][end];
    const glm::dvec3& before = run.forces[tool][end - kStill];
    const double most = median_length(run.forces[tool]);
    if (glm::distance(last, before) > kDrift * std::max(most, glm::length(last))) {
      return fmt::format("tool {}: held still, the force changes by {:.3g} of itself in {} steps",
                         tool, glm::distance(last, before) / most, kStill);
    }
  }
  return std::nullopt;
}

std::optional<std::string> gives_work(const Run& run) {
  constexpr double kGiven = 0.01;  // of the largest that was in it
  const double largest = *std::ranges::max_element(run.work);
  if (run.work.back() < -kGiven * largest - 1e-300) {
    return fmt::format("the closed path gives {:.3g} of the largest work",
                       -run.work.back() / largest);
  }
  return std::nullopt;
}

std::optional<std::string> not_turned(const RandomScene& random, const Run& straight,
                                      std::vector<std::vector<Pose>> poses) {
  // Rounding decides in which step a grid is laid, and a grid is worth a percent or two of a force.
  constexpr double kSame = 0.04;
  const glm::dquat turn = glm::normalize(glm::dquat(0.7, 0.2, -0.5, 0.4));
  RandomScene turned = random;
  Pose& body = turned.scene.bodies[0].pose;
  body = {turn * body.position, turn * body.rotation};
  for (std::vector<Pose>& now : poses) {
    for (Pose& pose : now) {
      pose = {turn * pose.position, turn * pose.rotation};
    }
  }
  Result<Simulation> simulation = prepare(turned.scene, turned.options);
  if (!simulation) {
    return "turned as a whole it cannot be prepared: " + simulation.error().text;
  }
  const Run other = run(simulation.value(), turned.ways, poses);
  for (std::size_t tool = 0; tool < straight.forces.size(); ++tool) {
    const double median = median_length(straight.forces[tool]);
    for (std::size_t step = 0; step < poses.size(); ++step) {
      const double apart =
          glm::distance(other.forces[tool][step], turn * straight.forces[tool][step]);
      if (apart > kSame * median) {
        return fmt::format(
            "tool {}: turned as a whole the force differs by {:.3g} of the median in "
            "step {}",
            tool, apart / median, step);
      }
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> broken_property(const RandomScene& scene) {
  RandomScene random = scene;
  const Result<Simulation> first = prepare(random.scene, random.options);
  if (!first) {
    return std::nullopt;
  }
  const int hold = hold_steps(random.options.rate);
  const std::vector<std::vector<Pose>> poses = poses_of(random, first.value().world, hold);
  random.options.rate = slow_enough_rate(poses, random.options.rate);
  Result<Simulation> simulation = prepare(random.scene, random.options);
  if (!simulation) {
    return "with a lower rate it cannot be prepared: " + simulation.error().text;
  }
  const Run straight = run(simulation.value(), random.ways, poses);
  if (auto broken = not_finite(straight)) {
    return broken;
  }
  if (straight.faults != 0) {
    std::string names;
    for (const Fault fault : kAllFaults) {
      names += raised(straight.faults, fault) ? std::string(fault_text(fault)) + " " : "";
    }
    return fmt::format("a fault in step {}: {}", straight.fault_step, names);
  }
  if (auto broken = too_much_friction(straight)) {
    return broken;
  }
  if (auto broken = not_solved(straight)) {
    return broken;
  }
  if (auto broken = not_smooth(straight)) {
    return broken;
  }
  if (auto broken = not_still(straight, hold)) {
    return broken;
  }
  // The force of `paper` is no gradient: it is made of a contact's area and mean depth.
  if (random.scene.bodies[0].models.contact != ContactModel::kPaper) {
    if (auto broken = gives_work(straight)) {
      return broken;
    }
  }
  return straight.into_a_side ? std::nullopt : not_turned(random, straight, poses);
}

}  // namespace torsion::engine::test
