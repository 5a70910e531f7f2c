#include "app/report/run_case.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include <glm/geometric.hpp>

#include "ecs/memory.hpp"
#include "systems/surface/surface_field.hpp"

namespace torsion::engine {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// Steps to a point of the path from the one before, and calls stepped(seconds) after each step.
template <class Stepped>
void move_to_point(Simulation& simulation, const std::vector<PathPoint>& path, std::size_t point,
                   const Stepped& stepped) {
  const Pose& to = path[point].tool;
  const Pose& from = point == 0 ? to : path[point - 1].tool;
  const glm::dquat turn = to.rotation * glm::conjugate(from.rotation);
  const double angle = glm::angle(turn);
  const glm::dvec3 axis = glm::axis(turn);
  for (int i = 1; i <= path[point].steps; ++i) {
    const double share = static_cast<double>(i) / path[point].steps;
    const Pose pose{glm::mix(from.position, to.position, share),
                    glm::angleAxis(angle * share, axis) * from.rotation};
    const auto start = SteadyClock::now();
    step(simulation, {&pose, 1});
    stepped(std::chrono::duration<double>(SteadyClock::now() - start).count());
  }
}

/// By which angle the body's top goes around the axis under the tool at each radius of the field:
/// the mean of four directions, less the shift of all four. The points are the only vertices of a
/// body that is drawn.
std::vector<double> surface_twists(const ReferenceCase& reference_case,
                                   const Simulation& simulation) {
  constexpr std::array<glm::dvec2, 4> kDirections = {
      {{1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}}};
  const ReferenceField& field = reference_case.field;
  SceneDescription scene = reference_case.scene;
  const glm::dvec3 center = reference_case.path[field.point].tool.position;
  const Bounds& bounds = simulation.world.model.bodies.at<Bounds>(0);
  DrawMesh& drawn = scene.bodies[0].draw;
  drawn = DrawMesh{};
  for (const double r : field.radii) {
    for (const glm::dvec2& direction : kDirections) {
      drawn.positions.emplace_back(center.x + r * direction.x, bounds.highest.y,
                                   center.z + r * direction.y);
      drawn.normals.emplace_back(0.0F, 1.0F, 0.0F);
    }
  }
  FrameWorld frame = prepare_frame(scene, simulation.world.model, simulation.world.state);
  Snapshot snapshot;
  snapshot.reserve(simulation.world.model, simulation.world.state);
  take_snapshot(simulation, snapshot);
  surface_field(simulation.world.model, snapshot, frame);
  std::vector<glm::vec4> moved(drawn.positions.size());
  deform_vertices(frame, 0, moved);
  std::vector<double> twists;
  for (std::size_t i = 0; i < field.radii.size(); ++i) {
    const std::size_t first = kDirections.size() * i;
    glm::dvec3 middle(0.0);
    for (std::size_t k = 0; k < kDirections.size(); ++k) {
      middle += glm::dvec3(moved[first + k]) / static_cast<double>(kDirections.size());
    }
    double around = 0.0;  // rad, sum over the directions
    for (std::size_t k = 0; k < kDirections.size(); ++k) {
      const glm::dvec3 arm = glm::dvec3(moved[first + k]) - middle;
      const glm::dvec2& from = kDirections[k];
      // A turn about +y takes +x to -z and +z to +x.
      around += std::atan2(arm.x * from.y - arm.z * from.x, arm.x * from.x + arm.z * from.y);
    }
    twists.push_back(around / static_cast<double>(kDirections.size()));
  }
  return twists;
}

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) {
    return 0.0;
  }
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

Result<Simulation> prepare_case(const ReferenceCase& reference_case, const ModelPair& models) {
  PrepareOptions options;
  options.contact_model = models.contact;
  options.body_model = models.body;
  options.settings.grid_side = models.grid_side;
  for (const PathPoint& point : reference_case.path) {
    options.expected_poses.push_back({point.tool});
  }
  return prepare(reference_case.scene, options);
}

void move_case(Simulation& simulation, const ReferenceCase& reference_case, std::size_t point) {
  move_to_point(simulation, reference_case.path, point, [](double) {});
}

Result<CaseRun> run_case(const ReferenceCase& reference_case, const ModelPair& models) {
  Result<Simulation> prepared = prepare_case(reference_case, models);
  if (!prepared) {
    return prepared.error();
  }
  Simulation& simulation = prepared.value();
  const World& world = simulation.world;
  CaseRun run;
  run.models = models;
  std::vector<double> times;  // us
  for (std::size_t point = 0; point < reference_case.path.size(); ++point) {
    move_to_point(simulation, reference_case.path, point, [&](double seconds) {
      if (world.state.regions.size() > 0) {
        times.push_back(1e6 * seconds);
        run.cells = world.state.regions.at<RegionIdentity>(0).cells.count;
      }
    });
    const Wrench& wrench = world.state.tools.at<ToolWrench>(0).total;
    run.forces.push_back(glm::dot(wrench.force, reference_case.force_axis));
    run.torques.push_back(glm::dot(wrench.torque, reference_case.torque_axis));
    if (point == reference_case.field.point && !reference_case.field.radii.empty()) {
      run.twists = surface_twists(reference_case, simulation);
    }
  }
  // Where the body model knows of the body's deformation.
  run.anchors = std::max(world.model.anchors.size(), world.model.ports.size());
  run.step_us_median = quantile(times, 0.5);
  run.step_us_p99 = quantile(times, 0.99);
  run.memory_bytes = memory_of(world);
  run.faults_ever = world.state.clock.faults_ever;
  return run;
}

Result<Simulation> simulate_to(const ReferenceCase& reference_case, const ModelPair& models,
                               std::size_t point) {
  Result<Simulation> prepared = prepare_case(reference_case, models);
  if (prepared) {
    for (std::size_t i = 0; i <= point; ++i) {
      move_case(prepared.value(), reference_case, i);
    }
  }
  return prepared;
}

}  // namespace torsion::engine
