#include "app/run_page/run_page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <numbers>
#include <span>
#include <string_view>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "app/base64.hpp"
#include "app/html_text.hpp"
#include "app/round_up.hpp"
#include "app/run_page/page_materials.hpp"
#include "device/scripted_motion.hpp"
#include "render/auto_camera.hpp"
#include "render/box.hpp"
#include "render/colormap.hpp"
#include "render/frame_view.hpp"
#include "systems/surface/surface_field.hpp"

// The page and its scripts, in the program, so that it needs no file at run time.
#define TORSION_EMBED(name, file)     \
  __asm__(                            \
      ".section .rodata\n"            \
      ".global " #name                \
      "_begin\n"                      \
      ".global " #name "_end\n" #name \
      "_begin:\n"                     \
      ".incbin \"" file "\"\n" #name  \
      "_end:\n"                       \
      ".byte 0\n"                     \
      ".text\n");                     \
  extern "C" {                        \
  extern const char name##_begin[];   \
  extern const char name##_end[];     \
  }
TORSION_EMBED(torsion_run_page, TORSION_RUN_PAGE)
TORSION_EMBED(torsion_run_view, TORSION_RUN_VIEW)
TORSION_EMBED(torsion_three, TORSION_THREE)
TORSION_EMBED(torsion_three_orbit, TORSION_THREE_ORBIT)
#undef TORSION_EMBED

