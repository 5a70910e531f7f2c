#include "app/fit/prediction.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include <fmt/format.h>

#include "ecs/model_names.hpp"
#include "systems/math/frames.hpp"
#include "systems/step.hpp"

namespace torsion::engine {
namespace {

constexpr std::size_t kExpectedTimes = 200;
// Relative error of the torque that models may have here where they are chosen: what a model gets
// wrong, the unknowns make up for, and nobody waits for a step.
constexpr double kFitTolerance = 0.01;

/// The measured wrench's component of a tool after a step.
double component_of(const State& state, const Model& model, const Measurement& measurement,
                    const MeasuredQuantity& quantity) {
  const Wrench& wrench = state.tools.at<ToolWrench>(quantity.tool).total;
  if (!quantity.is_torque()) {
    return wrench.force[static_cast<glm::length_t>(quantity.component)];
  }
  glm::dvec3 torque = wrench.torque;
  if (measurement.torque_about) {
    const Pose& pose = state.tools.at<ToolPose>(quantity.tool).now;
    const glm::dvec3 lever =
        model.tools.at<MassProperties>(quantity.tool).center - *measurement.torque_about;
    torque += glm::cross(pose.rotation * lever, wrench.force);
  }
  return torque[static_cast<glm::length_t>(quantity.component - 3)];
}

}  // namespace

Result<FitProblem> make_fit_problem(SceneDescription scene, PrepareOptions options,
                                    Measurement measurement,
                                    std::vector<FreeParameter> parameters) {
  const std::vector<double>& times = measurement.times;
  const auto tools = static_cast<std::uint32_t>(scene.tools.size());
  const std::size_t stride = std::max<std::size_t>(1, times.size() / kExpectedTimes);
  options.threads = 1;  // runs are what is done at the same time
  options.expected_poses.clear();
  for (std::size_t k = 0; k < times.size(); k += stride) {
    std::vector<Pose>& poses = options.expected_poses.emplace_back();
    for (std::uint32_t tool = 0; tool < tools; ++tool) {
      poses.push_back(measured_pose(measurement, scene, tool, times[k]));
    }
  }
  for (BodyDescription& body : scene.bodies) {
    body.models.tolerance = std::min(body.models.tolerance, kFitTolerance);
  }
  const Result<Simulation> prepared = prepare(scene, options);
  if (!prepared) {
    return Error{scene.path + ": " + prepared.error().text};
  }
  FitProblem problem;
  for (std::size_t row = 0; row < scene.bodies.size(); ++row) {
    BodyDescription& body = scene.bodies[row];
    const BodyModels& chosen = prepared.value().choices[row].models;
    body.models.contact = chosen.contact;
    body.models.body = chosen.body;
    problem.models.push_back(
        fmt::format("{}: {}, {}", body.node, name_of(chosen.contact), name_of(chosen.body)));
  }
  options.settings = prepared.value().world.model.settings;
  options.contact_model = ContactModel::kAuto;  // as the scene says, from now on
  options.body_model = BodyModel::kAuto;
  problem.variants = std::make_shared<const SceneVariants>(std::move(scene), std::move(options));
  problem.measurement = std::move(measurement);
  problem.parameters = std::move(parameters);
  return problem;
}

Result<Prediction> predict(const FitProblem& problem, std::span<const double> values) {
  const ParameterValues found = parameter_values(problem.parameters, values, problem.scene());
  Result<SceneVariant> variant = problem.variants->make(found.settings);
  if (!variant) {
    return variant.error();
  }
  const SceneDescription& scene = variant.value().scene;
  Simulation& simulation = variant.value().simulation;
  const State& state = simulation.world.state;
  const Measurement& measurement = problem.measurement;
  const std::vector<double>& times = measurement.times;
  Prediction prediction;
  prediction.values.assign(measurement.size(), 0.0);
  std::vector<Pose> poses(scene.tools.size());
  std::vector<double> before(measurement.quantities.size(), 0.0);
  const double dt = simulation.world.model.dt;
  std::size_t row = 0;  // the next measured time
  // A time that rounding puts behind a step is that step's.
  for (std::uint64_t k = 0; row < times.size(); ++k) {
    const double time = times[0] + static_cast<double>(k) * dt;
    for (std::uint32_t tool = 0; tool < poses.size(); ++tool) {
      poses[tool] = measured_pose(measurement, scene, tool, time);
      poses[tool].position += found.offsets[tool];
    }
    step(simulation, poses);
    prediction.contact_steps += state.regions.empty() ? 0U : 1U;
    const std::size_t first = row;
    while (row < times.size() && times[row] <= time + 1e-6 * dt) {
      ++row;
    }
    for (std::size_t q = 0; q < measurement.quantities.size(); ++q) {
      const double now =
          component_of(state, simulation.world.model, measurement, measurement.quantities[q]);
      for (std::size_t at = first; at < row; ++at) {
        const double share = std::clamp((time - times[at]) / dt, 0.0, 1.0);  // of the step before
        prediction.values[q * times.size() + at] = std::lerp(now, before[q], share);
      }
      before[q] = now;
    }
  }
  prediction.faults = state.clock.faults_ever;
  return prediction;
}

std::vector<std::optional<Prediction>> predict_all(const FitProblem& problem,
                                                   std::span<const std::vector<double>> points) {
  std::vector<std::optional<Prediction>> predictions(points.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < points.size(); k = next++) {
      Result<Prediction> prediction = predict(problem, points[k]);
      if (prediction) {
        predictions[k] = std::move(prediction).value();
      }
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t job = 1; job < std::min<std::size_t>(problem.jobs, points.size()); ++job) {
    threads.emplace_back(work);
  }
  work();
  for (std::thread& thread : threads) {
    thread.join();
  }
  return predictions;
}

}  // namespace torsion::engine
