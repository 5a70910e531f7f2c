#include "systems/geometry/distance_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <glm/geometric.hpp>

#include "ecs/assert.hpp"
#include "systems/math/lanes.hpp"

namespace torsion::engine {

/// Two cache lines, of which the first is enough to reject most triangles.
struct alignas(64) TriangleCorners {
  glm::dvec3 middle;
  glm::dvec3 normal;  // unit, or zero for a triangle without area
  double reach;       // m, from `middle` to the farthest corner
  double padding;
  glm::dvec3 a;
  glm::dvec3 b;
  glm::dvec3 c;
};

namespace {

/// The feature of a triangle that is closest to a point: 0 to 2 a corner, 3 to 5 the edge from
/// corner k-3 to the next, 6 the face.
using Feature = std::uint32_t;
constexpr Feature kFirstEdge = 3;
constexpr Feature kFace = 6;

struct FeaturePoint {
  glm::dvec3 point;
  Feature feature;
};

/// Closest point of a triangle by its Voronoi regions: Ericson, Real-Time Collision Detection,
/// 2005, 5.1.5.
FeaturePoint closest_on_triangle(const TriangleCorners& t, const glm::dvec3& p) {
  const glm::dvec3 ab = t.b - t.a;
  const glm::dvec3 ac = t.c - t.a;
  const glm::dvec3 ap = p - t.a;
  const double d1 = glm::dot(ab, ap);
  const double d2 = glm::dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) {
    return {t.a, 0};
  }
  const glm::dvec3 bp = p - t.b;
  const double d3 = glm::dot(ab, bp);
  const double d4 = glm::dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) {
    return {t.b, 1};
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    return {t.a + ab * (d1 / (d1 - d3)), kFirstEdge};
  }
  const glm::dvec3 cp = p - t.c;
  const double d5 = glm::dot(ab, cp);
  const double d6 = glm::dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) {
    return {t.c, 2};
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    return {t.a + ac * (d2 / (d2 - d6)), kFirstEdge + 2};
  }
  const double va = d3 * d6 - d5 * d4;
  const double along = d4 - d3;
  const double back = d5 - d6;
  if (va <= 0.0 && along >= 0.0 && back >= 0.0) {
    return {t.b + (t.c - t.b) * (along / (along + back)), kFirstEdge + 1};
  }
  return {t.a + (ab * vb + ac * vc) / (va + vb + vc), kFace};
}

/// A half edge, for finding the two faces of an edge by sorting.
struct HalfEdge {
  std::uint32_t low;
  std::uint32_t high;
  std::uint32_t slot;  // 3 * triangle + which edge
};

struct Query {
  const TriangleCorners* corners;
  glm::dvec3 point;
  double slack;  // m: the boxes are float
  double best_squared = std::numeric_limits<double>::infinity();
  FeaturePoint best{};
  std::uint32_t triangle = kNoRow;
};

/// Takes `triangle` if it is nearer than the nearest so far; of equally near ones the lower row, so
/// that the tree's order does not matter.
/// @return whether it was taken
bool try_triangle(Query& query, std::uint32_t triangle) {
  const TriangleCorners& corners = query.corners[triangle];
  // The triangle lies in its plane, within `reach` of its middle.
  const glm::dvec3 from_middle = query.point - corners.middle;
  const double height = glm::dot(corners.normal, from_middle);
  const double across =
      std::sqrt(larger(glm::dot(from_middle, from_middle) - height * height, 0.0));
  const double beyond = larger(across - corners.reach, 0.0);
  if (height * height + beyond * beyond > query.best_squared * (1.0 + 1e-9)) {
    return false;
  }
  const FeaturePoint found = closest_on_triangle(corners, query.point);
  const glm::dvec3 difference = query.point - found.point;
  const double squared = glm::dot(difference, difference);
  if (squared > query.best_squared ||
      (squared == query.best_squared && triangle >= query.triangle)) {
    return false;
  }
  const bool nearer = squared < query.best_squared;
  query.best_squared = squared;
  query.best = found;
  query.triangle = triangle;
  return nearer;
}

float search_radius(const Query& query) {
  return static_cast<float>((std::sqrt(query.best_squared) + query.slack) * (1.0 + 1e-6));
}

bool on_triangle(RTCPointQueryFunctionArguments* arguments) {
  auto& query = *static_cast<Query*>(arguments->userPtr);
  if (!try_triangle(query, arguments->primID)) {
    return false;
  }
  arguments->query->radius = search_radius(query);
  return true;
}

