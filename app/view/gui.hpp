#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "app/view/gui_atlas.hpp"
#include "render/window.hpp"

struct ImDrawCmd;
struct ImDrawList;

namespace torsion::engine {

/// Dear ImGui, fed with a window's input and drawn as an overlay. One at a time; between begin()
/// and end() the caller builds its panels with ImGui's functions.
class Gui {
 public:
  /// @param pictures  for the panels to show; empty ones are left out
  explicit Gui(std::span<const Image> pictures);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;
  Gui(Gui&&) = delete;
  Gui& operator=(Gui&&) = delete;

  /// Glyphs and pictures, for RendererOptions::overlay_atlas.
  [[nodiscard]] const OverlayAtlas& atlas() const { return atlas_; }
  /// Where the pictures are in it, in their order.
  [[nodiscard]] const std::vector<CardPictures>& cards() const { return cards_; }

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
  std::vector<CardPictures> cards_;
  OverlayDrawList list_;
};

}  // namespace torsion::engine
