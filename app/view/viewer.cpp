#include "app/view/viewer.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "app/round_up.hpp"
#include "app/view/panels.hpp"
#include "render/image_io.hpp"
#include "systems/surface/surface_field.hpp"

namespace torsion::engine {
namespace {

constexpr double kFramePeriod = 1.0 / 60.0;  // s: no faster than that
constexpr double kPanelPeriod = 0.1;         // s: between drawings of panels that nobody touches
constexpr double kHiddenPeriod = 0.1;        // s: while nothing can be seen
constexpr double kSlowFrame = 1.0 / 28.0;    // s: over that the inner resolution goes down
constexpr double kFastFrame = 1.0 / 50.0;    // s: under that it goes up
constexpr double kSmallestShare = 0.4;
constexpr double kMessageSeconds = 4.0;
constexpr double kLeastTwistScale = 5.0 * std::numbers::pi / 180.0;  // rad

/// Ends of the scales of colours and arrows that hold everything so far.
void widen_scales(const Snapshot& snapshot, DrawOptions& draw, SeenScales& seen) {
  for (std::uint32_t region = 0; region < snapshot.regions.size(); ++region) {
    const double area = snapshot.regions.at<Contact>(region).area;
    seen.twist = std::max(seen.twist, std::abs(snapshot.regions.at<RegionMotion>(region).turn));
    if (area > 0.0) {
      seen.pressure =
          std::max(seen.pressure, snapshot.regions.at<RegionNormal>(region).force / area);
    }
  }
  widen(seen.arrows, snapshot.tools, snapshot.regions);
  constexpr double kDegree = std::numbers::pi / 180.0;
  draw.heat_limit = draw.heat_map == HeatMap::kPressure
                        ? round_up(seen.pressure)
                        : std::max(kLeastTwistScale, round_up(seen.twist / kDegree) * kDegree);
  // 0 has the renderer choose.
  const auto end_of = [](double limit) {
    return limit > 0.0 ? round_up(limit) : 0.0;
  };
  draw.full_force = end_of(seen.arrows.force);
  draw.full_torque = end_of(seen.arrows.torque);
  draw.full_couple = end_of(seen.arrows.couple);
}

}  // namespace

std::string whole_path(const std::string& name) {
  std::error_code failed;
  const std::filesystem::path path = std::filesystem::absolute(name, failed);
  return failed ? name : path.string();
}

std::string window_title(const std::string& scene) {
  return "Torsion: " + std::filesystem::path(scene).filename().string();
}

Viewer::Viewer(ViewerOptions options) : options_(std::move(options)) {
  state_.gallery = std::move(options_.gallery);
}

Viewer::~Viewer() {
  if (opener_.joinable()) {
    opener_.join();
  }
  renderer_.reset();  // before the window that it draws into
}

double Viewer::now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Viewer::say(const std::string& text) {
  state_.message = text;
  state_.message_until = now() + kMessageSeconds;
}

std::string Viewer::file_name(const std::string& extension) {
  const std::string stem = std::filesystem::path(options_.scene).stem().string();
  std::string name;
  do {
    name = fmt::format("{}_{}{}", stem, ++files_written_, extension);
  } while (std::filesystem::exists(name));
  return name;
}

Result<Done> Viewer::make_renderer() {
  renderer_.reset();
  RendererOptions options;
  options.samples = 0;
  options.window = &*window_;
  options.overlay_atlas = &gui_->atlas();
  Result<Renderer> made = Renderer::create(options, session_->shown().frame);
  if (!made) {
    return made.error();
  }
  renderer_ = std::move(made).value();
  return Done{};
}

/// Does what panels and keys asked for.
void Viewer::take_wishes() {
  const LiveFrame& frame = session_->frame();
  if (state_.paused != frame.paused) {
    session_->pause(state_.paused);
  }
  if (state_.slowness != frame.slowness) {
    session_->slow_down(state_.slowness);
  }
  if (state_.wants_step) {
    state_.paused = true;
    session_->pause(true);
    session_->step_once();
  }
  if (state_.wants_view) {
    place_camera();
  }
  if (state_.wants_move) {
    begin_move();
  }
  if (state_.wants_release) {
    let_go();
  }
  if (state_.wants_strength) {
    session_->set_strength(state_.strength);
  }
  if (state_.wants_restart && session_->choose(state_.picks, true)) {
    grab_ = Grab{};
    move_.reset();
    stop_driving();
    state_.let_go = false;
    say("from the start");
  }
  if (state_.wants_choice && differ(state_.picks, session_->shown().picks)) {
    session_->choose(state_.picks, false);
  }
  if (state_.wants_saved_recording) {
    const std::string name = file_name(".rec");
    const Result<Done> saved = session_->save_recording(name);
    say(saved ? fmt::format("{}: {:.1f} s, everything since the start; torsion simulate --replay "
                            "plays it, torsion export --replay makes it the scene's animation",
                            whole_path(name), session_->recorded_seconds())
              : saved.error().text);
  }
  if (state_.wants_video) {
    begin_or_end_film();
  }
  open_chosen_scene();
  state_.wants_video = false;
  state_.wants_step = false;
  state_.wants_release = false;
  state_.wants_view = false;
  state_.wants_move = false;
  state_.wants_strength = false;
  state_.wants_restart = false;
  state_.wants_choice = false;
  state_.wants_saved_recording = false;
  session_->show_cells(state_.show_cells);
}

void Viewer::take_history() {
  const DeviceView* const device = session_->device();
  session_->take_rows([&](const LiveRow& row) {
    const bool shown = session_->on_device(row.tool) && device->sample.state == DeviceState::kLive;
    state_.histories[row.tool].add(row, shown ? device->sample.rate : 0.0);
  });
  for (std::uint32_t tool = 0; tool < state_.region_histories.size(); ++tool) {
    state_.region_histories[tool].add(session_->frame().snapshot, tool);
  }
  const std::uint64_t missed = session_->frame().statistics.missed_deadlines;
  if (missed < missed_then_ || now() > missed_since_ + 1.0) {
    state_.missed_lately =
        static_cast<std::uint32_t>(missed > missed_then_ ? missed - missed_then_ : 0);
    missed_then_ = missed;
    missed_since_ = now();
  }
}

/// Holds the frame rate by the inner resolution, in small steps with pauses between.
void Viewer::fit_share(double frame_seconds) {
  shown_frame_time_ =
      shown_frame_time_ == 0.0 ? frame_seconds : 0.9 * shown_frame_time_ + 0.1 * frame_seconds;
  state_.frames_per_second = 1.0 / std::max(shown_frame_time_, kFramePeriod);
  if (now() < next_fit_) {
    return;
  }
  next_fit_ = now() + 1.0;
  if (shown_frame_time_ > kSlowFrame && state_.share > kSmallestShare) {
    state_.share = std::max(kSmallestShare, 0.85 * state_.share);
  } else if (shown_frame_time_ < kFastFrame && state_.share < 1.0) {
    state_.share = std::min(1.0, 1.1 * state_.share);
  }
}

/// Panels are drawn ten times a second, and where a person acts on them at once.
bool Viewer::panels_due(const WindowInput& input) {
  const glm::dvec2 mouse(input.mouse_x, input.mouse_y);
  const bool used = Gui::has_mouse() && (mouse != panels_mouse_ || input.wheel != 0.0 ||
                                         std::ranges::count(input.buttons, true) > 0);
  if (now() < next_panels_ && !used && input.pressed.empty()) {
    return false;
  }
  next_panels_ = now() + kPanelPeriod;
  panels_mouse_ = mouse;
  return true;
}

Result<Done> Viewer::show(const WindowInput& input, const OverlayDrawList& overlay) {
  Generation& shown = session_->shown();
  const Snapshot& snapshot = session_->frame().snapshot;
  surface_field(shown.simulation.world.model, snapshot, shown.frame);
  widen_scales(snapshot, state_.draw, seen_);
  const bool filmed = film_due();
  const bool keep = state_.wants_screenshot || filmed;
  const bool whole = state_.wants_screenshot || film_.writer;
  const bool redraw = panels_due(input) || state_.wants_screenshot;
  const Result<bool> drawn =
      renderer_->show(shown.frame, snapshot, camera(), state_.draw, &overlay,
                      {input.width, input.height, whole ? 1.0 : state_.share, keep, redraw});
  if (!drawn) {
    return drawn.error();
  }
  outcome_.frames += drawn.value() ? 1U : 0U;
  if (drawn.value()) {
    add_passes();
  }
  if (drawn.value() && outcome_.frames == 1) {
    outcome_.opened_after = now();
  }
  if (drawn.value() && filmed) {
    add_to_film();
  }
  if (drawn.value() && state_.wants_screenshot) {
    state_.wants_screenshot = false;
    const std::string name = file_name(".png");
    const Result<Done> written = write_screenshot(name);
    say(written ? whole_path(name) : written.error().text);
  }
  return Done{};
}

/// Of the picture before the last, which is done by now, so that nothing waits.
void Viewer::add_passes() {
  if (renderer_->pictures() < 2) {
    return;
  }
  if (const auto times = renderer_->pass_times(renderer_->pictures() - 2)) {
    passes_timed_ += 1;
    for (const PassTime& pass : kPasses) {
      double& mean = outcome_.passes.*pass.time;
      mean += (times.value().*pass.time - mean) / static_cast<double>(passes_timed_);
    }
  }
}

Result<Done> Viewer::write_screenshot(const std::string& path) {
  const Result<Image> image = renderer_->screenshot();
  return image ? write_png(image.value(), path) : image.error();
}

Result<Done> Viewer::frame() {
  const double before = now();
  // Pictures come at a rate of their own; what is left of the period is slept away.
  const double wait = last_frame_ + kFramePeriod - before;
  const WindowInput& input = window_->look(std::max(wait, 0.0));
  if (input.hidden) {
    window_->look(kHiddenPeriod);
  }
  session_->refresh();
  take_history();
  loop_scene();
  watch_scene();
  if (Result<Done> taken = take_opened(); !taken) {
    return taken;
  }
  const double started = now();
  const double seconds = started - last_frame_;
  gui_->begin(input, seconds);
  last_frame_ = started;
  take_keys(input);
  take_mouse(input, seconds);
  go_on_moving();
  go_on_driving();
  state_.handle = session_->held(state_.tool) ? std::optional(handles_[state_.tool]) : std::nullopt;
  draw_marks(state_, *session_, camera(), {input.width, input.height});
  draw_panels(state_, *session_, started);
  const OverlayDrawList& overlay = gui_->end();
  take_wishes();
  if (input.hidden) {
    return Done{};
  }
  Result<Done> shown = show(input, overlay);
  fit_share(now() - started);
  return shown;
}

Result<ViewerOutcome> Viewer::run() {
  constexpr bool kQuiet = false;
  Result<Session> session = open_session(options_.scene, options_.prepare, kQuiet);
  if (!session) {
    return session.error();
  }
  interrupt_.emplace();  // before any thread, but not while a scene is prepared for long
  start_ = std::chrono::steady_clock::now();
  starter_.emplace();
  Result<Window> window = Window::open(window_title(options_.scene), kWindowWidth, kWindowHeight);
  if (!window) {
    return window.error();
  }
  window_ = std::move(window).value();
  std::vector<Image> pictures;
  for (const GalleryEntry& entry : state_.gallery) {
    pictures.push_back(entry.picture);
  }
  gui_ = std::make_unique<Gui>(pictures);
  state_.cards = gui_->cards();
  watch_.emplace(options_.scene);
  Result<Done> done = begin(std::move(session).value(), Keep::kNothing);
  while (done) {
    done = frame();
    const bool over = options_.seconds >= 0.0 && now() > options_.seconds;
    const WindowInput& input = window_->input();
    if (over || input.close || interrupt_->within(0) ||
        (std::ranges::count(input.pressed, kKeyEscape) > 0 && !Gui::has_keyboard())) {
      break;
    }
  }
  if (!done) {
    return done.error();
  }
  return finish();
}

/// Writes what was asked for at the end.
Result<ViewerOutcome> Viewer::finish() {
  if (film_.writer) {
    end_film("");
  }
  if (!options_.screenshot.empty()) {
    state_.wants_screenshot = true;
    const WindowInput& input = window_->look();
    gui_->begin(input, kFramePeriod);
    draw_marks(state_, *session_, camera(), {input.width, input.height});
    draw_panels(state_, *session_, now());
    const OverlayDrawList& overlay = gui_->end();
    Generation& shown = session_->shown();
    const Result<bool> drawn =
        renderer_->show(shown.frame, session_->frame().snapshot, camera(), state_.draw, &overlay,
                        {input.width, input.height, 1.0, true, true});
    const Result<Done> written =
        drawn ? write_screenshot(options_.screenshot) : Result<Done>(drawn.error());
    if (!written) {
      return written.error();
    }
  }
  outcome_.statistics = session_->frame().statistics;
  outcome_.mode = describe(session_->mode());
  outcome_.seconds = now();
  outcome_.share = state_.share;
  if (session_->device() != nullptr) {
    outcome_.device = *session_->device();
  }
  if (!options_.record.empty()) {
    session_->refresh();
    const Result<Done> saved = session_->finish_recording();
    outcome_.problem = saved ? "" : saved.error().text;
  }
  return outcome_;
}

}  // namespace torsion::engine