/// Corner angles of a triangle.
glm::dvec3 angles(const TriangleCorners& t) {
  const auto angle = [](const glm::dvec3& u, const glm::dvec3& v) {
    const glm::dvec3 normal = glm::cross(u, v);
    return std::atan2(std::sqrt(glm::dot(normal, normal)), glm::dot(u, v));
  };
  return {angle(t.b - t.a, t.c - t.a), angle(t.c - t.b, t.a - t.b), angle(t.a - t.c, t.b - t.c)};
}

}  // namespace

struct MeshDistance::Tree {
  std::vector<TriangleCorners> corners;
  std::vector<glm::uvec3> triangles;
  std::vector<glm::dvec3> vertex_normals;  // pseudonormals; only their direction counts
  std::vector<glm::dvec3> edge_normals;    // 3 a triangle
  glm::dvec3 center{0.0};
  double slack = 0.0;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Tree() = default;
  Tree(const Tree&) = delete;
  Tree(Tree&&) = delete;
  Tree& operator=(const Tree&) = delete;
  Tree& operator=(Tree&&) = delete;
  ~Tree() {
    if (scene != nullptr) {
      rtcReleaseScene(scene);
    }
    if (device != nullptr) {
      rtcReleaseDevice(device);
    }
  }

  void set_corners(const SurfaceMesh& mesh);
  void set_vertex_normals(std::size_t vertex_count);
  void set_edge_normals();
  [[nodiscard]] bool build_boxes(const SurfaceMesh& mesh, std::uint32_t threads);
  [[nodiscard]] const glm::dvec3& pseudonormal(std::uint32_t triangle, Feature feature) const;
};

void MeshDistance::Tree::set_corners(const SurfaceMesh& mesh) {
  triangles = mesh.triangles;
  glm::dvec3 lowest = mesh.positions[mesh.triangles[0].x];
  glm::dvec3 highest = lowest;
  corners.reserve(triangles.size());
  for (const glm::uvec3& triangle : triangles) {
    TriangleCorners t{};
    t.a = mesh.positions[triangle.x];
    t.b = mesh.positions[triangle.y];
    t.c = mesh.positions[triangle.z];
    t.middle = (t.a + t.b + t.c) / 3.0;
    t.reach = std::max({glm::distance(t.middle, t.a), glm::distance(t.middle, t.b),
                        glm::distance(t.middle, t.c)}) *
              (1.0 + 1e-9);
    const glm::dvec3 normal = glm::cross(t.b - t.a, t.c - t.a);
    const double length = std::sqrt(glm::dot(normal, normal));
    t.normal = length > 0.0 ? normal / length : normal;
    corners.push_back(t);
    lowest = glm::min(lowest, glm::min(t.a, glm::min(t.b, t.c)));
    highest = glm::max(highest, glm::max(t.a, glm::max(t.b, t.c)));
  }
  center = 0.5 * (lowest + highest);
  slack = 1e-6 * glm::distance(lowest, highest);
}

void MeshDistance::Tree::set_vertex_normals(std::size_t vertex_count) {
  vertex_normals.assign(vertex_count, glm::dvec3(0.0));
  for (std::size_t row = 0; row < triangles.size(); ++row) {
    const glm::dvec3 weights = angles(corners[row]);
    vertex_normals[triangles[row].x] += weights.x * corners[row].normal;
    vertex_normals[triangles[row].y] += weights.y * corners[row].normal;
    vertex_normals[triangles[row].z] += weights.z * corners[row].normal;
  }
}

void MeshDistance::Tree::set_edge_normals() {
  std::vector<HalfEdge> half_edges;
  half_edges.reserve(3 * triangles.size());
  for (std::uint32_t row = 0; row < triangles.size(); ++row) {
    const std::array<std::uint32_t, 3> vertex{triangles[row].x, triangles[row].y, triangles[row].z};
    for (std::uint32_t edge = 0; edge < 3; ++edge) {
      const std::uint32_t from = vertex[edge];
      const std::uint32_t to = vertex[(edge + 1) % 3];
      half_edges.push_back({std::min(from, to), std::max(from, to), 3 * row + edge});
    }
  }
  std::sort(half_edges.begin(), half_edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::pair(a.low, a.high) != std::pair(b.low, b.high)
               ? std::pair(a.low, a.high) < std::pair(b.low, b.high)
               : a.slot < b.slot;
  });
  edge_normals.resize(half_edges.size());
  for (std::size_t first = 0; first < half_edges.size();) {
    std::size_t end = first;
    glm::dvec3 sum(0.0);
    for (; end < half_edges.size() && half_edges[end].low == half_edges[first].low &&
           half_edges[end].high == half_edges[first].high;
         ++end) {
      sum += corners[half_edges[end].slot / 3].normal;
    }
    for (; first < end; ++first) {
      edge_normals[half_edges[first].slot] = sum;
    }
  }
}

