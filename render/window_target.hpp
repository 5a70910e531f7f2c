#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "render/image.hpp"
#include "render/memory.hpp"
#include "render/overlay_draw_list.hpp"
#include "render/target.hpp"
#include "render/window.hpp"

namespace torsion::engine {

/// The extensions of an instance that can show pictures in windows. @pre a window is open
std::vector<std::string> surface_extensions();

/// Pictures into a window. A scene is drawn into an image of its own, which may be smaller, and
/// stretched over the window's; the overlay is drawn over that at full size.
class WindowTarget final : public Target {
 public:
  /// @param gpu, window  must outlive the target. Throws vk::SystemError.
  WindowTarget(const Gpu& gpu, const Window& window, std::uint32_t slots);
  ~WindowTarget() override;
  WindowTarget(const WindowTarget&) = delete;
  WindowTarget& operator=(const WindowTarget&) = delete;
  WindowTarget(WindowTarget&&) = delete;
  WindowTarget& operator=(WindowTarget&&) = delete;

  /// Fits images to the window's present size and to `share` of it along each side for the scene.
  /// False while the window has no size: then nothing can be drawn.
  bool fit(std::uint32_t width, std::uint32_t height, double share);

  /// @pre fit() was true
  Frame begin() override;

  /// Records the scene's way into the window's image, which is then a colour attachment.
  void stretch(const Frame& frame);

  /// Where panels are drawn, to be kept; they have to be after a change of size.
  [[nodiscard]] vk::ImageView panels_view() const { return *panels_.view; }
  [[nodiscard]] bool has_panels() const { return has_panels_; }
  /// Where those are that are to be drawn anew. @pre fit() was true
  void set_panels(std::span<const OverlayPanel> places);
  /// Before and after that.
  void begin_panels(const Frame& frame) const;
  void end_panels(const Frame& frame);
  /// Of the scene's picture, what lies between panels from top to bottom of the window.
  [[nodiscard]] vk::Rect2D visible() const;
  /// Copies the panels over the window's image, which is a colour attachment before and after.
  void place_panels(const Frame& frame);

  void finish(const Frame& frame) override;
  /// Also shows the picture.
  void submit(const Frame& frame) override;

  /// Of the scene's picture: as the window's bytes, and encoded when it is drawn.
  [[nodiscard]] vk::Format format() const override {
    return surface_format_.format == vk::Format::eB8G8R8A8Unorm ? vk::Format::eB8G8R8A8Srgb
                                                                : vk::Format::eR8G8B8A8Srgb;
  }
  [[nodiscard]] vk::Extent2D extent() const override { return inner_; }

  [[nodiscard]] vk::Format window_format() const { return surface_format_.format; }
  [[nodiscard]] vk::Extent2D window_extent() const { return outer_; }
  [[nodiscard]] vk::ImageView window_view() const { return *shown_[current_].view; }

  /// The next picture, as shown, can be had from screenshot().
  void keep_next() { keep_ = true; }
  /// Waits for the picture that keep_next() asked for.
  Image screenshot();

  /// Waits until the last frame of `slot` is done.
  void wait(std::uint32_t slot);

 private:
  struct Slot {
    Image2d image;
    vk::raii::CommandPool pool = nullptr;
    vk::raii::CommandBuffers commands = nullptr;
    vk::raii::Fence done = nullptr;
    vk::raii::Semaphore acquired = nullptr;
  };
  struct Shown {
    vk::Image image;
    vk::raii::ImageView view = nullptr;
    vk::raii::Semaphore drawn = nullptr;
  };

  void make_surface();
  void make_swapchain(std::uint32_t width, std::uint32_t height);
  void make_inner(double share);
  [[nodiscard]] bool acquire(const Slot& slot);

  const Gpu* gpu_;
  const Window* window_;
  vk::raii::SurfaceKHR surface_ = nullptr;
  vk::SurfaceFormatKHR surface_format_;
  vk::raii::SwapchainKHR swapchain_ = nullptr;
  std::vector<Shown> shown_;
  std::vector<Slot> slots_;
  Image2d panels_;
  std::vector<vk::ImageCopy> panel_places_;
  std::uint32_t visible_from_ = 0;  // columns of the window
  std::uint32_t visible_to_ = 0;
  bool has_panels_ = false;
  std::uint32_t next_ = 0;
  std::uint32_t current_ = 0;  // of shown_
  vk::Extent2D outer_;
  vk::Extent2D inner_;
  bool stale_ = true;  // the swapchain no longer fits the window
  bool surface_lost_ = false;
  bool keep_ = false;
  std::optional<std::uint32_t> kept_slot_;
  Buffer kept_;
};

}  // namespace torsion::engine
