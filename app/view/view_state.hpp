#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/live/live_session.hpp"
#include "app/view/gallery.hpp"
#include "app/view/gui_atlas.hpp"
#include "app/view/history.hpp"
#include "app/view/orbit_camera.hpp"
#include "app/view/region_history.hpp"
#include "app/view/turn_ring.hpp"
#include "render/draw_options.hpp"

namespace torsion::engine {

/// A motion that a held tool is told to make, in the scene's time: along the contact's normal,
/// about it, and across it, eased.
struct ToolMove {
  double press = 0.0;    // m, into the body
  double turn = 0.0;     // rad, counter-clockwise seen from outside
  double slide = 0.0;    // m, along the contact's first tangent
  double seconds = 2.0;  // s
};

/// A motion that goes on: knobs beside the limit of friction.
struct ToolSpeeds {
  double slide = 0.0;  // m/s
  double spin = 0.0;   // rad/s

  [[nodiscard]] bool any() const { return slide != 0.0 || spin != 0.0; }
};

/// A ring that a tool can be turned by.
struct RingMark {
  std::uint32_t tool = 0;
  TurnRing ring;
  bool under_mouse = false;
  double angle = 0.0;            // rad: of the place under the mouse
  std::optional<double> turned;  // rad: since the mouse took it; none: it has not
};

/// What a person has set in the window, and what the window shows of the session. The panels read
/// and write it; the viewer acts on the `wants_`.
struct ViewState {
  DrawOptions draw;
  bool show_panels = true;
  std::optional<bool> folded;  // the panel, to icons; none: by the window's size
  bool show_regions = true;
  bool show_cells = false;
  bool show_anchors = false;
  bool show_fixed = false;
  bool show_legend = true;
  bool contact_axes = true;    // plots along the contact's axes, else the world's
  double plot_seconds = 10.0;  // s: as far back as plots go
  bool over_plot = false;      // the mouse is, so that the wheel is the plot's
  bool paused = false;
  std::uint32_t slowness = 1;   // periods of the clock to a step
  std::uint32_t tool = 0;       // of the plots
  std::uint32_t body = 0;       // of the choice of models
  std::vector<BodyPick> picks;  // (bodies) as chosen, taken over by wants_choice

  bool wants_step = false;
  bool wants_restart = false;
  bool wants_choice = false;
  bool wants_screenshot = false;
  bool wants_saved_recording = false;
  bool wants_release = false;
  bool wants_video = false;                // begins one, or ends the one under way
  bool wants_view = false;                 // the camera as at first
  bool wants_move = false;                 // of the tool of the plots
  bool wants_strength = false;             // of the mouse: takes over `strength`
  std::optional<std::size_t> wants_entry;  // of the gallery: another scene

  bool free_drag = false;  // the mouse moves a tool in the plane of the view, not by the normal
  double strength = kGentleForce;  // N: the largest force of the mouse
  ToolMove move;                   // as typed
  bool moving = false;             // one is under way
  ToolSpeeds speeds;
  bool let_go = false;           // of the tool of the plots, which stays where it is
  std::optional<Pose> handle;    // where the tool of the plots is held; none: nobody holds it
  std::optional<RingMark> ring;  // of the tool that the mouse is near

  bool loop = true;                   // the scene begins again after its animation
  std::vector<GalleryEntry> gallery;  // scenes to choose from
  std::vector<CardPictures> cards;    // (gallery)
  bool all_cards = false;             // the gallery shows more than three rows
  std::optional<std::size_t> entry;   // which of them is shown; none: a scene of one's own
  bool opening = false;               // another scene is being read and prepared

  OrbitCamera camera;
  std::vector<History> histories;               // (tools)
  std::vector<RegionHistory> region_histories;  // (tools)
  std::string message;                          // what was just done, shown for a while
  double message_until = 0.0;                   // s, of the window's clock
  std::string scene_error;  // why the file on disk cannot be shown; empty: it can
  double frames_per_second = 0.0;
  double share = 1.0;    // of the window's pixels along each side in which the scene is drawn
  bool grabbed = false;  // the mouse has a tool
  std::uint32_t missed_lately = 0;  // deadlines in the last second
};

/// The number of BodyPick's models and materials that differ.
bool differ(const std::vector<BodyPick>& a, const std::vector<BodyPick>& b);

/// Periods of the clock to a step, after these: 1, 5, 20, 100, 1, ...
std::uint32_t next_slowness(std::uint32_t slowness);

}  // namespace torsion::engine
