#include "tests/render/render_scenes.hpp"

#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "ecs/assert.hpp"

namespace torsion::engine {
namespace {

/// The six faces of the box from -1 to 1: x and y axes of each, x cross y pointing out.
constexpr std::array<std::array<glm::vec3, 2>, 6> kFaces = {{
    {glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)},
    {glm::vec3(0, 0, 1), glm::vec3(0, 1, 0)},
    {glm::vec3(0, 0, 1), glm::vec3(1, 0, 0)},
    {glm::vec3(1, 0, 0), glm::vec3(0, 0, 1)},
    {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)},
    {glm::vec3(0, 1, 0), glm::vec3(1, 0, 0)},
}};

template <class Table>
Range append_mesh(const TestMesh& mesh, Table& vertices, FrameWorld& frame, bool is_body,
                  DrawRange& drawn) {
  const Range rows = *vertices.append(static_cast<std::uint32_t>(mesh.positions.size()));
  auto& triangles = is_body ? frame.body_triangles : frame.tool_triangles;
  drawn.vertices = rows;
  drawn.triangles = *triangles.append(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (std::uint32_t i = 0; i < rows.count; ++i) {
    vertices.template at<VertexRest>(rows.first + i).position = glm::vec4(mesh.positions[i], 0.0F);
    vertices.template at<VertexNormal>(rows.first + i).normal = glm::vec4(mesh.normals[i], 0.0F);
    vertices.template at<VertexPaint>(rows.first + i).color = glm::vec3(1.0F);
  }
  auto& groups = is_body ? frame.body_groups : frame.tool_groups;
  drawn.groups = *groups.append(1);
  groups.template at<DrawGroup>(drawn.groups.first) = {
      drawn.triangles, static_cast<std::uint32_t>(frame.materials.size())};
  for (std::uint32_t i = 0; i < drawn.triangles.count; ++i) {
    triangles.template at<Triangle>(drawn.triangles.first + i).vertices = mesh.triangles[i];
  }
  return rows;
}

DrawMaterial material_of(const TestThing& thing) {
  DrawMaterial material;
  material.color = thing.color;
  return material;
}

struct Sizes {
  std::uint32_t vertices = 0;
  std::uint32_t triangles = 0;
};

Sizes sizes_of(const std::vector<TestThing>& things) {
  Sizes sizes;
  for (const TestThing& thing : things) {
    sizes.vertices += static_cast<std::uint32_t>(thing.mesh.positions.size());
    sizes.triangles += static_cast<std::uint32_t>(thing.mesh.triangles.size());
  }
  return sizes;
}

}  // namespace

TestMesh box_mesh(const glm::vec3& half_size, std::uint32_t n) {
  TestMesh mesh;
  for (const auto& [x, y] : kFaces) {
    const glm::vec3 out = glm::cross(x, y);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t j = 0; j <= n; ++j) {
      for (std::uint32_t i = 0; i <= n; ++i) {
        const float u = 2.0F * static_cast<float>(i) / static_cast<float>(n) - 1.0F;
        const float v = 2.0F * static_cast<float>(j) / static_cast<float>(n) - 1.0F;
        mesh.positions.push_back(half_size * (out + u * x + v * y));
        mesh.normals.push_back(out);
      }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t corner = first + j * (n + 1) + i;
        mesh.triangles.emplace_back(corner, corner + 1, corner + n + 2);
        mesh.triangles.emplace_back(corner, corner + n + 2, corner + n + 1);
      }
    }
  }
  return mesh;
}

TestMesh sphere_mesh(float radius, std::uint32_t n) {
  TestMesh mesh = box_mesh(glm::vec3(1.0F), n);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    // Equal angles rather than equal steps make the squares nearly equal in size.
    glm::vec3& p = mesh.positions[i];
    const auto even = [](float v) {
      return std::abs(v) == 1.0F ? v : std::tan(v * 0.785398163F);
    };
    p = glm::normalize(glm::vec3(even(p.x), even(p.y), even(p.z)));
    mesh.normals[i] = p;
    p *= radius;
  }
  return mesh;
}

FrameWorld make_frame_world(const std::vector<TestThing>& bodies,
                            const std::vector<TestThing>& tools) {
  const auto count = [](const std::vector<TestThing>& things) {
    return static_cast<std::uint32_t>(things.size());
  };
  FrameWorld frame;
  const Sizes body_sizes = sizes_of(bodies);
  const Sizes tool_sizes = sizes_of(tools);
  frame.bodies.reserve(count(bodies));
  frame.tools.reserve(count(tools));
  frame.body_vertices.reserve(body_sizes.vertices);
  frame.body_triangles.reserve(body_sizes.triangles);
  frame.body_groups.reserve(count(bodies));
  frame.twist.reserve(body_sizes.vertices * kMaxRegionsPerBody);
  frame.axes.reserve(count(bodies) * kMaxRegionsPerBody);
  frame.tool_vertices.reserve(tool_sizes.vertices);
  frame.tool_triangles.reserve(tool_sizes.triangles);
  frame.tool_groups.reserve(count(tools));
  for (const TestThing& thing : bodies) {
    const std::uint32_t row = frame.bodies.append()->first;
    frame.bodies.at<Pose>(row) = thing.pose;
    auto& drawn = frame.bodies.at<DrawRange>(row);
    const Range rows = append_mesh(thing.mesh, frame.body_vertices, frame, true, drawn);
    frame.materials.push_back(material_of(thing));
    frame.bodies.at<FrameBody>(row).twist = *frame.twist.append(rows.count * kMaxRegionsPerBody);
    frame.bodies.at<FrameBody>(row).axes = *frame.axes.append(kMaxRegionsPerBody);
  }
  for (const TestThing& thing : tools) {
    const std::uint32_t row = frame.tools.append()->first;
    frame.tools.at<Pose>(row) = thing.pose;
    auto& drawn = frame.tools.at<DrawRange>(row);
    append_mesh(thing.mesh, frame.tool_vertices, frame, false, drawn);
    frame.materials.push_back(material_of(thing));
  }
  return frame;
}

