#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/progress.hpp"
#include "app/session.hpp"
#include "ecs/frame_world.hpp"
#include "render/arrows.hpp"
#include "render/camera.hpp"
#include "render/draw_options.hpp"
#include "render/overlay.hpp"
#include "render/renderer.hpp"

namespace torsion::engine {

/// Ends of the scales of a run's pictures, the same for all of them.
struct PictureScales {
  double twist = 0.0;     // rad
  double pressure = 0.0;  // Pa
  ArrowLimits arrows;
};

/// Runs `steps` steps to find what the scales must hold, looking every `stride` steps, and leaves
/// the state as it was. Ends each scale at 1, 2 or 5 times a power of ten (twist: at a round number
/// of degrees).
PictureScales find_scales(Session& session, std::uint64_t steps, std::uint64_t stride,
                          Progress& progress);

/// The camera of that node; the file's first where `node` is empty; else one that shows everything.
Result<Camera> choose_camera(const Session& session, const FrameWorld& frame,
                             const std::string& node, double aspect);

/// Draws a session's moments, one after another.
class PictureRun {
 public:
  struct Options {
    std::uint32_t width = 1280;  // pixels
    std::uint32_t height = 720;  // pixels
    std::string camera;          // node; empty: as choose_camera
    DrawOptions draw;            // its scales are filled in by set_scales
    bool overlay = true;
  };
  static Result<PictureRun> create(const Session& session, const Options& options);

  void set_scales(const PictureScales& scales);

  /// The picture of the session as its last step left it.
  Result<Image> draw(const Session& session);

 private:
  PictureRun(FrameWorld frame, Snapshot snapshot, Camera camera, Options options, OverlayFont font,
             Renderer renderer);
  [[nodiscard]] OverlayContent content_of(const Session& session) const;
  FrameWorld frame_;
  Snapshot snapshot_;
  Camera camera_;
  Options options_;
  OverlayFont font_;
  Renderer renderer_;
};

}  // namespace torsion::engine
