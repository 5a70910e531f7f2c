// What a person does with keys and mouse.

#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "app/view/viewer.hpp"
#include "systems/geometry/distance.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion::engine {
namespace {

constexpr double kRadiansAPixelOfOrbit = 0.006;

/// The oldest region of a tool in a snapshot; nothing without contact.
std::optional<std::uint32_t> region_of(const Snapshot& snapshot, std::uint32_t tool) {
  for (std::uint32_t region = 0; region < snapshot.regions.size(); ++region) {
    if (snapshot.regions.at<RegionIdentity>(region).tool == tool) {
      return region;
    }
  }
  return std::nullopt;
}

}  // namespace

void Viewer::take_keys(const WindowInput& input) {
  if (Gui::has_keyboard()) {
    return;
  }
  for (const int key : input.pressed) {
    switch (key) {
      case kKeySpace:
        state_.paused = !state_.paused;
        break;
      case 'N':
        state_.wants_step = true;
        break;
      case 'R':
        state_.wants_restart = true;
        break;
      case 'S':
        state_.slowness = next_slowness(state_.slowness);
        break;
      case 'P':
        state_.wants_screenshot = true;
        break;
      case 'V':
        state_.wants_video = true;
        break;
      case 'O':
        state_.wants_saved_recording = true;
        break;
      case 'M':
        state_.wants_choice = true;
        break;
      case 'G':
        state_.wants_release = true;
        break;
      case 'F':
        state_.free_drag = !state_.free_drag;
        break;
      case 'C':
        state_.wants_view = true;
        break;
      case 'L':
        state_.loop = !state_.loop;
        break;
      case 'H':
        state_.show_panels = !state_.show_panels;
        break;
      default:
        if (key >= '1' && key <= '9') {
          state_.wants_entry = static_cast<std::size_t>(key - '1');
        }
        break;
    }
  }
}

Viewer::ContactAxes Viewer::axes_under(std::uint32_t tool) const {
  const Snapshot& snapshot = session_->frame().snapshot;
  const Model& model = session_->shown().simulation.world.model;
  if (const auto region = region_of(snapshot, tool)) {
    const Pose& body =
        snapshot.bodies.at<BodyPose>(snapshot.regions.at<RegionIdentity>(*region).body).now;
    const RegionFrame& frame = snapshot.regions.at<RegionFrame>(*region);
    return {to_outer(body, snapshot.regions.at<Contact>(*region).equivalent_point),
            body.rotation * frame.normal, body.rotation * frame.tangent_x};
  }
  ContactAxes axes;
  axes.pivot = snapshot.tools.at<ToolMotion>(tool).mass_center;
  double nearest = 1e300;
  for (std::uint32_t row = 0; row < model.bodies.size(); ++row) {
    const Pose& body = snapshot.bodies.at<BodyPose>(row).now;
    const Distance distance =
        signed_distance(model, model.bodies.at<OwnedRows>(row).parts, to_inner(body, axes.pivot));
    const double length = glm::length(distance.gradient);
    if (distance.value < nearest && length > 0.0) {
      nearest = distance.value;
      axes.normal = body.rotation * (distance.gradient / length);
    }
  }
  RegionFrame frame;
  turn_normal_to(frame, axes.normal);
  axes.tangent = frame.tangent_x;
  return axes;
}

std::optional<Viewer::UnderMouse> Viewer::tool_under(const glm::dvec2& mouse,
                                                     const glm::dvec2& picture) const {
  const Camera from = camera();
  const PixelRay ray = ray_through(from, mouse, picture);
  const glm::dvec3 ahead = from.pose.rotation * glm::dvec3(0.0, 0.0, -1.0);
  const World& world = session_->shown().simulation.world;
  const auto& tools = session_->frame().snapshot.tools;
  std::optional<UnderMouse> found;
  double nearest = 1e300;
  for (std::uint32_t tool = 0; tool < tools.size(); ++tool) {
    if (session_->on_device(tool) && !session_->carries(tool)) {
      continue;
    }
    const auto met =
        meets_box(ray, tools.at<ToolPose>(tool).now, world.model.tools.at<Bounds>(tool));
    if (met && *met < nearest) {
      nearest = *met;
      found = UnderMouse{tool, *met * glm::dot(ray.direction, ahead)};
    }
  }
  return found;
}

