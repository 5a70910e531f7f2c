#include "app/picture_run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "app/round_up.hpp"
#include "device/scripted_motion.hpp"
#include "render/auto_camera.hpp"
#include "systems/contact/region_wrenches.hpp"
#include "systems/surface/surface_field.hpp"

namespace torsion::engine {
namespace {

/// In degrees a scale may also end at 15, 30, 45, 60, 90, 120 and 180.
double rounded_angle(double radians) {
  const double degrees = radians * 180.0 / std::numbers::pi;
  for (const double end : {15.0, 20.0, 30.0, 45.0, 60.0, 90.0, 120.0, 180.0}) {
    if (degrees > 10.0 && degrees <= end) {
      return end * std::numbers::pi / 180.0;
    }
  }
  return round_up(degrees) * std::numbers::pi / 180.0;
}

/// What a picture says of a size on a scale: what is left of a sum of rounding errors is zero.
double shown(double size, double full_scale) {
  return size < 1e-6 * full_scale ? 0.0 : size;
}

/// The largest sum of twist angles of any vertex.
double largest_twist(const FrameWorld& frame) {
  double largest = 0.0;
  for (std::uint32_t body = 0; body < frame.bodies.size(); ++body) {
    std::vector<glm::vec4> deformed(frame.bodies.at<DrawRange>(body).vertices.count);
    deform_vertices(frame, body, deformed);
    for (const glm::vec4& vertex : deformed) {
      largest = std::max(largest, static_cast<double>(std::abs(vertex.w)));
    }
  }
  return largest;
}

double largest_pressure(const World& world) {
  double largest = 0.0;
  for (std::uint32_t region = 0; region < world.state.regions.size(); ++region) {
    const double area = world.state.regions.at<Contact>(region).area;
    const double force = world.state.regions.at<RegionNormal>(region).force;
    largest = std::max(largest, area > 0.0 ? force / area : 0.0);
  }
  return largest;
}

}  // namespace

PictureScales find_scales(Session& session, std::uint64_t steps, std::uint64_t stride,
                          Progress& progress) {
  World& world = session.simulation.world;
  const State start = world.state;
  FrameWorld frame = prepare_frame(session.scene, world.model, world.state);
  Snapshot snapshot;
  snapshot.reserve(world.model, world.state);
  PictureScales scales;
  for (std::uint64_t i = 0; i < steps; ++i) {
    step_scripted(session);
    widen(scales.arrows, world.state.tools, world.state.regions);
    scales.pressure = std::max(scales.pressure, largest_pressure(world));
    if (i % stride == 0) {
      take_snapshot(session.simulation, snapshot);
      surface_field(world.model, snapshot, frame);
      scales.twist = std::max(scales.twist, largest_twist(frame));
      progress.show(static_cast<double>(i) / static_cast<double>(steps));
    }
  }
  world.state = start;
  const ArrowLimits& arrows = scales.arrows;
  return {rounded_angle(scales.twist),
          round_up(scales.pressure),
          {round_up(arrows.force), round_up(arrows.torque), round_up(arrows.couple)}};
}

Result<Camera> choose_camera(const Session& session, const FrameWorld& frame,
                             const std::string& node, double aspect) {
  const std::vector<CameraDescription>& cameras = session.scene.cameras;
  if (node.empty()) {
    return cameras.empty() ? auto_camera(frame, aspect, scripted_poses(session.scene))
                           : camera_of(cameras.front());
  }
  const auto found = std::ranges::find(cameras, node, &CameraDescription::node);
  if (found != cameras.end()) {
    return camera_of(*found);
  }
  std::string names;
  for (const CameraDescription& camera : cameras) {
    names += (names.empty() ? "" : ", ") + camera.node;
  }
  return Error{
      fmt::format("{}: there is no camera node \"{}\"; the file has {}; without --camera "
                  "a view of everything is chosen",
                  session.scene.path, node, names.empty() ? "none" : names)};
}

PictureRun::PictureRun(FrameWorld frame, Snapshot snapshot, Camera camera, Options options,
                       OverlayFont font, Renderer renderer)
    : frame_(std::move(frame)),
      snapshot_(std::move(snapshot)),
      camera_(camera),
      options_(std::move(options)),
      font_(std::move(font)),
      renderer_(std::move(renderer)) {}

Result<PictureRun> PictureRun::create(const Session& session, const Options& options) {
  const World& world = session.simulation.world;
  FrameWorld frame = prepare_frame(session.scene, world.model, world.state);
  Snapshot snapshot;
  snapshot.reserve(world.model, world.state);
  take_snapshot(session.simulation, snapshot);
  surface_field(world.model, snapshot, frame);
  const double aspect = static_cast<double>(options.width) / static_cast<double>(options.height);
  const Result<Camera> camera = choose_camera(session, frame, options.camera, aspect);
  if (!camera) {
    return camera.error();
  }
  Options as_shown = options;
  as_shown.draw.torque_parts = session.scene.view.torque_parts;
  as_shown.draw.grid = as_shown.draw.grid && session.scene.view.lines;
  OverlayFont font(overlay_text_height(options.height));
  RendererOptions renderer_options;
  renderer_options.width = options.width;
  renderer_options.height = options.height;
  renderer_options.overlay_atlas = &font.atlas();
  Result<Renderer> renderer = Renderer::create(renderer_options, frame);
  if (!renderer) {
    return renderer.error();
  }
  return PictureRun(std::move(frame), std::move(snapshot), camera.value(), std::move(as_shown),
                    std::move(font), std::move(renderer).value());
}

void PictureRun::set_scales(const PictureScales& scales) {
  DrawOptions& draw = options_.draw;
  draw.heat_limit = draw.heat_map == HeatMap::kPressure ? scales.pressure : scales.twist;
  draw.full_force = scales.arrows.force;
  draw.full_torque = scales.arrows.torque;
  draw.full_couple = scales.arrows.couple;
}

OverlayContent PictureRun::content_of(const Session& session) const {
  const World& world = session.simulation.world;
  const auto& clock = world.state.clock;
  OverlayContent content;
  content.lines = {std::filesystem::path(session.scene.path).stem().string(),
                   fmt::format("time {:.3f} s", clock.time)};
  for (std::uint32_t tool = 0; tool < world.model.tools.size(); ++tool) {
    const Wrench& wrench = world.state.tools.at<ToolWrench>(tool).total;
    content.lines.push_back(
        fmt::format("force {:.3g} N", shown(glm::length(wrench.force), options_.draw.full_force)));
    content.lines.push_back(fmt::format(
        "torque {:.3g} N m", shown(glm::length(wrench.torque), options_.draw.full_torque)));
  }
  content.lines.push_back(fmt::format("regions {}", world.state.regions.size()));
  content.heat_map = options_.draw.heat_map;
  content.heat_limit = options_.draw.heat_limit;
  if (options_.draw.arrows) {
    content.full_force = options_.draw.full_force;
    content.full_torque = options_.draw.full_torque;
    content.full_couple = options_.draw.torque_parts ? options_.draw.full_couple : 0.0;
  }
  if (clock.faults != 0) {
    const std::string text = faults_text(clock.faults);
    content.banner = text.substr(0, text.find('\n'));
  }
  return content;
}

Result<Image> PictureRun::draw(const Session& session) {
  const World& world = session.simulation.world;
  take_snapshot(session.simulation, snapshot_);
  surface_field(world.model, snapshot_, frame_);
  OverlayDrawList list;
  if (options_.overlay) {
    list = draw_overlay(font_, content_of(session), options_.width, options_.height);
  }
  const Result<std::uint64_t> number =
      renderer_.draw(frame_, snapshot_, camera_, options_.draw, options_.overlay ? &list : nullptr);
  if (!number) {
    return number.error();
  }
  return renderer_.read_pixels(number.value());
}

}  // namespace torsion::engine
