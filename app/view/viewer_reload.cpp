// The scene's files, watched while the window is open: an author works on them and sees it.

#include <thread>

#include "app/view/viewer.hpp"

namespace torsion::engine {
namespace {

constexpr double kLookPeriod = 0.3;  // s: between looks at the scene's files

}  // namespace

void Viewer::watch_scene() {
  if (now() < next_look_ || reloader_.joinable()) {
    return;
  }
  next_look_ = now() + kLookPeriod;
  if (watch_->changed()) {
    reloaded_done_ = false;
    reloader_ = std::thread([this] {
      constexpr bool kQuiet = true;
      reloaded_ = open_session(options_.scene, options_.prepare, kQuiet);
      reloaded_done_.store(true, std::memory_order_release);
    });
  }
}

/// Fails where the new scene can be read but not shown: then the one before it is gone.
Result<Done> Viewer::take_reloaded() {
  if (!reloader_.joinable() || !reloaded_done_.load(std::memory_order_acquire)) {
    return Done{};
  }
  reloader_.join();
  if (!*reloaded_) {
    state_.scene_error = reloaded_->error().text;
    return Done{};
  }
  state_.scene_error.clear();
  Result<Done> begun = begin(std::move(*reloaded_).value());
  if (begun) {
    say("the scene's file has changed: loaded anew");
  }
  return begun;
}

}  // namespace torsion::engine