bool MeshDistance::Tree::build_boxes(const SurfaceMesh& mesh, std::uint32_t threads) {
  device = rtcNewDevice(threads == 1 ? "threads=1" : "threads=2");
  if (device == nullptr) {
    return false;
  }
  scene = rtcNewScene(device);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* const vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              3 * sizeof(float), mesh.positions.size()));
  auto* const indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), triangles.size()));
  if (vertices == nullptr || indices == nullptr) {
    rtcReleaseGeometry(geometry);
    return false;
  }
  for (std::size_t row = 0; row < mesh.positions.size(); ++row) {
    const glm::dvec3 shifted = mesh.positions[row] - center;
    vertices[3 * row] = static_cast<float>(shifted.x);
    vertices[3 * row + 1] = static_cast<float>(shifted.y);
    vertices[3 * row + 2] = static_cast<float>(shifted.z);
  }
  for (std::size_t row = 0; row < triangles.size(); ++row) {
    indices[3 * row] = triangles[row].x;
    indices[3 * row + 1] = triangles[row].y;
    indices[3 * row + 2] = triangles[row].z;
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  return rtcGetDeviceError(device) == RTC_ERROR_NONE;
}

const glm::dvec3& MeshDistance::Tree::pseudonormal(std::uint32_t triangle, Feature feature) const {
  if (feature == kFace) {
    return corners[triangle].normal;
  }
  if (feature >= kFirstEdge) {
    return edge_normals[3 * triangle + feature - kFirstEdge];
  }
  const glm::uvec3& vertices = triangles[triangle];
  return vertex_normals[feature == 0 ? vertices.x : feature == 1 ? vertices.y : vertices.z];
}

MeshDistance::MeshDistance(std::unique_ptr<Tree> tree) : tree_(std::move(tree)) {}
MeshDistance::MeshDistance(MeshDistance&&) noexcept = default;
MeshDistance& MeshDistance::operator=(MeshDistance&&) noexcept = default;
MeshDistance::~MeshDistance() = default;

Result<MeshDistance> MeshDistance::build(const SurfaceMesh& mesh, std::uint32_t threads) {
  if (mesh.triangles.empty()) {
    return Error{"a signed distance needs a closed mesh, but the mesh has no triangles"};
  }
  for (std::size_t row = 0; row < mesh.triangles.size(); ++row) {
    const glm::uvec3& t = mesh.triangles[row];
    if (std::max({t.x, t.y, t.z}) >= mesh.positions.size()) {
      return Error{"triangle " + std::to_string(row) + " names vertex " +
                   std::to_string(std::max({t.x, t.y, t.z})) + ", but the mesh has " +
                   std::to_string(mesh.positions.size()) + " vertices"};
    }
  }
  for (std::size_t row = 0; row < mesh.positions.size(); ++row) {
    const glm::dvec3& p = mesh.positions[row];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      return Error{"position " + std::to_string(row) + " of the mesh is not finite"};
    }
  }
  auto tree = std::make_unique<Tree>();
  tree->set_corners(mesh);
  tree->set_vertex_normals(mesh.positions.size());
  tree->set_edge_normals();
  if (!tree->build_boxes(mesh, threads)) {
    return Error{"the search tree of the mesh's triangles could not be built (out of memory?)"};
  }
  return MeshDistance(std::move(tree));
}

MeshDistance::Closest MeshDistance::closest(const glm::dvec3& point, std::uint32_t hint) const {
  const Tree& tree = *tree_;
  Query query{tree.corners.data(), point, tree.slack};
  if (hint != kNoRow) {
    try_triangle(query, hint);
  }
  RTCPointQuery box_query{};
  const glm::dvec3 shifted = point - tree.center;
  box_query.x = static_cast<float>(shifted.x);
  box_query.y = static_cast<float>(shifted.y);
  box_query.z = static_cast<float>(shifted.z);
  box_query.radius = search_radius(query);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(tree.scene, &box_query, &context, on_triangle, &query);
  TORSION_ASSERT(query.triangle != kNoRow);

  const glm::dvec3& normal = tree.pseudonormal(query.triangle, query.best.feature);
  const glm::dvec3 difference = point - query.best.point;
  const double length = std::sqrt(query.best_squared);
  const bool inside = glm::dot(difference, normal) < 0.0;
  Closest closest;
  closest.point = query.best.point;
  closest.triangle = query.triangle;
  closest.distance.value = inside ? -length : length;
  if (length > tree.slack) {
    closest.distance.gradient = difference / closest.distance.value;
  } else {  // the difference is rounding
    const double size = std::sqrt(glm::dot(normal, normal));
    closest.distance.gradient = size > 0.0 ? normal / size : glm::dvec3(0.0, 1.0, 0.0);
  }
  return closest;
}

}  // namespace torsion::engine
