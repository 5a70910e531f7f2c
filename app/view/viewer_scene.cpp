// The scene in the window: how it begins, and begins again, and others that are opened meanwhile:
// the same after its files have changed, for an author who works on them, or one of the gallery.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "app/scene_colors.hpp"
#include "app/view/panel_layout.hpp"
#include "app/view/viewer.hpp"
#include "device/scripted_motion.hpp"
#include "render/auto_camera.hpp"

namespace torsion::engine {
namespace {

constexpr double kLookPeriod = 0.06;   // s: between looks at the scene's files
constexpr double kQuietPeriod = 0.15;  // s: for which they are quiet before they are read

}  // namespace

void Viewer::place_camera() {
  FrameWorld& frame = session_->shown().frame;
  const double aspect = static_cast<double>(kWindowWidth) / kWindowHeight;
  const std::vector<CameraDescription>& cameras = session_->scene().cameras;
  state_.camera =
      orbit_of(cameras.empty() ? auto_camera(frame, aspect, scripted_poses(session_->scene()))
                               : camera_of(cameras.front()),
               glm::dvec3(0.0));
}

Camera Viewer::camera() const {
  const WindowInput& input = window_->input();
  Camera camera = camera_of(state_.camera);
  const float covered =
      covered_columns(state_, static_cast<float>(input.width), static_cast<float>(input.height));
  camera.shift = 0.5 * static_cast<double>(covered) / std::max(input.width, 1U);
  return camera;
}

/// The camera and what is drawn, as the scene says.
void Viewer::look_at_scene() {
  place_camera();
  const SceneView& view = session_->scene().view;
  state_.draw.heat_map = heat_map_of(view.colors).value_or(HeatMap::kNone);
  state_.show_cells = view.stick_slip;
  state_.slowness = static_cast<std::uint32_t>(std::lround(1.0 / view.speed));
  state_.loop = view.loop;
  state_.entry = entry_of(state_.gallery, options_.scene);
  state_.draw.torque_parts = view.torque_parts;
  state_.draw.grid = view.lines;
  seen_ = SeenScales{};
}

/// Takes over a prepared scene: at the start, after its file has changed, or another one.
Result<Done> Viewer::begin(Session session, Keep keep) {
  const bool again = session_ != nullptr;
  renderer_.reset();
  session_.reset();
  // Physics and devices do not inherit that this thread makes way for them.
  Result<Done> started = Done{};
  starter_->run([&] {
    // A device that held a tool of the scene before is closed by now.
    Result<SceneDevice> device = open_device(options_.device, session.scene);
    if (!device) {
      started = device.error();
      return;
    }
    session_ = std::make_unique<LiveSession>(std::move(session), options_.prepare, options_.record);
    if (!again && !options_.record.empty() && !session_->recording_problem().empty()) {
      started = Error{session_->recording_problem()};
      return;
    }
    session_->give(std::move(device).value());
    session_->hold_by(options_.device.hold);
    session_->start();
  });
  if (!started) {
    return started;
  }
  if (!session_->mode().fifo) {
    // Before the driver makes its threads, which inherit it.
    make_way_for_realtime();
  }
  session_->pause(state_.paused);
  const std::size_t tools = session_->scene().tools.size();
  state_.histories.assign(tools, History{});
  state_.region_histories.assign(tools, RegionHistory{});
  state_.tool = 0;
  state_.body = 0;
  state_.picks = session_->shown().picks;
  handles_.assign(tools, Pose{});
  grab_ = Grab{};
  move_.reset();
  stop_driving();
  state_.let_go = false;
  state_.strength = kGentleForce;
  let_go_until_ = 0.0;
  if (keep == Keep::kNothing) {
    look_at_scene();
  }
  while (!session_->refresh()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return make_renderer();
}

/// Begins the scene again after its animation, as long as nobody has taken a tool.
void Viewer::loop_scene() {
  constexpr double kRest = 0.5;  // s, of the scene: at its end
  const double duration = session_->scene().duration;
  const LiveFrame& frame = session_->frame();
  // A recording to a file is of one run.
  const double end = std::max(duration, let_go_until_);
  if (!state_.loop || duration <= 0.0 || frame.snapshot.clock.time < end + kRest || frame.paused ||
      !session_->settled() || !options_.record.empty()) {
    return;
  }
  for (std::uint32_t tool = 0; tool < handles_.size(); ++tool) {
    if (session_->held(tool) || session_->on_device(tool)) {
      return;
    }
  }
  let_go_until_ = 0.0;
  outcome_.loops += session_->choose(session_->shown().picks, true) ? 1U : 0U;
}

void Viewer::open_in_background(const std::string& scene) {
  opening_ = scene;
  opened_done_ = false;
  opener_ = std::thread([this] {
    constexpr bool kQuiet = true;
    opened_ = open_session(opening_, options_.prepare, kQuiet);
    opened_done_.store(true, std::memory_order_release);
  });
}

void Viewer::watch_scene() {
  if (now() < next_look_ || opener_.joinable()) {
    return;
  }
  const bool changed = watch_->changed();
  next_look_ = now() + (watch_->changing() ? kQuietPeriod : kLookPeriod);
  if (changed) {
    open_in_background(options_.scene);
  }
  const bool loading = opener_.joinable() || watch_->changing();
  next_panels_ = loading == state_.opening ? next_panels_ : 0.0;  // says so at once
  state_.opening = loading;
}

void Viewer::open_chosen_scene() {
  const bool wanted = state_.wants_entry && *state_.wants_entry < state_.gallery.size();
  if (wanted && !options_.record.empty()) {
    say("one scene is recorded to " + options_.record + ": close the window to see another");
  } else if (wanted && !opener_.joinable()) {
    if (film_.writer) {
      end_film("another scene begins");
    }
    open_in_background(state_.gallery[*state_.wants_entry].file.string());
  }
  state_.wants_entry.reset();
  state_.opening = opener_.joinable() || watch_->changing();
}

/// Fails where the new scene can be read but not shown: then the one before it is gone.
Result<Done> Viewer::take_opened() {
  if (!opener_.joinable() || !opened_done_.load(std::memory_order_acquire)) {
    return Done{};
  }
  opener_.join();
  if (!*opened_) {
    state_.scene_error = opened_->error().text;
    return Done{};
  }
  state_.scene_error.clear();
  const bool another = opening_ != options_.scene;
  if (another) {
    options_.scene = opening_;
    watch_.emplace(options_.scene);
    window_->set_title(window_title(options_.scene));
  }
  Result<Done> begun = begin(std::move(*opened_).value(), another ? Keep::kNothing : Keep::kView);
  if (begun && !another) {
    say("the scene's file has changed: loaded anew");
  }
  return begun;
}

}  // namespace torsion::engine
