#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/live/interrupt.hpp"
#include "app/live/live_session.hpp"
#include "app/live/thread_starter.hpp"
#include "app/view/gallery.hpp"
#include "app/view/gui.hpp"
#include "app/view/scene_watch.hpp"
#include "app/view/tool_drag.hpp"
#include "app/view/view_state.hpp"
#include "render/arrows.hpp"
#include "render/renderer.hpp"
#include "render/video.hpp"
#include "render/window.hpp"

namespace torsion::engine {

struct ViewerOptions {
  std::string scene;
  std::vector<GalleryEntry> gallery;  // other scenes that the window offers
  PrepareOptions prepare;
  DeviceChoice device;     // what holds a tool; empty: what the scene says
  double seconds = -1.0;   // s: closes by itself after that; negative: when the person does
  std::string record;      // file to write the recording to; empty: none
  std::string screenshot;  // file to write the last picture to; empty: none
};

/// What a session in a window was like.
struct ViewerOutcome {
  RunStatistics statistics;
  std::string mode;
  std::uint64_t frames = 0;
  std::uint64_t loops = 0;           // how often a scene began again after its animation
  double seconds = 0.0;              // that the window was open
  double opened_after = 0.0;         // s: from the scene being ready to the first picture
  double share = 1.0;                // inner resolution at the end
  PassTimes passes;                  // ms a picture, the mean
  std::optional<DeviceView> device;  // that held a tool at the end
  std::string problem;  // why there is no recording; empty: there is, or none was wanted
};

/// The largest so far of what is drawn to scale.
struct SeenScales {
  double twist = 0.0;     // rad
  double pressure = 0.0;  // Pa
  ArrowLimits arrows;
};

// Pixels, at first.
inline constexpr std::uint32_t kWindowWidth = 1280;
inline constexpr std::uint32_t kWindowHeight = 720;

std::string window_title(const std::string& scene);
/// Of a file beside the person, for messages.
std::string whole_path(const std::string& name);

/// A scene in a window. Everything is in the main thread but physics, and what prepares worlds.
class Viewer {
 public:
  explicit Viewer(ViewerOptions options);
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;
  Viewer(Viewer&&) = delete;
  Viewer& operator=(Viewer&&) = delete;

  /// Until the window is closed. Fails where the scene, the display or Vulkan does.
  Result<ViewerOutcome> run();

 private:
  struct Grab {
    ToolDrag drag;
    bool on_tool = false;
    bool on_ring = false;  // and the tool is turned by it
    bool orbiting = false;
    bool panning = false;
    bool spent = false;      // the button is still down from a drag that a hidden window ended
    glm::dvec2 mouse{0.0};   // pixels of the desktop
    glm::dvec3 pivot{0.0};   // m, world: of the tool's contact when it was taken
    glm::dvec3 axis{0.0};    // world, unit: its normal
    double turn_left = 0.0;  // rad: of the wheel, still to be made
    RingMark ring;
    glm::dvec2 ring_mouse{0.0};  // pixels of the window, last seen
  };

  /// A typed motion under way.
  struct Move {
    ToolMove asked;
    std::uint32_t tool = 0;
    Pose start;
    glm::dvec3 pivot{0.0};    // m, world
    glm::dvec3 axis{0.0};     // world, unit, out of the body
    glm::dvec3 tangent{0.0};  // world, unit
    double begun = 0.0;       // s, of the scene
  };

  /// A video under way.
  struct Film {
    std::optional<VideoWriter> writer;
    std::string name;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    bool panels = true;  // were shown before
    double begun = 0.0;  // s
    std::uint64_t pictures = 0;
  };

  /// What stays when another session begins.
  enum class Keep : std::uint32_t { kNothing, kView };

  Result<Done> begin(Session session, Keep keep);
  void place_camera();
  void look_at_scene();
  Result<Done> make_renderer();
  Result<Done> frame();
  [[nodiscard]] bool panels_due(const WindowInput& input);
  Result<Done> show(const WindowInput& input, const OverlayDrawList& overlay);
  void add_passes();
  void begin_or_end_film();
  [[nodiscard]] bool film_due() const;
  void add_to_film();
  void end_film(const std::string& why);
  Result<Done> write_screenshot(const std::string& path);
  Result<ViewerOutcome> finish();
  void take_keys(const WindowInput& input);
  void take_mouse(const WindowInput& input, double seconds);
  void look_for_ring(const glm::dvec2& mouse, const glm::dvec2& picture);
  void start_drag(const glm::dvec2& mouse, const glm::dvec2& picture);
  void take_tool(std::uint32_t tool, double depth);
  void turn_ring(const WindowInput& input);
  void drag_tool(const WindowInput& input, double seconds);
  void begin_move();
  void let_go();
  void go_on_moving();
  void begin_drive();
  void stop_driving();
  void go_on_driving();
  void take_wishes();
  void take_history();
  void loop_scene();
  void watch_scene();
  void open_in_background(const std::string& scene);
  void open_chosen_scene();
  Result<Done> take_opened();
  void fit_share(double frame_seconds);
  void say(const std::string& text);
  [[nodiscard]] double now() const;
  /// In the middle of what the panel leaves free.
  [[nodiscard]] Camera camera() const;
  /// The frame in which a tool is pressed and turned: that of its oldest contact, or else the
  /// nearest place of a body's surface.
  struct ContactAxes {
    glm::dvec3 pivot{0.0};              // m, world
    glm::dvec3 normal{0.0, 1.0, 0.0};   // world, unit, out of the body
    glm::dvec3 tangent{1.0, 0.0, 0.0};  // world, unit
  };
  [[nodiscard]] ContactAxes axes_under(std::uint32_t tool) const;
  /// A tool whose box is under the mouse, and how far ahead, m.
  struct UnderMouse {
    std::uint32_t tool = 0;
    double depth = 0.0;
  };
  [[nodiscard]] std::optional<UnderMouse> tool_under(const glm::dvec2& mouse,
                                                     const glm::dvec2& picture) const;
  [[nodiscard]] std::string file_name(const std::string& extension);

  ViewerOptions options_;
  std::optional<Interrupt> interrupt_;    // a device is let go of whatever ends the program
  std::optional<ThreadStarter> starter_;  // of threads that drawing makes way for
  std::optional<Window> window_;
  std::unique_ptr<Gui> gui_;
  std::unique_ptr<LiveSession> session_;
  std::optional<Renderer> renderer_;
  ViewState state_;
  ViewerOutcome outcome_;
  Grab grab_;
  std::optional<Move> move_;
  std::optional<ToolDrive> drive_;
  std::vector<Pose> handles_;  // (tools) where they are held
  std::optional<SceneWatch> watch_;
  Film film_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double last_frame_ = 0.0;        // s
  double next_look_ = 0.0;         // s: at the file
  double next_fit_ = 0.0;          // s: of the share
  double next_panels_ = 0.0;       // s: until then they stay as they are
  glm::dvec2 panels_mouse_{0.0};   // where the mouse was when they were drawn
  double shown_frame_time_ = 0.0;  // s, smoothed
  double missed_since_ = 0.0;      // s
  SeenScales seen_;
  double let_go_until_ = 0.0;  // s, of the scene: a tool is on the way back to its animation
  std::uint64_t missed_then_ = 0;
  std::uint64_t passes_timed_ = 0;
  int files_written_ = 0;

  std::thread opener_;   // reads and prepares a scene
  std::string opening_;  // its file
  std::atomic<bool> opened_done_ = false;
  std::optional<Result<Session>> opened_;
};

}  // namespace torsion::engine
