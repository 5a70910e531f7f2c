#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <imgui.h>

#include "app/view/legend.hpp"
#include "app/view/panel_style.hpp"
#include "app/view/panels.hpp"

namespace torsion::engine {
namespace {

constexpr ImU32 kRegion = IM_COL32(20, 20, 20, 220);
constexpr ImU32 kAnchor = IM_COL32(120, 40, 160, 255);
constexpr ImU32 kHand = IM_COL32(39, 111, 196, 255);
constexpr ImU32 kFaintHand = IM_COL32(39, 111, 196, 150);
constexpr ImU32 kFixedPoint = IM_COL32(60, 60, 70, 255);
constexpr std::uint32_t kMostFixed = 400;  // dots

struct Pencil {
  ImDrawList& list;
  Camera camera;
  glm::dvec2 picture;

  void dot(const glm::dvec3& place, float radius, ImU32 color) const {
    const glm::dvec3 at = seen_at(camera, place, picture);
    if (at.z > camera.near_plane) {
      list.AddCircleFilled(ImVec2(static_cast<float>(at.x), static_cast<float>(at.y)), radius,
                           color, 6);
    }
  }
  /// Below a place.
  void label(const glm::dvec3& place, const std::string& words) const {
    const glm::dvec3 at = seen_at(camera, place, picture);
    if (at.z > camera.near_plane) {
      const ImVec2 size = ImGui::CalcTextSize(words.c_str());
      const ImVec2 low(std::round(static_cast<float>(at.x) - 0.5F * size.x),
                       std::round(static_cast<float>(at.y)));
      list.AddRectFilled(ImVec2(low.x - 2.0F, low.y), ImVec2(low.x + size.x + 2.0F, low.y + size.y),
                         IM_COL32(255, 255, 255, 220));
      list.AddText(low, kRegion, words.c_str());
    }
  }
  void line(const glm::dvec3& from, const glm::dvec3& to, ImU32 color, float width = 1.5F) const {
    const glm::dvec3 a = seen_at(camera, from, picture);
    const glm::dvec3 b = seen_at(camera, to, picture);
    if (a.z > camera.near_plane && b.z > camera.near_plane) {
      list.AddLine(ImVec2(static_cast<float>(a.x), static_cast<float>(a.y)),
                   ImVec2(static_cast<float>(b.x), static_cast<float>(b.y)), color, width);
    }
  }
};

glm::dvec3 in_world(const Pose& pose, const glm::dvec3& point) {
  return pose.position + pose.rotation * point;
}

/// A ring around the contact with a stroke along the normal, and one that shows the turn.
void draw_region(const Pencil& pencil, const LiveFrame& frame, std::uint32_t region) {
  constexpr int kSides = 32;
  const RegionTable& regions = frame.snapshot.regions;
  const Pose& body =
      frame.snapshot.bodies.at<BodyPose>(regions.at<RegionIdentity>(region).body).now;
  const RegionFrame& axes = regions.at<RegionFrame>(region);
  const Contact& contact = regions.at<Contact>(region);
  const auto on_ring = [&](double angle) {
    return in_world(body,
                    contact.equivalent_point + contact.radius * (std::cos(angle) * axes.tangent_x +
                                                                 std::sin(angle) * axes.tangent_y));
  };
  for (int i = 0; i < kSides; ++i) {
    const double step = 2.0 * std::numbers::pi / kSides;
    pencil.line(on_ring(i * step), on_ring((i + 1) * step), kRegion);
  }
  const glm::dvec3 center = in_world(body, contact.equivalent_point);
  pencil.line(center, in_world(body, contact.equivalent_point + 1.5 * contact.radius * axes.normal),
              kRegion);
  pencil.line(center, on_ring(regions.at<RegionMotion>(region).turn), kRegion);
  if (regions.size() > 1) {
    pencil.label(on_ring(-0.5 * std::numbers::pi),
                 std::to_string(regions.at<RegionIdentity>(region).order + 1));
  }
}

void draw_fixed(const Pencil& pencil, const FrameWorld& frame) {
  for (std::uint32_t body = 0; body < frame.bodies.size(); ++body) {
    const Pose& pose = frame.bodies.at<Pose>(body);
    const auto rest =
        frame.body_vertices.rows<VertexRest>(frame.bodies.at<DrawRange>(body).vertices);
    const std::size_t stride = rest.size() / kMostFixed + 1;
    for (std::size_t i = 0; i < rest.size(); i += stride) {
      if (rest[i].position.w > 0.5F) {
        pencil.dot(in_world(pose, glm::dvec3(rest[i].position)), 2.0F, kFixedPoint);
      }
    }
  }
}

void draw_anchors(const Pencil& pencil, const LiveFrame& frame, const World& world) {
  for (std::uint32_t body = 0; body < world.model.bodies.size(); ++body) {
    const Pose& pose = frame.snapshot.bodies.at<BodyPose>(body).now;
    const Range rows = world.model.bodies.at<OwnedRows>(body).anchors;
    const auto rest = world.model.anchors.rows<AnchorRest>(rows);
    const auto moved = frame.snapshot.anchors.rows<AnchorMotion>(rows);
    for (std::size_t i = 0; i < rest.size(); ++i) {
      pencil.dot(in_world(pose, rest[i].position + moved[i].displacement), 3.0F, kAnchor);
    }
  }
}

/// The spring between the hand and the tool that it holds, from mass centre to where it should be.
void draw_hand(const Pencil& pencil, const LiveFrame& frame, std::uint32_t tool,
               const Pose& handle) {
  constexpr int kTurns = 12;
  const Pose& now = frame.snapshot.tools.at<ToolPose>(tool).now;
  const glm::dvec3 from = frame.snapshot.tools.at<ToolMotion>(tool).mass_center;
  const glm::dvec3 to = in_world(handle, glm::conjugate(now.rotation) * (from - now.position));
  const glm::dvec3 side = pencil.camera.pose.rotation * glm::dvec3(1.0, 0.0, 0.0);
  const double width = 0.06 * glm::length(to - from);
  glm::dvec3 last = from;
  for (int i = 1; i <= kTurns; ++i) {
    const double sign = i == kTurns ? 0.0 : (i % 2 == 0 ? 1.0 : -1.0);
    const glm::dvec3 next =
        glm::mix(from, to, static_cast<double>(i) / kTurns) + sign * width * side;
    pencil.line(last, next, kHand);
    last = next;
  }
  pencil.dot(to, 4.0F, kHand);
}

/// A ring to turn the tool by, bold where the mouse is on it; then how far it was turned.
void draw_ring(const Pencil& pencil, const RingMark& mark) {
  constexpr int kSides = 72;
  constexpr double kStep = 2.0 * std::numbers::pi / kSides;
  const bool bold = mark.under_mouse || mark.turned;
  const ImU32 color = bold ? kHand : kFaintHand;
  for (int i = 0; i < kSides; ++i) {
    pencil.line(mark.ring.at(i * kStep), mark.ring.at((i + 1) * kStep), color, bold ? 4.0F : 2.5F);
  }
  if (bold) {
    pencil.dot(mark.ring.at(mark.angle), 6.0F, kHand);
  }
  if (mark.turned) {
    const double from = mark.angle - *mark.turned;
    pencil.line(mark.ring.center, mark.ring.at(from), kHand);
    pencil.line(mark.ring.center, mark.ring.at(mark.angle), kHand);
    pencil.label(mark.ring.at(mark.angle),
                 fmt::format("{:.1f}\u00B0", *mark.turned * 180.0 / std::numbers::pi));
  }
}

}  // namespace

void draw_marks(const ViewState& state, LiveSession& session, const Camera& camera,
                const glm::dvec2& picture) {
  const LiveFrame& frame = session.frame();
  const Generation& shown = session.shown();
  const Pencil pencil{*ImGui::GetBackgroundDrawList(), camera, picture};
  if (state.show_fixed) {
    draw_fixed(pencil, shown.frame);
  }
  if (state.show_anchors) {
    draw_anchors(pencil, frame, shown.simulation.world);
  }
  if (state.show_cells) {
    for (const CellMark& cell : frame.cells) {
      pencil.dot(glm::dvec3(cell.place), 3.0F, kSticksInk);
      if (cell.sticks == 0) {
        pencil.dot(glm::dvec3(cell.place), 2.2F, kSlipsInk);
      }
    }
  }
  if (state.handle) {
    draw_hand(pencil, frame, state.tool, *state.handle);
  }
  if (state.ring) {
    draw_ring(pencil, *state.ring);
  }
  for (std::uint32_t region = 0; state.show_regions && region < frame.snapshot.regions.size();
       ++region) {
    draw_region(pencil, frame, region);
  }
  if (state.show_legend && state.show_panels) {
    draw_legend(state, picture);
  }
}

}  // namespace torsion::engine
