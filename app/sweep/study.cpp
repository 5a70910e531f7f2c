#include "app/sweep/study.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/scene_settings.hpp"
#include "app/session.hpp"
#include "app/split_text.hpp"
#include "ecs/hash.hpp"
#include "ecs/model_names.hpp"

namespace torsion::engine {
namespace {

/// The values of FIRST:LAST:COUNT or FIRST:LAST:COUNTlog; none where it is no such text.
std::vector<std::string> range_of(const std::string& text) {
  std::vector<std::string> parts = split_text(text, ':');
  if (parts.size() != 3) {
    return {};
  }
  const bool ratios = parts[2].ends_with("log");
  if (ratios) {
    parts[2].resize(parts[2].size() - 3);
  }
  const auto first = read_number(parts[0]);
  const auto last = read_number(parts[1]);
  const auto count = read_number(parts[2]);
  if (!first || !last || !count || *count < 2.0 || *count > 1e6 || *count != std::floor(*count) ||
      (ratios && !(*first > 0.0 && *last > 0.0))) {
    return {};
  }
  std::vector<std::string> values;
  const int steps = static_cast<int>(*count) - 1;
  for (int k = 0; k <= steps; ++k) {
    const double share = static_cast<double>(k) / steps;
    const double value =
        ratios ? *first * std::pow(*last / *first, share) : *first + share * (*last - *first);
    // Shortest text that is this number again; the ends as they were given.
    values.push_back(k == 0 ? parts[0] : k == steps ? parts[1] : fmt::format("{}", value));
  }
  return values;
}

constexpr const char* kResults =
    "contact_models,body_models,steps,contact_steps,most_regions,peak_force_N,peak_torque_Nm,"
    "peak_couple_Nm,last_force_N,last_torque_Nm,work_J,faults,world_hash";

/// What a run comes to, over its steps and tools.
struct Outcome {
  std::uint64_t contact_steps = 0;
  std::uint32_t most_regions = 0;
  double peak_force = 0.0;
  double peak_torque = 0.0;
  double peak_couple = 0.0;

  void add(const State& state) {
    contact_steps += state.regions.empty() ? 0U : 1U;
    most_regions = std::max(most_regions, state.regions.size());
    for (const ToolWrench& wrench : state.tools.column<ToolWrench>()) {
      peak_force = std::max(peak_force, glm::length(wrench.total.force));
      peak_torque = std::max(peak_torque, glm::length(wrench.total.torque));
    }
    for (const RegionFriction& friction : state.regions.column<RegionFriction>()) {
      peak_couple = std::max(peak_couple, std::abs(friction.couple));
    }
  }
};

/// The bodies' models with a space between.
template <class Model>
std::string models_of(const Simulation& simulation, Model BodyModels::*model) {
  std::string names;
  for (const ModelChoice& choice : simulation.choices) {
    names += (names.empty() ? "" : " ") + std::string(name_of(choice.models.*model));
  }
  return names;
}

}  // namespace

Result<Axis> read_axis(const std::string& setting) {
  if (const std::string problem = setting_form_problem(setting); !problem.empty()) {
    return Error{"--set " + setting + ": " + problem};
  }
  const std::size_t equals = setting.find('=');
  const std::string values = setting.substr(equals + 1);
  Axis axis{setting.substr(0, equals), {}};
  axis.values = values.find(':') != std::string::npos ? range_of(values) : split_text(values, ',');
  for (const std::string& value : axis.values) {
    if (value.empty()) {
      axis.values.clear();
      break;
    }
  }
  if (axis.values.empty()) {
    return Error{"--set " + setting +
                 ": expected values with commas between, FIRST:LAST:COUNT or FIRST:LAST:COUNTlog, "
                 "as 1e4:1e6:10log"};
  }
  return axis;
}

std::uint64_t Study::runs() const {
  std::uint64_t runs = 1;
  for (const Axis& axis : axes) {
    runs = std::min(runs * axis.values.size(), kMostRuns + 1);
  }
  return runs;
}

std::vector<std::string> Study::settings_of(std::uint64_t run) const {
  std::vector<std::string> settings(axes.size());
  for (std::size_t k = axes.size(); k-- > 0;) {
    settings[k] = axes[k].name + "=" + axes[k].values[run % axes[k].values.size()];
    run /= axes[k].values.size();
  }
  return settings;
}

std::string Study::header() const {
  std::string header = "run";
  for (const Axis& axis : axes) {
    header += "," + axis.name;
  }
  header += "," + std::string(kResults);
  for (const std::string& name : wanted_names(wanted, tool_names(variants->scene()))) {
    header += "," + name;
  }
  return header;
}

Result<std::string> run_one(const Study& study, std::uint64_t run) {
  const std::vector<std::string> settings = study.settings_of(run);
  Result<SceneVariant> variant = study.variants->make(settings);
  if (!variant) {
    return variant.error();
  }
  Session session;
  session.scene = std::move(variant.value().scene);
  session.simulation = std::move(variant.value().simulation);
  session.tool_poses.resize(session.scene.tools.size());
  const State& state = session.simulation.world.state;
  Outcome outcome;
  WantedValues wanted(study.wanted, state.tools.size());
  const std::uint64_t steps = steps_in(session, study.seconds);
  for (std::uint64_t step = 0; step < steps; ++step) {
    step_scripted(session);
    outcome.add(state);
    wanted.add(session.simulation.world);
  }
  Wrench last;
  double work = 0.0;
  for (const ToolWrench& wrench : state.tools.column<ToolWrench>()) {
    last = {last.force + wrench.total.force, last.torque + wrench.total.torque};
    work += wrench.work;
  }
  std::string line = fmt::format("{}", run);
  for (const std::string& setting : settings) {
    line += "," + setting.substr(setting.find('=') + 1);
  }
  line +=
      fmt::format(",{},{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{},{:016x}",
                  models_of(session.simulation, &BodyModels::contact),
                  models_of(session.simulation, &BodyModels::body), steps, outcome.contact_steps,
                  outcome.most_regions, outcome.peak_force, outcome.peak_torque,
                  outcome.peak_couple, glm::length(last.force), glm::length(last.torque), work,
                  state.clock.faults_ever, hash(session.simulation.world));
  for (const double value : wanted.values()) {
    line += fmt::format(",{:.9g}", value);
  }
  return line;
}

}  // namespace torsion::engine