void add_twist(FrameWorld& frame, std::uint32_t body, const glm::vec3& point,
               const glm::vec3& direction, const std::function<float(const glm::vec3&)>& angle) {
  auto& row = frame.bodies.at<FrameBody>(body);
  TORSION_ASSERT(row.regions_drawn < kMaxRegionsPerBody);
  const Range vertices = frame.bodies.at<DrawRange>(body).vertices;
  frame.axes.at<TwistAxis>(row.axes.first + row.regions_drawn) = {glm::vec4(point, 0.0F),
                                                                  glm::vec4(direction, 0.0F)};
  const std::uint32_t first = row.twist.first + row.regions_drawn * vertices.count;
  for (std::uint32_t i = 0; i < vertices.count; ++i) {
    frame.twist.at<TwistAngle>(first + i).angle =
        angle(glm::vec3(frame.body_vertices.at<VertexRest>(vertices.first + i).position));
  }
  row.regions_drawn += 1;
}

Snapshot make_snapshot(std::uint32_t tools, std::uint32_t regions) {
  Snapshot snapshot;
  snapshot.tools.reserve(tools);
  snapshot.tools.append(tools);
  snapshot.regions.reserve(regions);
  return snapshot;
}

Camera camera_at(const glm::dvec3& eye, const glm::dvec3& center, double vertical_field_of_view) {
  const glm::dvec3 z = glm::normalize(eye - center);
  const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), z));
  const double distance = glm::length(eye - center);
  return {{eye, glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)))},
          vertical_field_of_view,
          0.05 * distance,
          20.0 * distance};
}

TwistedCube twisted_cube(double turn, std::uint32_t squares) {
  constexpr float kHalf = 0.03F;
  constexpr float kRadius = 0.015F;
  constexpr float kDepth = 0.003F;
  constexpr float kReach = 0.02F;  // how far the twist and the dent spread
  const glm::vec3 contact(0.0F, kHalf, 0.0F);
  const auto share = [&](const glm::vec3& rest) {
    const float away = glm::distance(rest, contact) / kReach;
    return std::exp(-away * away) * (rest.y + kHalf) / (2.0F * kHalf);
  };
  TwistedCube scene;
  scene.frame = make_frame_world(
      {{box_mesh(glm::vec3(kHalf), squares), {}, glm::vec4(0.55F, 0.68F, 0.60F, 1.0F)}},
      {{sphere_mesh(kRadius, 16),
        {glm::dvec3(0.0, static_cast<double>(kHalf + kRadius - kDepth), 0.0),
         glm::angleAxis(turn, glm::dvec3(0.0, 1.0, 0.0))},
        glm::vec4(0.55F, 0.56F, 0.60F, 1.0F)}});
  add_twist(scene.frame, 0, contact, glm::vec3(0.0F, 1.0F, 0.0F),
            [&](const glm::vec3& rest) { return static_cast<float>(turn) * share(rest); });
  for (std::uint32_t i = 0; i < scene.frame.body_vertices.size(); ++i) {
    const glm::vec3 rest(scene.frame.body_vertices.at<VertexRest>(i).position);
    const float s = share(rest);
    const float off_axis = glm::length(glm::vec2(rest.x, rest.z)) / 0.007F;
    const float pressure =
        rest.y == kHalf ? 4e4F * std::sqrt(std::max(0.0F, 1.0F - off_axis * off_axis)) : 0.0F;
    scene.frame.body_vertices.at<VertexDisplacement>(i).displacement =
        glm::vec4(0.0F, -kDepth * s, 0.0F, pressure);
  }
  scene.snapshot = make_snapshot(1, 1);
  scene.snapshot.tools.at<ToolMotion>(0).mass_center = scene.frame.tools.at<Pose>(0).position;
  scene.snapshot.tools.at<ToolWrench>(0).total = {glm::dvec3(0.0, 8.0, 0.0),
                                                  glm::dvec3(0.0, -0.03 * turn, 0.0)};
  scene.snapshot.regions.append();
  scene.snapshot.regions.at<RegionFrame>(0).origin = glm::dvec3(contact);
  scene.snapshot.regions.at<Contact>(0).radius = 0.007;
  scene.camera = camera_at(glm::dvec3(0.12, 0.14, 0.18), glm::dvec3(0.0, 0.012, 0.0), 0.55);
  return scene;
}

}  // namespace torsion::engine
