#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/device_options.hpp"
#include "app/live/device_words.hpp"
#include "app/summary.hpp"
#include "app/view/recent_scenes.hpp"
#include "app/view/viewer.hpp"
#include "systems/model/cache.hpp"

namespace torsion::engine {
namespace {

struct ViewOptions {
  SceneOptions scene;
  ViewerOptions viewer;
  bool json = false;
};

double pictures_a_second(const ViewerOutcome& outcome) {
  return static_cast<double>(outcome.frames) / (outcome.seconds - outcome.opened_after);
}

nlohmann::ordered_json to_json(const ViewerOutcome& outcome) {
  const RunStatistics& statistics = outcome.statistics;
  const auto times = [](const Histogram& histogram) {
    return nlohmann::ordered_json{{"median", histogram.quantile(0.5)},
                                  {"p99", histogram.quantile(0.99)},
                                  {"largest", histogram.largest()}};
  };
  nlohmann::ordered_json json = {{"seconds", outcome.seconds},
                                 {"opened_after_s", outcome.opened_after},
                                 {"pictures", outcome.frames},
                                 {"loops", outcome.loops},
                                 {"pictures_a_second", pictures_a_second(outcome)},
                                 {"inner_resolution", outcome.share},
                                 {"steps", statistics.steps},
                                 {"periods", statistics.lateness.count()},
                                 {"step_us", times(statistics.step_times)},
                                 {"peak_force_N", statistics.peak_force},
                                 {"peak_torque_Nm", statistics.peak_torque}};
  for (const PassTime& pass : kPasses) {
    json["pass_ms"][pass.name] = outcome.passes.*pass.time;
  }
  add_clock(json, statistics, outcome.mode);
  if (outcome.device) {
    json["device"] = device_json(*outcome.device);
  }
  return json;
}

/// Behind the gallery's scenes, those of a person's own that were opened last.
void add_recent(const std::filesystem::path& list, std::vector<GalleryEntry>& gallery) {
  for (const std::filesystem::path& scene : recent_scenes(list)) {
    if (!entry_of(gallery, scene)) {
      gallery.push_back({scene, scene.filename().string(), scene.parent_path().string(), {}});
    }
  }
}

int view(const ViewOptions& options) {
  ViewerOptions viewer_options = options.viewer;
  viewer_options.gallery = read_gallery();
  const bool own = !options.scene.scene.empty() &&
                   !entry_of(viewer_options.gallery, options.scene.scene) &&
                   viewer_options.seconds < 0.0;  // those of scripts are nobody's own
  const std::filesystem::path cache = cache_folder();
  const std::filesystem::path recent = cache.empty() ? cache : cache / "recent_scenes";
  viewer_options.scene = options.scene.scene;
  if (viewer_options.scene.empty()) {
    if (viewer_options.gallery.empty()) {
      return fail(
          "the scenes that ship with torsion are not beside it: give the path of a scene, as in "
          "torsion view my_scene.glb");
    }
    viewer_options.scene = viewer_options.gallery.front().file.string();
  }
  add_recent(recent, viewer_options.gallery);
  viewer_options.prepare = options.scene.prepare_options();
  Viewer viewer(std::move(viewer_options));
  const Result<ViewerOutcome> outcome = viewer.run();
  if (!outcome) {
    return fail(outcome.error().text);
  }
  if (own && !recent.empty()) {
    remember_scene(recent, options.scene.scene);
  }
  if (options.json) {
    fmt::print("{}\n", to_json(outcome.value()).dump(2));
  } else {
    const ViewerOutcome& was = outcome.value();
    fmt::print("window   {:.1f} s, {} pictures, {:.1f} a second at {:.0f} % size at the end\n{}{}",
               was.seconds, was.frames, pictures_a_second(was), 100.0 * was.share,
               clock_text(was.statistics, was.mode), was.device ? device_summary(*was.device) : "");
  }
  if (!outcome.value().problem.empty()) {
    return fail(outcome.value().problem);
  }
  return kDone;
}

}  // namespace

void add_view(CLI::App& app, Command& command) {
  CLI::App* subcommand = app.add_subcommand(
      "view", "Open a scene in a window, or the gallery: press, twist, and see what is felt");
  auto options = std::make_shared<ViewOptions>();
  constexpr bool kSceneRequired = false;
  options->scene.add_to(*subcommand, kSceneRequired);
  subcommand->add_option("--seconds", options->viewer.seconds, "Close after that long")
      ->check(CLI::Range(0.0, 1e6));
  subcommand->add_option("--record", options->viewer.record,
                         "File to write with everything that goes in");
  subcommand->add_option("--screenshot", options->viewer.screenshot,
                         "PNG to write of the last picture");
  subcommand->add_option("--device", options->viewer.device.what,
                         "What holds the tool instead of the mouse: usb, usb:falcon+odrive, or "
                         "gateway[:PORT]");
  add_device_options(*subcommand, options->viewer.device);
  subcommand->add_flag("--json", options->json, "Print what the session was like as JSON");
  subcommand->callback([options, &command] {
    command = [options] {
      return view(*options);
    };
  });
}

}  // namespace torsion::engine
