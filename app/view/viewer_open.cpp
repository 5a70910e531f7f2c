// Scenes that are opened while the window is: the same after its files have changed, for an author
// who works on them, or another one of the gallery.

#include <thread>

#include <fmt/format.h>

#include "app/view/viewer.hpp"

namespace torsion::engine {
namespace {

constexpr double kLookPeriod = 0.3;  // s: between looks at the scene's files

}  // namespace

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
  next_look_ = now() + kLookPeriod;
  if (watch_->changed()) {
    open_in_background(options_.scene);
  }
}

void Viewer::open_chosen_scene() {
  if (state_.wants_entry && *state_.wants_entry < state_.gallery.size() && !opener_.joinable()) {
    if (film_.writer) {
      end_film("another scene begins");
    }
    open_in_background(state_.gallery[*state_.wants_entry].file.string());
  }
  state_.wants_entry.reset();
  state_.opening = opener_.joinable();
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
