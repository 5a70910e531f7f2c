#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ecs/result.hpp"

namespace torsion::engine {

/// Keys with a name; letters and digits are their ASCII capitals.
inline constexpr int kKeySpace = ' ';
inline constexpr int kKeyEscape = 256;
inline constexpr int kKeyEnter = 257;
inline constexpr int kKeyTab = 258;
inline constexpr int kKeyBackspace = 259;
inline constexpr int kKeyDelete = 261;
inline constexpr int kKeyRight = 262;
inline constexpr int kKeyLeft = 263;

/// What a person did with a window since the last look.
struct WindowInput {
  double mouse_x = 0.0;  // pixels of the window's picture, from the left edge
  double mouse_y = 0.0;  // from the top
  double desk_x = 0.0;   // the same from the desktop's corner where that is known: it stays
  double desk_y = 0.0;   // where it is while the window goes away under a mouse at rest
  std::array<bool, 3> buttons{};  // held down: left, right, middle
  double wheel = 0.0;             // notches, away from the person positive
  bool shift = false;
  bool alt = false;
  bool control = false;
  bool hidden = false;       // minimised, or of no size
  bool close = false;        // the window is asked to close
  std::vector<int> pressed;  // keys that went down, in order
  std::uint32_t width = 0;   // pixels
  std::uint32_t height = 0;
};

/// A window on the desktop. One at a time, from the main thread.
class Window {
 public:
  /// Fails where there is no display.
  static Result<Window> open(const std::string& title, std::uint32_t width, std::uint32_t height);
  Window(Window&&) noexcept;
  Window& operator=(Window&&) noexcept;
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window();

  /// Takes in what happened; with `wait` [s] > 0 sleeps until something does, at most so long.
  const WindowInput& look(double wait = 0.0);

  /// As the last look() had it.
  [[nodiscard]] const WindowInput& input() const;

  void set_title(const std::string& title);

  /// GLFWwindow*, for render/ alone.
  [[nodiscard]] void* handle() const;

 private:
  struct Impl;
  explicit Window(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Whether a window could be opened: an X or Wayland display is named.
bool has_display();

}  // namespace torsion::engine