/// The ring of the tool under the mouse, or else of the tool of the plots where that is held or the
/// mouse is on its ring.
void Viewer::look_for_ring(const glm::dvec2& mouse, const glm::dvec2& picture) {
  constexpr double kReach = 9.0;  // pixels
  const auto under = tool_under(mouse, picture);
  const std::uint32_t tool = under ? under->tool : state_.tool;
  if (session_->on_device(tool)) {
    return;
  }
  const ContactAxes axes = axes_under(tool);
  RingMark mark;
  mark.tool = tool;
  mark.ring = ring_around(session_->frame().snapshot.tools.at<ToolPose>(tool).now,
                          session_->shown().simulation.world.model.tools.at<Bounds>(tool),
                          axes.pivot, axes.normal, axes.tangent);
  const auto angle = angle_on(mark.ring, camera(), mouse, picture, kReach);
  mark.under_mouse = angle.has_value();
  mark.angle = angle.value_or(0.0);
  if (under || angle || session_->held(tool)) {
    state_.ring = mark;
  }
}

void Viewer::start_drag(const glm::dvec2& mouse, const glm::dvec2& picture) {
  if (state_.ring && state_.ring->under_mouse) {
    take_tool(state_.ring->tool, 0.0);
    grab_.on_ring = true;
    grab_.ring = *state_.ring;
    grab_.ring.turned = 0.0;
    grab_.ring_mouse = mouse;
  } else if (const auto under = tool_under(mouse, picture)) {
    take_tool(under->tool, under->depth);
  }
  grab_.orbiting = !grab_.on_tool;
}

/// @param depth  m: of the place taken, before the camera
void Viewer::take_tool(std::uint32_t tool, double depth) {
  grab_.drag = {tool, depth, grab_.mouse};
  grab_.on_tool = true;
  grab_.on_ring = false;
  const bool carries = session_->carries(tool);
  if (carries) {
    handles_[tool] = session_->device()->outcome.handle;
  } else if (!session_->held(tool)) {
    handles_[tool] = session_->take(tool);
  }
  state_.tool = tool;
  const ContactAxes axes = axes_under(tool);
  grab_.pivot = axes.pivot;
  grab_.axis = axes.normal;
  grab_.turn_left = 0.0;
  move_.reset();
  stop_driving();
  state_.let_go = false;
  if (!carries) {
    session_->hold(tool, handles_[tool]);
  }
}

/// Turns the tool as the mouse turns its ring.
void Viewer::turn_ring(const WindowInput& input) {
  const glm::dvec2 mouse(input.mouse_x, input.mouse_y);
  RingMark& mark = grab_.ring;
  const double turned = turned_by(mark.ring, mark.angle, camera(), grab_.ring_mouse, mouse,
                                  {input.width, input.height});
  grab_.ring_mouse = mouse;
  mark.angle += turned;
  *mark.turned += turned;
  turn(handles_[grab_.drag.tool], grab_.pivot, grab_.axis, turned);
  state_.ring = mark;
}

/// Of every tool that the mouse has: an animated one goes on as its animation does, any other stays
/// where it is, without force.
void Viewer::let_go() {
  const Snapshot& snapshot = session_->frame().snapshot;
  move_.reset();
  stop_driving();
  grab_ = Grab{};
  grab_.spent = true;
  for (std::uint32_t tool = 0; tool < handles_.size(); ++tool) {
    if (!session_->held(tool)) {
      continue;
    }
    if (session_->scene().tools[tool].script.end_time > 0.0) {
      session_->release(tool);
      let_go_until_ = snapshot.clock.time + kReturnTime;
      say("let go of: the tool goes back to the scene's animation");
    } else {
      handles_[tool] = snapshot.tools.at<ToolPose>(tool).now;
      session_->hold(tool, handles_[tool]);
      state_.let_go = true;
      say("let go of: the tool stays where it is, without force");
    }
  }
}

void Viewer::drag_tool(const WindowInput& input, double seconds) {
  constexpr double kTurnTime = 0.08;  // s: in which the wheel's turn comes
  const std::uint32_t tool = grab_.drag.tool;
  Pose& handle = handles_[tool];
  const DragKind kind = input.alt           ? DragKind::kTurn
                        : !state_.free_drag ? (input.shift ? DragKind::kSlide : DragKind::kPress)
                                            : (input.shift ? DragKind::kAlong : DragKind::kAcross);
  // The handle itself stays on the axis as it slides.
  const glm::dvec3 before = handle.position;
  if (grab_.on_ring) {
    turn_ring(input);
  } else {
    drag(grab_.drag, kind, grab_.mouse, camera(), input.height, grab_.pivot, grab_.axis, handle);
    grab_.pivot += kind == DragKind::kTurn ? glm::dvec3(0.0) : handle.position - before;
  }
  if (session_->on_device(tool)) {
    if (session_->carries(tool) && kind != DragKind::kTurn) {
      session_->carry(tool, handle.position - before);  // it is turned by hand
    }
    return;
  }
  grab_.turn_left += kRadiansANotch * input.wheel;
  const double now_turned = grab_.turn_left * -std::expm1(-seconds / kTurnTime);
  grab_.turn_left -= now_turned;
  if (now_turned != 0.0) {
    turn(handle, grab_.pivot, grab_.axis, now_turned);
  }
  session_->hold(tool, handle);
}

