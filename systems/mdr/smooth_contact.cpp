#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/region_grid.hpp"
#include "systems/geometry/distance_shapes.hpp"
#include "systems/geometry/surface_piece.hpp"
#include "systems/half_space/elliptic_contact.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/smooth_step.hpp"
#include "systems/mdr/round_contact.hpp"

namespace torsion::engine {
namespace {

constexpr int kMostNewtonSteps = 12;     // of Newton's method
constexpr double kCommon = 1e-14;        // between the two normals: rounding
constexpr double kFlatCurvature = 1e-9;  // of the larger curvature: rounding
constexpr double kOther = 0.5;    // of the cells' largest depth: it is not the deepest place,
constexpr double kDeepest = 0.9;  // it is: cells lie beside it
constexpr double kJust = 1e-4;    // of the grid: so deep, cells seem to touch where shapes do not
constexpr double kKnownPiece = 0.9;  // the smooth piece ends so far out, over the overlap's extent:
constexpr double kUnknownPiece = 0.75;  // Hertz' ellipse ends at 0.71
constexpr double kOtherPartFar = 1.0;   // distance of other parts, likewise
constexpr double kOtherPartNear = 0.8;

double rising(double x, double from, double to) {
  return smooth_step((x - from) / (to - from));
}

/// One exact part seen from the region's grid: x_part = turn x + shift.
struct PlacedPart {
  const ShapePart& part;
  glm::dmat3 turn;
  glm::dvec3 shift;  // m

