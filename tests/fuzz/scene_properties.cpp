#include "tests/fuzz/scene_properties.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "systems/contact/region_wrenches.hpp"
#include "tests/fuzz/random_run.hpp"
#include "tests/support/standout.hpp"

namespace torsion::engine::test {
namespace {

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

std::optional<std::string> depends_on_steps(const RandomScene& scene) {
  // As turned as a whole: a grid is laid in another step. Mean over the run, because a contact that
  // begins or lets go does so in a step.
  constexpr double kSame = 0.04;
  constexpr int kParts = 2;
  std::optional<Journey> journey = journey_of(scene);
  if (!journey) {
    return std::nullopt;
  }
  auto& [random, hold, poses] = *journey;
  Result<Simulation> coarse = prepare(random.scene, random.options);
  random.options.rate *= kParts;
  Result<Simulation> fine = prepare(random.scene, random.options);
  if (!coarse || !fine) {
    return "at another rate it cannot be prepared";
  }
  const Run all = run(coarse.value(), random.ways, poses);
  // Friction that drags a contact's material by more than the contact's size: no answer is right.
  constexpr double kMuchFriction = 1.0;
  const Friction& friction = scene.scene.bodies[0].friction;
  if (std::max(friction.static_friction, friction.dynamic_friction) > kMuchFriction &&
      100 * all.strained > all.pressed) {
    return std::nullopt;
  }
  const Run parts =
      run(fine.value(), random.ways, poses_of(random, fine.value().world, hold, kParts));
  for (std::size_t tool = 0; tool < all.forces.size() && !all.into_a_side; ++tool) {
    double apart = 0.0;
    double whole = 0.0;
    for (std::size_t step = 0; step < poses.size(); ++step) {
      const glm::dvec3& force = all.forces[tool][step];
      apart += glm::distance(force, parts.forces[tool][kParts * step]);
      whole += glm::length(force);
    }
    if (apart > kSame * whole) {
      return fmt::format(
          "tool {}: in twice as many steps the force differs by {:.3g} of itself, "
          "in the mean",
          tool, apart / whole);
    }
  }
  return std::nullopt;
}

std::optional<std::string> broken_property(const RandomScene& scene) {
  const std::optional<Journey> journey = journey_of(scene);
  if (!journey) {
    return std::nullopt;
  }
  const auto& [random, hold, poses] = *journey;
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