/// Takes the tool of the plots, if nothing else has it, and begins the motion that was typed.
void Viewer::begin_move() {
  const std::uint32_t tool = state_.tool;
  if (grab_.on_tool || session_->on_device(tool)) {
    return;
  }
  const Snapshot& snapshot = session_->frame().snapshot;
  if (!session_->held(tool)) {
    handles_[tool] = session_->take(tool);
  }
  state_.let_go = false;
  stop_driving();
  const ContactAxes axes = axes_under(tool);
  move_ = Move{state_.move, tool,         handles_[tool],     axes.pivot,
               axes.normal, axes.tangent, snapshot.clock.time};
}

void Viewer::go_on_moving() {
  state_.moving = move_.has_value();
  if (!move_) {
    return;
  }
  const Move& move = *move_;
  const double time = session_->frame().snapshot.clock.time - move.begun;
  const double share = move.asked.seconds > 0.0 ? smooth_step(time / move.asked.seconds) : 1.0;
  Pose& handle = handles_[move.tool];
  handle = move.start;
  turn(handle, move.pivot, move.axis, share * move.asked.turn);
  handle.position += share * (move.asked.slide * move.tangent - move.asked.press * move.axis);
  session_->hold(move.tool, handle);
  if (share >= 1.0) {
    move_.reset();
  }
}

/// Takes the tool of the plots where it is, to slide and to spin it.
void Viewer::begin_drive() {
  constexpr double kShare = 0.25;  // of the tool's size: so wide is its way round
  const std::uint32_t tool = state_.tool;
  const Snapshot& snapshot = session_->frame().snapshot;
  if (!session_->held(tool)) {
    handles_[tool] = session_->take(tool);
  }
  state_.let_go = false;
  const ContactAxes axes = axes_under(tool);
  const Bounds& bounds = session_->shown().simulation.world.model.tools.at<Bounds>(tool);
  const glm::dvec3 size = bounds.highest - bounds.lowest;
  drive_ = ToolDrive{tool,
                     handles_[tool],
                     axes.pivot,
                     axes.normal,
                     axes.tangent,
                     0.5 * kShare * std::fmin(size.x, std::fmin(size.y, size.z)),
                     0.0,
                     0.0,
                     snapshot.clock.time};
}

void Viewer::stop_driving() {
  drive_.reset();
  state_.speeds = {};
}

void Viewer::go_on_driving() {
  if (grab_.on_tool || move_ || session_->on_device(state_.tool) ||
      (drive_ && drive_->tool != state_.tool)) {
    stop_driving();
  }
  if (state_.speeds.any() && !drive_) {
    begin_drive();
  }
  if (drive_) {
    handles_[drive_->tool] = drive_on(*drive_, state_.speeds.slide, state_.speeds.spin,
                                      session_->frame().snapshot.clock.time);
    session_->hold(drive_->tool, handles_[drive_->tool]);
    if (!state_.speeds.any()) {
      drive_.reset();  // it stays where it is
    }
  }
}

void Viewer::take_mouse(const WindowInput& input, double seconds) {
  // What is dragged follows the mouse on the desktop: a window that moves or changes its size takes
  // nothing with it.
  const glm::dvec2 mouse(input.mouse_x, input.mouse_y);
  const glm::dvec2 on_desk(input.desk_x, input.desk_y);
  const glm::dvec2 moved = on_desk - grab_.mouse;
  grab_.mouse = on_desk;
  if (input.hidden) {  // a release that comes now may never be heard of
    grab_.on_tool = false;
    grab_.orbiting = false;
    grab_.panning = false;
    grab_.spent = true;
  }
  const bool free = !grab_.on_tool && !grab_.orbiting && !grab_.panning;
  state_.ring.reset();
  if (free && !Gui::has_mouse()) {
    look_for_ring(mouse, {input.width, input.height});
    if (input.buttons[0] && !grab_.spent) {
      start_drag(mouse, {input.width, input.height});
    }
    grab_.panning = !grab_.on_tool && (input.buttons[1] || input.buttons[2]);
    if (input.wheel != 0.0) {
      zoom(state_.camera, input.wheel);
    }
  } else if (grab_.on_tool) {
    drag_tool(input, seconds);
  } else if (grab_.orbiting) {
    orbit(state_.camera, kRadiansAPixelOfOrbit * glm::dvec2(-moved.x, moved.y));
  } else if (grab_.panning) {
    pan(state_.camera, moved, input.height);
  }
  if (!input.buttons[0]) {
    grab_.on_tool = false;
    grab_.orbiting = false;
    grab_.spent = false;
  }
  grab_.panning = grab_.panning && (input.buttons[1] || input.buttons[2]);
  state_.grabbed = grab_.on_tool;
}

}  // namespace torsion::engine
