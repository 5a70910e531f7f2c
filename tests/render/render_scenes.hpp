#pragma once

// Small frame worlds made by hand, so that the renderer's tests need neither a scene file nor a
// simulation.

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "ecs/frame_world.hpp"
#include "ecs/snapshot.hpp"
#include "render/camera.hpp"

namespace torsion::engine {

/// A triangle mesh to be drawn: one normal for each position.
struct TestMesh {
  std::vector<glm::vec3> positions;  // m
  std::vector<glm::vec3> normals;
  std::vector<glm::uvec3> triangles;  // counter-clockwise from outside
};

/// A box about the origin, each face n x n squares; vertices are split at its edges.
TestMesh box_mesh(const glm::vec3& half_size, std::uint32_t n);

/// A sphere about the origin: a box's n x n faces pushed out; the seams' vertices are split but
/// share their normals.
TestMesh sphere_mesh(float radius, std::uint32_t n);

struct TestThing {
  TestMesh mesh;
  Pose pose;
  glm::vec4 color{0.8F};
};

/// A frame world of bodies and tools in this order, at rest, with kMaxRegionsPerBody blocks of
/// angles for each body.
FrameWorld make_frame_world(const std::vector<TestThing>& bodies,
                            const std::vector<TestThing>& tools);

/// One region on a body: vertices turn about `point` and `direction` by `angle(rest)` [rad] and
/// move by `displacement(rest)` [m]; a slot after the others.
void add_twist(FrameWorld& frame, std::uint32_t body, const glm::vec3& point,
               const glm::vec3& direction, const std::function<float(const glm::vec3&)>& angle);

/// A snapshot with one row for each tool and memory for `regions` regions.
Snapshot make_snapshot(std::uint32_t tools, std::uint32_t regions);

/// Looks from `eye` at `center`, +y up in the picture. @pre they are not above one another
Camera camera_at(const glm::dvec3& eye, const glm::dvec3& center, double vertical_field_of_view);

/// A ball of radius 1.5 cm pressed 3 mm into the top of a cube with an edge of 6 cm and turned by
/// `turn` [rad]; the cube follows within a few radii.
struct TwistedCube {
  FrameWorld frame;
  Snapshot snapshot;
  Camera camera;
};
TwistedCube twisted_cube(double turn, std::uint32_t squares);

}  // namespace torsion::engine
