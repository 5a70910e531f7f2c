#include "systems/contact/pressed_face.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/math/frames.hpp"

namespace torsion::engine {
namespace {

/// Where other faces are looked for: at first touch the point may be as many of its depths off the
/// place where it is deepest.
struct Look {
  double aside;   // of the depth, from the point
  double cosine;  // of the normals, at most: what turns by less is one curved face
};
constexpr std::array kLooks = {Look{0.5, 0.9}, Look{4.0, 0.8}, Look{32.0, 0.5}, Look{256.0, 0.2}};
constexpr std::size_t kMostFaces = 4;  // at one place
constexpr int kWays = 8;               // in which they are
constexpr double kSheet = 0.1;         // of a sine's square: such faces meet far away
constexpr double kOut = 0.01;   // of the depth: so near to its surface a way out of a tool ends
constexpr int kMostSteps = 40;  // of both ways together

/// A tool as its body sees it.
struct ToolInBody {
  const Model& model;
  Range parts;
  Pose tool_in_body;

  [[nodiscard]] double distance(const glm::dvec3& point) const {
    return signed_distance(model, parts, to_inner(tool_in_body, point)).value;
  }
};

/// A face of a body as a plane near a point inside.
struct BodyFace {
  glm::dvec3 normal{0.0};  // body, unit, outwards
  double depth = 0.0;      // m: of the point below it
};

/// @param place  where the body's surface is looked for
/// @param point  m, body: whose depth below the face is wanted
BodyFace face_at(const Grid& grid, const glm::dvec3& place, const glm::dvec3& point) {
  const Distance surface =
      signed_distance(grid.model, grid.model.bodies.at<OwnedRows>(grid.identity.body).parts, place);
  const glm::dvec3 normal = glm::normalize(surface.gradient);
  return {normal, -surface.value + glm::dot(normal, place - point)};
}

/// A way from the edge of two faces along one of them, away from the other, through the tool.
struct EdgeWay {
  glm::dvec3 direction{0.0};
  double length = 0.0;  // m
};

/// True where the tool reaches less deep under `other` than under `face` at the edge where they
/// meet. Both ways there are gone side by side, by steps that the tool's distance allows, until
/// one ends; without an end of either, or where the edge is not in the tool, it is false. So it is
/// of the two sides of a sheet.
bool leaves_by(const ToolInBody& tool, const BodyFace& face, const BodyFace& other,
               const glm::dvec3& point) {
  const double cosine = glm::dot(face.normal, other.normal);
  const double square = 1.0 - cosine * cosine;
  if (square < kSheet) {
    return false;
  }
  const glm::dvec3 edge = point + (face.depth - cosine * other.depth) / square * face.normal +
                          (other.depth - cosine * face.depth) / square * other.normal;
  const double out = -kOut * std::max(face.depth, other.depth);
  if (tool.distance(edge) > out) {
    return false;
  }
  EdgeWay under_face{-(face.normal - cosine * other.normal) / std::sqrt(square), 0.0};
  EdgeWay under_other{-(other.normal - cosine * face.normal) / std::sqrt(square), 0.0};
  for (int step = 0; step < kMostSteps; ++step) {
    EdgeWay& shorter = under_other.length < under_face.length ? under_other : under_face;
    const double inside = tool.distance(edge + shorter.length * shorter.direction);
    if (inside > out) {
      return &shorter == &under_other;
    }
    shorter.length -= inside;
  }
  return false;
}

}  // namespace

glm::dvec3 pressed_normal(const Grid& grid, const ContactPoint& point) {
  BodyFace pressed = face_at(grid, point.position, point.position);
  const ToolInBody tool{grid.model, grid.model.tools.at<OwnedRows>(grid.identity.tool).parts,
                        relative(grid.state.bodies.at<BodyPose>(grid.identity.body).now,
                                 grid.state.tools.at<ToolPose>(grid.identity.tool).now)};
  RegionFrame around;
  turn_normal_to(around, pressed.normal);
  const double depth = pressed.depth;
  std::array<glm::dvec3, kMostFaces> seen{pressed.normal};
  std::size_t faces = 1;
  for (const Look& look : kLooks) {
    for (int way = 0; way < kWays && faces < kMostFaces; ++way) {
      const double angle = 2.0 * std::numbers::pi * way / kWays;
      const glm::dvec3 direction =
          std::cos(angle) * around.tangent_x + std::sin(angle) * around.tangent_y;
      const BodyFace other =
          face_at(grid, point.position + look.aside * depth * direction, point.position);
      const auto is_other = [&](const glm::dvec3& normal) {
        return glm::dot(other.normal, normal) < look.cosine;
      };
      if (other.depth > 0.0 && std::all_of(seen.begin(), seen.begin() + faces, is_other)) {
        seen[faces++] = other.normal;
        pressed = leaves_by(tool, pressed, other, point.position) ? other : pressed;
      }
    }
  }
  return pressed.normal;
}

}  // namespace torsion::engine
