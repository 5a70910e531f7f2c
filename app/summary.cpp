#include "app/summary.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/live/device_words.hpp"
#include "ecs/hash.hpp"
#include "ecs/model_names.hpp"
#include "systems/contact/region_wrenches.hpp"

namespace torsion::engine {
namespace {

double simulated_time(const Session& session, const RunStatistics& statistics) {
  return static_cast<double>(statistics.steps) * session.simulation.world.model.dt;
}

/// Rows [from us, to us, count].
nlohmann::ordered_json histogram_json(const Histogram& histogram) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Histogram::Bin& bin : histogram.bins()) {
    rows.push_back({bin.from, bin.to, bin.count});
  }
  return rows;
}

std::string patch_text(const PatchStatistics& patch) {
  return fmt::format(
      "patch    iterations mean {:.2f}, most {}; residual median {:.2g}, 99 % {:.2g}, largest "
      "{:.2g}\n",
      patch.mean_iterations(), patch.most_iterations, patch.residuals.quantile(0.5),
      patch.residuals.quantile(0.99), patch.residuals.largest());
}

std::string strain_text(const StrainStatistics& strain) {
  const std::string verdict = strain.large == 0
                                  ? ""
                                  : fmt::format(
                                        ": large for linear elasticity, which all models are, for "
                                        "{:.3g} % of the contacts' time "
                                        "(docs/models.md, Large strain)",
                                        100.0 * strain.large_share());
  return fmt::format(
      "strain   mean traction of a contact up to {:.2g} of E/(1 - nu^2), tilt of the body under it "
      "up to {:.2g} rad{}\n",
      strain.most_traction, strain.most_tilt, verdict);
}

nlohmann::ordered_json patch_json(const PatchStatistics& patch) {
  return {{"region_steps", patch.region_steps()},
          {"iterations", {{"mean", patch.mean_iterations()}, {"most", patch.most_iterations}}},
          {"residual",
           {{"median", patch.residuals.quantile(0.5)},
            {"p99", patch.residuals.quantile(0.99)},
            {"largest", patch.residuals.largest()}}}};
}

nlohmann::ordered_json strain_json(const StrainStatistics& strain) {
  return {{"traction_over_modulus", strain.most_traction},
          {"tilt_rad", strain.most_tilt},
          {"large_share", strain.large_share()}};
}

}  // namespace

std::string clock_text(const RunStatistics& statistics, const std::string& mode) {
  return fmt::format(
      "thread   {}\n"
      "clock    {:.2f} steps a second; {} of {} periods began more than 1 ms late, {} steps took "
      "longer than a period\n"
      "lateness:\n{}step times:\n{}",
      mode, static_cast<double>(statistics.steps) / statistics.wall_time,
      statistics.missed_deadlines, statistics.lateness.count(), statistics.overruns,
      statistics.lateness.text(), statistics.step_times.text());
}

void add_clock(nlohmann::ordered_json& json, const RunStatistics& statistics,
               const std::string& mode) {
  json["rate_Hz"] = static_cast<double>(statistics.steps) / statistics.wall_time;
  json["thread"] = mode;
  json["missed_deadlines"] = statistics.missed_deadlines;
  json["overruns"] = statistics.overruns;
  json["lateness_us"] = {{"median", statistics.lateness.quantile(0.5)},
                         {"p99", statistics.lateness.quantile(0.99)},
                         {"largest", statistics.lateness.largest()},
                         {"histogram", histogram_json(statistics.lateness)}};
  json["step_us"]["histogram"] = histogram_json(statistics.step_times);
}

