#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/view/viewer.hpp"

namespace torsion {
namespace {

struct ViewOptions {
  SceneOptions scene;
  ViewerOptions viewer;
  bool json = false;
};

nlohmann::ordered_json to_json(const ViewerOutcome& outcome) {
  const RunStatistics& statistics = outcome.statistics;
  const auto times = [](const TimeHistogram& histogram) {
    return nlohmann::ordered_json{{"median", histogram.quantile(0.5)},
                                  {"p99", histogram.quantile(0.99)},
                                  {"largest", histogram.largest()}};
  };
  return {{"seconds", outcome.seconds},
          {"opened_after_s", outcome.opened_after},
          {"pictures", outcome.frames},
          {"pictures_a_second",
           static_cast<double>(outcome.frames) / (outcome.seconds - outcome.opened_after)},
          {"inner_resolution", outcome.share},
          {"thread", outcome.mode},
          {"steps", statistics.steps},
          {"periods", statistics.lateness.count()},
          {"missed_deadlines", statistics.missed_deadlines},
          {"overruns", statistics.overruns},
          {"lateness_us", times(statistics.lateness)},
          {"step_us", times(statistics.step_times)},
          {"peak_force_N", statistics.peak_force},
          {"peak_torque_Nm", statistics.peak_torque}};
}

int view(const ViewOptions& options) {
  ViewerOptions viewer_options = options.viewer;
  viewer_options.scene = options.scene.scene;
  viewer_options.prepare = options.scene.prepare_options();
  Viewer viewer(std::move(viewer_options));
  const Result<ViewerOutcome> outcome = viewer.run();
  if (!outcome) {
    return fail(outcome.error().text);
  }
  if (options.json) {
    fmt::print("{}\n", to_json(outcome.value()).dump(2));
  } else {
    const ViewerOutcome& was = outcome.value();
    fmt::print("{:.1f} s, {} pictures; {} of {} periods over 1 ms late; {}\n", was.seconds,
               was.frames, was.statistics.missed_deadlines, was.statistics.lateness.count(),
               was.mode);
  }
  return kDone;
}

}  // namespace

void add_view(CLI::App& app, Command& command) {
  CLI::App* subcommand =
      app.add_subcommand("view", "Open a scene in a window: press, twist, and see what is felt");
  auto options = std::make_shared<ViewOptions>();
  options->scene.add_to(*subcommand);
  subcommand->add_option("--seconds", options->viewer.seconds, "Close after that long")
      ->check(CLI::Range(0.0, 1e6));
  subcommand->add_option("--record", options->viewer.record,
                         "File to write at the end with everything that went in");
  subcommand->add_option("--screenshot", options->viewer.screenshot,
                         "PNG to write of the last picture");
  subcommand->add_flag("--json", options->json, "Print what the session was like as JSON");
  subcommand->callback([options, &command] {
    command = [options] {
      return view(*options);
    };
  });
}

}  // namespace torsion
