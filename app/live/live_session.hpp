#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/live/live_loop.hpp"
#include "app/live/recording_file.hpp"
#include "app/live/scene_device.hpp"

namespace torsion::engine {

/// N: what a hand keeps up without effort.
inline constexpr double kGentleForce = 20.0;

/// A scene under way: its physics thread, the handles of its tools, what was recorded of it, and
/// the preparation of other models beside it. All functions are for one thread, the window's.
class LiveSession {
 public:
  /// @param session  prepared with `options`, no step taken
  /// @param record   file to record to while it goes on; empty: only for save_recording()
  LiveSession(Session session, PrepareOptions options, std::filesystem::path record = {});
  ~LiveSession();
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;
  LiveSession(LiveSession&&) = delete;
  LiveSession& operator=(LiveSession&&) = delete;

  /// From the start on a device holds a tool, and no mouse does. @pre not started
  void give(SceneDevice device);
  /// Of that device, as of the last refresh(); null without one.
  [[nodiscard]] const DeviceView* device() const { return device_view_; }
  [[nodiscard]] bool on_device(std::uint32_t tool) const {
    return device_.link != nullptr && device_.tool == tool;
  }

  /// Whether a device holds the tool that turns it only, so that a mouse is to carry it.
  [[nodiscard]] bool carries(std::uint32_t tool) const;
  /// Carries it on. @pre carries(tool)
  void carry(std::uint32_t tool, const glm::dvec3& by);

  /// How tools are held, by a mouse or a device. @pre not started
  void hold_by(ToolHold way);
  [[nodiscard]] ToolHold way() const { return way_; }

  /// Starts the physics thread and waits until it knows what the system grants it.
  /// @param privileges  whether to ask for SCHED_FIFO and locked memory
  void start(bool privileges = true);

  /// Takes the newest frame, all inputs, and worlds that are ready. False: nothing new to show.
  bool refresh();
  [[nodiscard]] const LiveFrame& frame() const { return loop_.frames.front(); }
  /// The world that the newest frame is of, for what is constant in it, and what draws it.
  [[nodiscard]] Generation& shown() { return *generations_.front(); }
  [[nodiscard]] const Generation& shown() const { return *generations_.front(); }

  /// Every row since the last call, in order.
  template <class F>
  void take_rows(F&& f) {
    while (const auto row = loop_.rows.pop()) {
      f(*row);
    }
  }

  void pause(bool on) { send({LiveCommandKind::kPause, 0, on ? 1U : 0U, nullptr}); }
  void step_once() { send({LiveCommandKind::kStepOnce, 0, 0, nullptr}); }
  void slow_down(std::uint32_t periods) { send({LiveCommandKind::kSlowness, 0, periods, nullptr}); }
  void show_cells(bool on) { loop_.wants_cells.store(on, std::memory_order_relaxed); }

  /// Holds a tool at `handle`, through its coupling; an animation lets go of it.
  /// @pre no device has it
  void hold(std::uint32_t tool, const Pose& handle);
  /// Makes a tool's coupling ready for a hand that takes it: as strong as what the tool bears now
  /// asks for, where that is more than the mouse's strength.
  /// @return where that hand is to be, so that the tool stays where it is
  /// @pre no device has it
  Pose take(std::uint32_t tool);
  /// Lets go of a tool: within kReturnTime it is back on its animation's way.
  void release(std::uint32_t tool);
  [[nodiscard]] bool held(std::uint32_t tool) const { return held_[tool] != 0; }
  [[nodiscard]] const VirtualCoupling& coupling(std::uint32_t tool) const {
    return couplings_[tool];
  }

  /// The largest force of a mouse on any tool, N, as far as mouse_coupling() lets it.
  void set_strength(double strength);

  /// Prepares the scene with these in another thread, then goes over to it. `restart`: from the
  /// scene's start, else where the tools are. False while another preparation is under way.
  bool choose(const std::vector<BodyPick>& picks, bool restart);
  [[nodiscard]] bool preparing() const { return worker_.joinable(); }
  /// Whether the newest frame is of the world that was prepared last, and none is being prepared:
  /// the physics thread goes over to a world some steps after it is ready.
  [[nodiscard]] bool settled() const {
    return !preparing() && frame().generation == generations_.back()->number;
  }
  /// Why the last preparation failed; empty if it did not.
  [[nodiscard]] const std::string& preparation_error() const { return error_; }

  [[nodiscard]] const SceneDescription& scene() const { return session_.scene; }
  [[nodiscard]] const RealtimeMode& mode() const { return loop_.mode; }

  /// s: since the start, as far as it is recorded
  [[nodiscard]] double recorded_seconds() const;
  /// Why nothing is recorded any more; empty as long as it is. A restart tries again.
  [[nodiscard]] std::string recording_problem() const;
  /// Everything since the start, as of the last refresh(), in a file.
  Result<Done> save_recording(const std::filesystem::path& path);
  /// Ends the recording to the file that it was to go to. @pre there is one; nothing follows
  Result<Done> finish_recording();

 private:
  [[nodiscard]] VirtualCoupling own_coupling(std::uint32_t tool) const;
  void send(const LiveCommand& command) { loop_.commands.push(command); }
  void prepare_in_background(std::vector<BodyPick> picks);
  void take_prepared();
  void take_inputs();
  void begin_recording_of(const Recording& head);

  Session session_;  // its simulation is in the first generation
  PrepareOptions options_;
  LiveLoop loop_;
  std::vector<std::unique_ptr<Generation>> generations_;  // the shown one first
  std::vector<std::unique_ptr<HandleSlot>> slots_;
  SceneDevice device_;
  const DeviceView* device_view_ = nullptr;
  MouseCarry carry_;
  std::vector<std::uint64_t> samples_;  // so many were sent, one count a tool
  std::vector<std::uint8_t> held_;
  double strength_ = kGentleForce;  // N, of the mouse
  std::vector<VirtualCoupling> couplings_;
  ToolHold way_ = ToolHold::kMassless;
  std::filesystem::path record_;  // empty: to a file without a name
  std::optional<RecordingWriter> recording_;
  std::string recording_problem_;     // why that is not there
  std::uint64_t recorded_steps_ = 0;  // begun
  InputEntry last_entry_;             // of those
  std::thread physics_;

  std::thread worker_;
  std::unique_ptr<Generation> prepared_;  // the worker's, until done_
  Recording restarted_;                   // how the recording begins after a restart
  std::string worker_error_;
  std::atomic<bool> done_ = false;
  bool restart_ = false;
  std::uint64_t next_number_ = 1;
  std::string error_;
};

/// A coupling between a mouse, which feels nothing, and a tool: limited in force, and so that the
/// tool does not go deeper than the models hold; as soft as gives the largest force a third of the
/// tool's radius from where it is. Its torque overcomes the friction at that force.
/// @param radius    m: of the tool
/// @param strength  N: the largest force wanted
VirtualCoupling mouse_coupling(const SceneDescription& scene, double radius, double strength);

}  // namespace torsion::engine
