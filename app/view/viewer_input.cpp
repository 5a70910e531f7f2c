// What a person does with keys and mouse.

#include <optional>

#include <glm/geometric.hpp>

#include "app/view/viewer.hpp"

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
        state_.slowness = state_.slowness == 1    ? 5
                          : state_.slowness == 5  ? 20
                          : state_.slowness == 20 ? 100
                                                  : 1;
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

void Viewer::turn_axis(std::uint32_t tool, glm::dvec3& pivot, glm::dvec3& axis) const {
  const Snapshot& snapshot = session_->frame().snapshot;
  const World& world = session_->shown().simulation.world;
  if (const auto region = region_of(snapshot, tool)) {
    const Pose& body =
        world.model.bodies.at<Pose>(snapshot.regions.at<RegionIdentity>(*region).body);
    axis = body.rotation * snapshot.regions.at<RegionFrame>(*region).normal;
    pivot = body.position + body.rotation * snapshot.regions.at<Contact>(*region).equivalent_point;
    return;
  }
  axis = glm::dvec3(0.0, 1.0, 0.0);
  pivot = snapshot.tools.at<ToolMotion>(tool).mass_center;
}

void Viewer::start_drag(const glm::dvec2& mouse, const glm::dvec2& picture) {
  const Camera from = camera();
  const PixelRay ray = ray_through(from, mouse, picture);
  const World& world = session_->shown().simulation.world;
  const auto& tools = session_->frame().snapshot.tools;
  double nearest = 1e300;
  for (std::uint32_t tool = 0; tool < tools.size(); ++tool) {
    if (session_->on_device(tool)) {
      continue;
    }
    const auto met =
        meets_box(ray, tools.at<ToolPose>(tool).now, world.model.tools.at<Bounds>(tool));
    if (met && *met < nearest) {
      nearest = *met;
      const glm::dvec3 ahead = from.pose.rotation * glm::dvec3(0.0, 0.0, -1.0);
      grab_.drag = {tool, *met * glm::dot(ray.direction, ahead), grab_.mouse};
      grab_.on_tool = true;
    }
  }
  grab_.orbiting = !grab_.on_tool;
  if (grab_.on_tool) {
    const std::uint32_t tool = grab_.drag.tool;
    if (!session_->held(tool)) {
      handles_[tool] = tools.at<ToolPose>(tool).now;
    }
    state_.tool = tool;
    session_->hold(tool, handles_[tool]);
  }
}

void Viewer::drag_tool(const WindowInput& input) {
  const std::uint32_t tool = grab_.drag.tool;
  glm::dvec3 pivot;
  glm::dvec3 axis;
  turn_axis(tool, pivot, axis);
  Pose& handle = handles_[tool];
  const DragKind kind = input.alt     ? DragKind::kTurn
                        : input.shift ? DragKind::kAlong
                                      : DragKind::kAcross;
  drag(grab_.drag, kind, grab_.mouse, camera(), input.height, pivot, axis, handle);
  if (input.wheel != 0.0) {
    turn(handle, pivot, axis, kRadiansANotch * input.wheel);
  }
  session_->hold(tool, handle);
}

void Viewer::take_mouse(const WindowInput& input) {
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
  if (free && !Gui::has_mouse()) {
    if (input.buttons[0] && !grab_.spent) {
      start_drag(mouse, {input.width, input.height});
    }
    grab_.panning = !grab_.on_tool && (input.buttons[1] || input.buttons[2]);
    if (input.wheel != 0.0) {
      zoom(state_.camera, input.wheel);
    }
  } else if (grab_.on_tool) {
    drag_tool(input);
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