namespace torsion::engine {
namespace {

std::string_view text_between(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

/// `value` as a part of `unit`, which is 32767.
std::int16_t short_of(float value, double unit) {
  constexpr double kMost = 32767.0;
  return static_cast<std::int16_t>(
      std::lround(std::clamp(static_cast<double>(value) / unit, -1.0, 1.0) * kMost));
}

nlohmann::json vector_json(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

nlohmann::json pose_json(const Pose& pose) {
  const glm::dquat& q = pose.rotation;
  return {pose.position.x, pose.position.y, pose.position.z, q.x, q.y, q.z, q.w};
}

/// @param limit  rad: the end of the twist's scale
nlohmann::json body_json(const AnimatedMesh& body, double limit, PageMaterials& materials) {
  constexpr double kNormalUnit = 2.0;  // normals differ by up to that
  float largest = 1e-12F;
  for (const MorphTarget& target : body.targets) {
    for (const glm::vec3& shift : target.positions) {
      largest = std::max({largest, std::abs(shift.x), std::abs(shift.y), std::abs(shift.z)});
    }
  }
  std::vector<std::int16_t> shifts;
  std::vector<std::int16_t> normals;
  std::vector<std::int16_t> twists;
  for (const MorphTarget& target : body.targets) {
    for (std::size_t i = 0; i < target.positions.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        shifts.push_back(short_of(target.positions[i][axis], static_cast<double>(largest)));
        normals.push_back(short_of(target.normals[i][axis], kNormalUnit));
      }
      twists.push_back(short_of(target.twist_angles[i], limit));
    }
  }
  nlohmann::json poses = nlohmann::json::array();
  for (const Pose& pose : body.poses) {
    poses.push_back(pose_json(pose));
  }
  return {{"name", body.rest.name},
          {"pose", pose_json(body.rest.pose)},
          {"poses", poses},
          {"positions", base64_of(body.rest.positions)},
          {"normals", base64_of(body.rest.normals)},
          {"triangles", base64_of(body.rest.triangles)},
          {"shifts", base64_of(shifts)},
          {"shift_unit", static_cast<double>(largest) / 32767.0},
          {"normal_shifts", base64_of(normals)},
          {"look", materials.look_of(body.rest)},
          {"grid", grid_spacing(box_of(body.rest.positions).largest_side())},
          {"twists", base64_of(twists)}};
}

nlohmann::json tool_json(const AnimatedMesh& tool, std::size_t row, const DeformedRun& run,
                         PageMaterials& materials) {
  nlohmann::json poses = nlohmann::json::array();
  nlohmann::json forces = nlohmann::json::array();
  nlohmann::json torques = nlohmann::json::array();
  nlohmann::json centers = nlohmann::json::array();
  for (std::size_t moment = 0; moment < run.times().size(); ++moment) {
    const DeformedRun::Felt& felt = run.felt()[moment][row];
    poses.push_back(pose_json(tool.poses[moment]));
    forces.push_back(vector_json(felt.wrench.force));
    torques.push_back(vector_json(felt.wrench.torque));
    centers.push_back(vector_json(felt.center));
  }
  return {{"name", tool.rest.name},
          {"look", materials.look_of(tool.rest)},
          {"positions", base64_of(tool.rest.positions)},
          {"normals", base64_of(tool.rest.normals)},
          {"triangles", base64_of(tool.rest.triangles)},
          {"poses", poses},
          {"forces", forces},
          {"torques", torques},
          {"centers", centers}};
}

/// Where one looks from at first, and to.
nlohmann::json camera_json(const Session& session) {
  constexpr double kAspect = 1.5;
  const SceneDescription& scene = session.scene;
  const World& world = session.simulation.world;
  const FrameWorld frame = prepare_frame(scene, world.model, world.state);
  const Camera camera = scene.cameras.empty() ? auto_camera(frame, kAspect, scripted_poses(scene))
                                              : camera_of(scene.cameras.front());
  glm::dvec3 middle(0.0);
  for (const BodyDescription& body : scene.bodies) {
    middle += body.pose.position / static_cast<double>(scene.bodies.size());
  }
  const glm::dvec3 ahead = camera.pose.rotation * glm::dvec3(0.0, 0.0, -1.0);
  const double distance = std::max(glm::dot(middle - camera.pose.position, ahead), 1e-3);
  return {{"eye", vector_json(camera.pose.position)},
          {"target", vector_json(camera.pose.position + distance * ahead)}};
}

/// The largest twist of any vertex, as the end of a scale, rad.
double twist_limit(const DeformedRun& run) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  float largest = 0.0F;
  for (const AnimatedMesh& mesh : run.meshes()) {
    for (const MorphTarget& target : mesh.targets) {
      for (const float angle : target.twist_angles) {
        largest = std::max(largest, std::abs(angle));
      }
    }
  }
  return round_up(std::max(static_cast<double>(largest) / kDegree, 1.0)) * kDegree;
}

nlohmann::json run_json(const Session& session, const DeformedRun& run) {
  constexpr int kColors = 129;
  nlohmann::json palette = nlohmann::json::array();
  for (int i = 0; i < kColors; ++i) {
    palette.push_back(vector_json(heat_color(HeatMap::kTwist, i / (kColors - 1.0))));
  }
  const ArrowLimits& limits = run.limits();
  const double limit = twist_limit(run);
  nlohmann::json bodies = nlohmann::json::array();
  nlohmann::json tools = nlohmann::json::array();
  PageMaterials materials;
  for (const AnimatedMesh& mesh : run.meshes()) {
    if (mesh.targets.empty()) {
      tools.push_back(tool_json(mesh, tools.size(), run, materials));
    } else {
      bodies.push_back(body_json(mesh, limit, materials));
    }
  }
  return {{"times", run.times()},
          {"palette", palette},
          {"full_force", limits.force > 0.0 ? round_up(limits.force) : 1.0},
          {"full_torque", limits.torque > 0.0 ? round_up(limits.torque) : 1.0},
          {"twist_limit", limit * 180.0 / std::numbers::pi},
          {"bodies", bodies},
          {"tools", tools},
          {"materials", materials.materials()},
          {"images", materials.images()},
          {"studio", studio_sides()},
          {"colors", session.scene.view.colors == "material" ? "material" : "twist"},
          {"lines", session.scene.view.lines},
          {"camera", camera_json(session)}};
}

/// The page with what stands for each name between percent signs.
std::string filled(std::string_view page,
                   std::span<const std::pair<std::string_view, std::string>> values) {
  std::string text;
  while (!page.empty()) {
    const auto next = std::ranges::find_if(values, [&](const auto& value) {
      return page.substr(0, value.first.size()) == value.first;
    });
    if (next != values.end()) {
      text += next->second;
      page.remove_prefix(next->first.size());
    } else {
      text += page.front();
      page.remove_prefix(1);
    }
  }
  return text;
}

/// JSON inside of a script: nothing in it may end that.
std::string in_script(const nlohmann::json& value) {
  std::string text;
  for (const char letter : value.dump()) {
    if (letter == '<') {
      text += "\\u003c";
    } else {
      text += letter;
    }
  }
  return text;
}

}  // namespace

std::string run_page_parts() {
  return in_script({{"page", text_between(torsion_run_page_begin, torsion_run_page_end)},
                    {"three", text_between(torsion_three_begin, torsion_three_end)},
                    {"orbit", text_between(torsion_three_orbit_begin, torsion_three_orbit_end)},
                    {"view", text_between(torsion_run_view_begin, torsion_run_view_end)}});
}

std::string run_page_data(const Session& session, const DeformedRun& run) {
  return in_script(run_json(session, run));
}

std::string run_page(const Session& session, const DeformedRun& run) {
  const SceneDescription& scene = session.scene;
  const std::string title = scene.view.title.empty()
                                ? std::filesystem::path(scene.path).filename().string()
                                : scene.view.title;
  const auto script = [](const char* begin, const char* end) {
    return std::string(text_between(begin, end));
  };
  const std::array<std::pair<std::string_view, std::string>, 6> values = {
      {{"%TITLE%", html_escaped(title)},
       {"%CAPTION%", html_escaped(scene.view.caption)},
       {"%THREE%", script(torsion_three_begin, torsion_three_end)},
       {"%ORBIT%", script(torsion_three_orbit_begin, torsion_three_orbit_end)},
       {"%DATA%", run_page_data(session, run)},
       {"%VIEW%", script(torsion_run_view_begin, torsion_run_view_end)}}};
  return filled(text_between(torsion_run_page_begin, torsion_run_page_end), values);
}

}  // namespace torsion::engine
