#pragma once

#include <cstdint>

#include "render/overlay_draw_list.hpp"
#include "render/window.hpp"

struct ImDrawCmd;
struct ImDrawList;

namespace torsion::engine {

/// Dear ImGui, fed with a window's input and drawn as an overlay. One at a time; between begin()
/// and end() the caller builds its panels with ImGui's functions.
class Gui {
 public:
  Gui();
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;
  Gui(Gui&&) = delete;
  Gui& operator=(Gui&&) = delete;

  /// Its glyphs, for RendererOptions::overlay_atlas.
  [[nodiscard]] const OverlayAtlas& atlas() const { return atlas_; }

  /// @param seconds  since the last frame
  void begin(const WindowInput& input, double seconds);
  /// What to draw; valid until the next end().
  const OverlayDrawList& end();

  /// Whether the mouse is over a panel, which then has it.
  [[nodiscard]] static bool has_mouse();
  /// Whether a number is being typed.
  [[nodiscard]] static bool has_keyboard();

 private:
  void append(const ImDrawCmd& command, const ImDrawList& from, std::uint32_t base_vertex);
  void append_panel(const ImDrawList& from);
  OverlayAtlas atlas_;
  OverlayDrawList list_;
};

}  // namespace torsion::engine
