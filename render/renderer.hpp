#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "ecs/frame_world.hpp"
#include "ecs/result.hpp"
#include "ecs/snapshot.hpp"
#include "render/camera.hpp"
#include "render/draw_options.hpp"
#include "render/image.hpp"
#include "render/overlay_draw_list.hpp"
#include "render/validation_log.hpp"
#include "render/window.hpp"

namespace torsion::engine {

struct RendererOptions {
  std::uint32_t width = 1280;       // pixels, 1 to 16384
  std::uint32_t height = 720;       // pixels, 1 to 16384
  std::uint32_t samples = 4;        // per pixel: 1, or 4 for smooth edges at about twice the time;
                                    // 0: 1 where a processor draws, else 4
  std::uint32_t shadow_size = 512;  // texels along the side of the shadow map, 1 to 8192
  ValidationLog* validation =
      nullptr;  // switches validation and synchronization validation on and takes what they
                // say, also at the renderer's end, so it must outlive it; for tests
  bool force_staging =
      false;  // copy through staging buffers even where the CPU could write the GPU's memory
  std::uint32_t most_texels = UINT32_MAX;  // read storage where a column has more rows, as on
                                           // devices with small texel buffers
  std::string
      device_name;  // part of a device's name; empty: the environment's TORSION_GPU, else the best
  const OverlayAtlas* overlay_atlas = nullptr;  // copied; without it no overlay is drawn
  const Window* window = nullptr;  // draw into it; must outlive the renderer. null: into pictures
  std::optional<bool> quick;       // shaders for little time; nothing: in a window that a processor
                                   // draws
};

/// Milliseconds that each pass of one frame took on the device.
struct PassTimes {
  double upload = 0.0;
  double deform = 0.0;
  double normals = 0.0;
  double shadow = 0.0;
  double draw = 0.0;       // bodies, ground, arrows, tools, overlay
  double stretch = 0.0;    // into the window's size
  double overlay = 0.0;    // over a window
  double read_back = 0.0;  // or what hands it to the window
};

/// The passes by name, in their order.
struct PassTime {
  const char* name;
  double PassTimes::*time;
};
inline constexpr std::array<PassTime, 8> kPasses = {{{"upload", &PassTimes::upload},
                                                     {"deform", &PassTimes::deform},
                                                     {"normals", &PassTimes::normals},
                                                     {"shadow", &PassTimes::shadow},
                                                     {"draw", &PassTimes::draw},
                                                     {"stretch", &PassTimes::stretch},
                                                     {"overlay", &PassTimes::overlay},
                                                     {"read_back", &PassTimes::read_back}}};

/// Deforms and draws a frame world into pictures of one size, which needs no window, or into a
/// window. One thread at a time.
class Renderer {
 public:
  /// Frames that may be under way at once, and whose results can still be read.
  static constexpr std::uint32_t kFramesInFlight = 2;

  /// Takes what is constant of `frame` (rest shape, triangles, colours). Errors: no Vulkan device
  /// that is able, a size out of range, a body larger than the device can address.
  static Result<Renderer> create(const RendererOptions& options, const FrameWorld& frame);

  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

  /// Starts drawing one picture and returns its number, 0, 1, 2, ...; the drawing goes on while the
  /// caller works. Everything is copied: `frame` may change at once. Waits only if the frame
  /// kFramesInFlight before is not done. `frame` is the frame world given to `create`, as
  /// surface_field() left it; `overlay` may be null.
  Result<std::uint64_t> draw(const FrameWorld& frame, const Snapshot& snapshot,
                             const Camera& camera, const DrawOptions& options,
                             const OverlayDrawList* overlay);

  /// How a window is to be filled.
  struct Showing {
    std::uint32_t width = 0;  // pixels of the window now
    std::uint32_t height = 0;
    double share = 1.0;  // of these, along each side, in which the scene is drawn; the overlay is
                         // always sharp
    bool keep = false;   // screenshot() gets this picture
    bool redraw_panels = true;  // else they are as they were in the picture before
  };

  /// As draw(), into the window. Blocks until the picture is handed over, which on a processor's
  /// driver is nearly as long as drawing takes. False: nothing is shown this time, because the
  /// window has no size, or has just changed it; come again.
  Result<bool> show(const FrameWorld& frame, const Snapshot& snapshot, const Camera& camera,
                    const DrawOptions& options, const OverlayDrawList* overlay,
                    const Showing& showing);

  /// The picture that the last show() with `keep` put into the window, overlay and all.
  Result<Image> screenshot();

  /// The picture with that number, which must be one of the last kFramesInFlight drawn. Waits until
  /// it is done.
  Result<Image> read_pixels(std::uint64_t number);

  /// The same for the time that each pass took.
  Result<PassTimes> pass_times(std::uint64_t number);

  /// Pictures so far; the last has this number less one.
  [[nodiscard]] std::uint64_t pictures() const;

  /// The last frame's deformed positions [m, body] and normals [body] of all bodies' vertices, w
  /// unused. For tests; waits until the device is idle.
  Result<std::vector<glm::vec4>> read_positions();
  Result<std::vector<glm::vec4>> read_normals();

  /// Name and driver of the device in use.
  [[nodiscard]] const std::string& device_name() const;

 private:
  struct Impl;
  explicit Renderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace torsion::engine