  [[nodiscard]] glm::dvec3 to_part(const glm::dvec3& point) const { return turn * point + shift; }
  [[nodiscard]] Distance distance(const glm::dvec3& point) const {
    const glm::dvec3 local = to_part(point);
    Distance found =
        with_exact_shape(part, [&](const auto& shape) { return shape(local.x, local.y, local.z); });
    found.gradient = found.gradient * turn;  // the transpose turns back
    return found;
  }
};

/// @param owner  the grid's frame in that of the part's owner
PlacedPart place_part(const ShapePart& part, const Pose& owner) {
  const glm::dquat to_part = glm::conjugate(part.pose.rotation);
  return {part, glm::mat3_cast(to_part * owner.rotation),
          to_part * (owner.position - part.pose.position)};
}

/// The part nearest to a point of the grid, and the distance of the next one.
struct Nearest {
  std::uint32_t row = kNoRow;
  double other = 1e300;  // m
};

Nearest nearest_part(const Model& model, Range parts, const Pose& grid, const glm::dvec3& point) {
  Nearest nearest;
  nearest.row = parts.first;
  if (parts.count < 2) {
    return nearest;
  }
  const glm::dvec3 place = to_outer(grid, point);
  double least = 1e300;
  for (std::uint32_t row = parts.first; row < parts.first + parts.count; ++row) {
    const double distance = signed_distance(model, Range{row, 1}, place).value;
    if (distance < least) {
      nearest = {row, least};
      least = distance;
    } else {
      nearest.other = std::min(nearest.other, distance);
    }
  }
  return nearest;
}

/// Two surfaces at the points where they are deepest in each other, in the grid's frame.
struct CommonNormal {
  double depth = 0.0;        // m
  glm::dvec3 on_tool{0.0};   // m
  glm::dvec3 on_body{0.0};   // m
  glm::dvec3 normal{0.0};    // unit, out of the body
  glm::dvec3 across_1{0.0};  // unit tangents
  glm::dvec3 across_2{0.0};
  glm::dmat2 curvature{0.0};  // 1/m, of both, in the tangents
  SurfacePiece tool_piece;
  SurfacePiece body_piece;
};

glm::dmat2 in_tangents(const PlacedPart& part, const glm::dmat3& curvature,
                       const CommonNormal& at) {
  const glm::dvec3 one = part.turn * at.across_1;
  const glm::dvec3 two = part.turn * at.across_2;
  const double mixed = glm::dot(one, curvature * two);
  return {glm::dot(one, curvature * one), mixed, mixed, glm::dot(two, curvature * two)};
}

/// Tangents close to the grid's axes.
void set_tangents(CommonNormal& at) {
  const glm::dvec3 x(1.0, 0.0, 0.0);
  at.across_1 = glm::normalize(x - at.normal * at.normal.x);
  at.across_2 = glm::cross(at.normal, at.across_1);
}

/// Newton's method for the point of the tool's surface at which the two normals are opposite.
/// @param start  m, grid
/// @param reach  m: farthest step
std::optional<CommonNormal> common_normal(const PlacedPart& tool, const PlacedPart& body,
                                          const glm::dvec3& start, double reach) {
  CommonNormal at;
  at.on_tool = start;
  for (int step = 0; step < kMostNewtonSteps; ++step) {
    const Distance to_tool = tool.distance(at.on_tool);
    at.on_tool -= to_tool.value * to_tool.gradient;
    const Distance to_body = body.distance(at.on_tool);
    at.normal = to_body.gradient;
    if (at.normal.z < 0.5 || -to_tool.gradient.z < 0.5) {
      return std::nullopt;
    }
    set_tangents(at);
    at.depth = -to_body.value;
    at.on_body = at.on_tool - to_body.value * at.normal;
    at.tool_piece = piece_at(tool.part, tool.to_part(at.on_tool));
    at.body_piece = piece_at(body.part, body.to_part(at.on_body));
    const glm::dmat2 of_tool =
        in_tangents(tool, curvature_at(at.tool_piece, tool.to_part(at.on_tool)), at);
    const glm::dmat2 of_body =
        in_tangents(body, curvature_at(at.body_piece, body.to_part(at.on_body)), at);
    at.curvature = of_tool + of_body;
    const glm::dvec3 apart = to_tool.gradient + to_body.gradient;
    const glm::dvec2 residual(glm::dot(apart, at.across_1), glm::dot(apart, at.across_2));
    if (glm::length(residual) < kCommon) {
      return at;
    }
    // Below its surface the body's normals turn as those of the parallel surface.
    const glm::dmat2 deep =
        of_body * glm::inverse(glm::dmat2(1.0) - of_body * std::min(at.depth, reach));
    const glm::dmat2 bend = of_tool + deep;
    if (!(glm::determinant(bend) > 0.0)) {
      return std::nullopt;
    }
    glm::dvec2 move = -(glm::inverse(bend) * residual);
    const double far = glm::length(move);
    move *= far > reach ? reach / far : 1.0;
    at.on_tool += move.x * at.across_1 + move.y * at.across_2;
  }
  return at;
}

/// Distance to the nearest end of a smooth piece, over the overlap's reach in that direction.
/// @param inverse  of the curvature: the overlap is s' C s / 2 < depth
double room(const PlacedPart& part, const SurfacePiece& piece, const CommonNormal& at,
            const glm::dmat2& inverse) {
  double least = 1e300;
  for (const PieceBorder& border : piece.ends()) {
    const glm::dvec3 towards = border.direction * part.turn;
    const glm::dvec2 along(glm::dot(towards, at.across_1), glm::dot(towards, at.across_2));
    const double extent = std::sqrt(2.0 * at.depth * glm::dot(along, inverse * along));
    // Written so that NaN means no room.
    least = std::min(least, extent == 0.0 ? 1e300 : extent > 0.0 ? border.distance / extent : 0.0);
  }
  return least;
}

/// Principal curvatures and the direction of the smaller one.
struct Principal {
  double small = 0.0;
  double large = 0.0;
  glm::dvec2 direction{1.0, 0.0};
};

Principal principal(const glm::dmat2& curvature) {
  const double mean = 0.5 * (curvature[0][0] + curvature[1][1]);
  const double half = 0.5 * (curvature[0][0] - curvature[1][1]);
  const double mixed = curvature[0][1];
  const double spread = std::hypot(half, mixed);
  Principal result{mean - spread, mean + spread};
  if (spread > 1e-12 * mean) {
    const double angle = 0.5 * std::atan2(mixed, half) + 0.5 * std::numbers::pi;
    result.direction = {std::cos(angle), std::sin(angle)};
  }
  return result;
}

/// How far the surfaces lie beyond their paraboloid, over the paraboloid itself, averaged over the
/// rim of Hertz' ellipse: (a / 2 R)^2 for a sphere.
double beyond_paraboloid(const PlacedPart& tool, const PlacedPart& body, const CommonNormal& at,
                         const Principal& bend, const EllipticContact& ellipse) {
  constexpr int kPlaces = 8;
  const glm::dvec3 along = bend.direction.x * at.across_1 + bend.direction.y * at.across_2;
  const glm::dvec3 across = glm::cross(at.normal, along);
  const glm::dvec3 tool_point = tool.to_part(at.on_tool);
  const glm::dvec3 body_point = body.to_part(at.on_body);
  const glm::dvec3 tool_normal = tool.turn * -at.normal;
  const glm::dvec3 body_normal = body.turn * at.normal;
  double sum = 0.0;
  for (int k = 0; k < kPlaces; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + 0.5) / kPlaces;
    const glm::dvec3 aside =
        ellipse.major * std::cos(angle) * along + ellipse.minor * std::sin(angle) * across;
    sum += drop_at(at.tool_piece, tool_point, tool_normal, tool.turn * aside) +
           drop_at(at.body_piece, body_point, body_normal, body.turn * aside);
  }
  const double paraboloid = 0.25 * (bend.small * ellipse.major * ellipse.major +
                                    bend.large * ellipse.minor * ellipse.minor);
  return sum / kPlaces / paraboloid - 1.0;
}

/// What a region's shapes tell about its contact.
/// @param at  out: the deepest place, when share > 0
SmoothContact find_contact(const Grid& grid, const Overlap& overlap,
                           std::optional<CommonNormal>& at) {
  const Model& model = grid.model;
  const Pose in_tool = grid_in_tool(grid);
  const Pose in_body = grid_in_body(grid.frame);
  const glm::dvec3 start = body_to_grid(grid.frame, overlap.center);
  const Nearest of_tool =
      nearest_part(model, model.tools.at<OwnedRows>(grid.identity.tool).parts, in_tool, start);
  const Nearest of_body =
      nearest_part(model, model.bodies.at<OwnedRows>(grid.identity.body).parts, in_body, start);
  const ShapePart& tool_part = model.parts.at<ShapePart>(of_tool.row);
  const ShapePart& body_part = model.parts.at<ShapePart>(of_body.row);
  SmoothContact contact;
  if (tool_part.kind == ShapeKind::kMesh || body_part.kind == ShapeKind::kMesh) {
    return contact;
  }
  const PlacedPart tool = place_part(tool_part, in_tool);
  const PlacedPart body = place_part(body_part, in_body);
  const double size = std::max(grid.frame.half_size.x, grid.frame.half_size.y);
  at = common_normal(tool, body, start, 0.5 * size);
  if (!at) {
    return contact;
  }
  const Principal bend = principal(at->curvature);
  // The overlap of a cylinder on a plane has no end along its axis, where rounding bends it either
  // way: its extent would be arbitrary.
  if (!(bend.small > kFlatCurvature * bend.large)) {
    return contact;
  }
  // Along a cylinder the deepest place is arbitrary, too. If the cells are deeper, it is another
  // place where the normals are opposite.
  const double deepest =
      rising(at->depth, kOther * overlap.largest_depth, kDeepest * overlap.largest_depth);
  contact.depth = at->depth;
  if (contact.depth <= 0.0) {
    // They do not touch, or hardly.
    contact.share = overlap.largest_depth < kJust * size ? 1.0 : 0.0;
    return contact;
  }
  const glm::dmat2 inverse = glm::inverse(at->curvature);
  const double inside =
      std::min(room(tool, at->tool_piece, *at, inverse), room(body, at->body_piece, *at, inverse));
  const double extent = std::sqrt(2.0 * contact.depth / bend.small);
  const double other = std::min(of_tool.other, of_body.other) / extent;
  contact.share = rising(inside, kUnknownPiece, kKnownPiece) *
                  rising(other, kOtherPartNear, kOtherPartFar) * deepest;
  if (contact.share <= 0.0) {
    return contact;
  }
  contact.extent = glm::sqrt(2.0 * contact.depth * glm::dvec2(inverse[0][0], inverse[1][1]));
  contact.curvature_1 = bend.small;
  contact.curvature_2 = bend.large;
  contact.beyond = beyond_paraboloid(tool, body, *at, bend,
                                     elliptic_contact(contact.depth, bend.small, bend.large));
  if (!std::isfinite(contact.beyond)) {
    contact = SmoothContact{};
  }
  return contact;
}

/// Moves the frame's normal, and the overlap's points and depth, to what the shapes give, in
/// proportion to how well they determine it.
/// @return the deepest place on the body, m, grid
glm::dvec2 move_region_to(const CommonNormal& at, double share, RegionFrame& frame,
                          Overlap& overlap) {
  const glm::dvec3 body_point = grid_to_body(frame, at.on_body);
  const glm::dvec3 tool_point = grid_to_body(frame, at.on_tool);
  const glm::dvec3 normal = grid_to_body(frame, at.normal) - frame.origin;
  turn_normal_to(frame, glm::normalize(glm::mix(frame.normal, normal, share)));
  overlap.mean_normal = frame.normal;
  overlap.largest_depth = std::lerp(overlap.largest_depth, at.depth, share);
  overlap.center = glm::mix(overlap.center, tool_point, share);
  overlap.rest_center = glm::mix(overlap.rest_center, body_point, share);
  return glm::dvec2(body_to_grid(frame, body_point));
}

}  // namespace

void refine_overlap(StepContext& context, std::uint32_t region) {
  State& state = context.state;
  const Grid grid = grid_of(context, region);
  Overlap& overlap = state.regions.at<Overlap>(region);
  SmoothContact& contact = state.regions.at<SmoothContact>(region);
  std::optional<CommonNormal> at;
  contact = overlap.area > 0.0 ? find_contact(grid, overlap, at) : SmoothContact{};
  if (contact.share > 0.0 && contact.depth > 0.0) {
    contact.place = move_region_to(*at, contact.share, grid.frame, overlap);
  }
}

}  // namespace torsion::engine