std::string summary_text(const Session& session, const RunStatistics& statistics,
                         const RunFacts& facts) {
  const World& world = session.simulation.world;
  const double simulated = simulated_time(session, statistics);
  std::string text = fmt::format(
      "{}: {} steps, {:.3f} s simulated in {:.3f} s ({:.1f} times real time)\n"
      "step     median {:.1f} us, 99 % {:.1f} us, longest {:.1f} us\n"
      "contact  in {} steps, up to {} regions; largest force {:.4g} N, torque {:.4g} N m\n",
      session.scene.path, statistics.steps, simulated, statistics.wall_time,
      simulated / statistics.wall_time, statistics.step_times.quantile(0.5),
      statistics.step_times.quantile(0.99), statistics.step_times.largest(),
      statistics.contact_steps, statistics.most_regions, statistics.peak_force,
      statistics.peak_torque);
  if (statistics.snapshots > 0) {
    text += fmt::format(
        "drawing  left out of the steps: {:.1f} us for what a picture needs of one, {:.0f} % of "
        "it\n",
        statistics.snapshot_us / statistics.snapshots,
        100.0 * statistics.snapshot_us / statistics.snapshot_step_us);
  }
  if (statistics.patch.region_steps() > 0) {
    text += patch_text(statistics.patch);
  }
  if (statistics.strain.region_steps > 0) {
    text += strain_text(statistics.strain);
  }
  for (std::uint32_t body = 0; body < world.model.bodies.size(); ++body) {
    const ModelChoice& choice = session.simulation.choices[body];
    text += fmt::format("body     {}: contact model {} ({}); body model {} ({})\n",
                        session.scene.bodies[body].node, name_of(choice.models.contact),
                        choice.contact_why, name_of(choice.models.body), choice.body_why);
  }
  if (statistics.lateness.count() > 0) {
    text += clock_text(statistics, facts.mode);
  }
  if (facts.device) {
    text += device_summary(*facts.device);
  }
  if (facts.steps_left > 0) {
    text += fmt::format("ended    by a signal, {} steps early\n", facts.steps_left);
  }
  text += fmt::format("world    hash {:016x}\n", hash(world));
  if (!facts.trace.empty()) {
    text += fmt::format("trace    {}\n", facts.trace);
  }
  if (!facts.recording.empty()) {
    text += fmt::format("recorded {}\n", facts.recording);
  }
  if (!facts.page.empty()) {
    text += fmt::format("page     {}\n", facts.page);
  }
  const std::uint32_t faults = world.state.clock.faults_ever;
  return faults == 0
             ? text
             : text + "FAULTS in this run; forces went to zero meanwhile:\n" + faults_text(faults);
}

std::string summary_json(const Session& session, const RunStatistics& statistics,
                         const RunFacts& facts) {
  const World& world = session.simulation.world;
  const double simulated = simulated_time(session, statistics);
  nlohmann::ordered_json json = {{"scene", session.scene.path},
                                 {"steps", statistics.steps},
                                 {"simulated_s", simulated},
                                 {"wall_s", statistics.wall_time},
                                 {"times_real_time", simulated / statistics.wall_time},
                                 {"step_us",
                                  {{"median", statistics.step_times.quantile(0.5)},
                                   {"p99", statistics.step_times.quantile(0.99)},
                                   {"longest", statistics.step_times.largest()}}},
                                 {"contact_steps", statistics.contact_steps},
                                 {"most_regions", statistics.most_regions},
                                 {"peak_force_N", statistics.peak_force},
                                 {"peak_torque_Nm", statistics.peak_torque},
                                 {"world_hash", fmt::format("{:016x}", hash(world))},
                                 {"faults", nlohmann::json::array()}};
  if (statistics.snapshots > 0) {
    json["snapshot_us"] = statistics.snapshot_us / statistics.snapshots;
  }
  if (statistics.patch.region_steps() > 0) {
    json["patch"] = patch_json(statistics.patch);
  }
  if (statistics.strain.region_steps > 0) {
    json["strain"] = strain_json(statistics.strain);
  }
  for (std::uint32_t body = 0; body < world.model.bodies.size(); ++body) {
    const ModelChoice& choice = session.simulation.choices[body];
    json["bodies"].push_back({{"node", session.scene.bodies[body].node},
                              {"contact_model", name_of(choice.models.contact)},
                              {"contact_model_why", choice.contact_why},
                              {"body_model", name_of(choice.models.body)},
                              {"body_model_why", choice.body_why}});
  }
  for (const Fault fault : kAllFaults) {
    if (raised(world.state.clock.faults_ever, fault)) {
      json["faults"].push_back(fault_text(fault));
    }
  }
  if (statistics.lateness.count() > 0) {
    add_clock(json, statistics, facts.mode);
  }
  if (facts.device) {
    json["device"] = device_json(*facts.device);
  }
  if (facts.steps_left > 0) {
    json["steps_left"] = facts.steps_left;
  }
  if (!facts.trace.empty()) {
    json["trace"] = facts.trace;
  }
  if (!facts.recording.empty()) {
    json["recording"] = facts.recording;
  }
  if (!facts.page.empty()) {
    json["page"] = facts.page;
  }
  return json.dump(2) + "\n";
}

}  // namespace torsion::engine
