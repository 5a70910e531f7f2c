#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>

#include "systems/body/skeleton/beam_sections.hpp"
#include "systems/geometry/bounds.hpp"
#include "systems/geometry/distance.hpp"
#include "systems/math/frames.hpp"
#include "systems/model/prepare.hpp"

namespace torsion::engine {
namespace {

using std::numbers::pi;

constexpr std::size_t kCandidates = 4096;
constexpr std::size_t kRays = 48;

/// What the functions below read of a body.
struct Body {
  const Model& model;
  Range parts;
  FixedRegion fixed;
  std::span<const FixedVolume> volumes;
  Bounds bounds;
  double size;  // m, diagonal of the box
};

bool in_fixed_volume(const Body& body, const glm::dvec3& point) {
  return std::any_of(body.volumes.begin(), body.volumes.end(),
                     [&](const FixedVolume& volume) { return in_volume(volume, point); });
}

/// Whether a point of the surface belongs to the fixed region, or is so near to it that a beam
/// there would mean nothing.
bool is_held(const Body& body, const glm::dvec3& point) {
  const glm::dvec3 from_fixed = point - body.fixed.point;
  if (body.fixed.kind == FixedKind::kFace) {
    return glm::dot(from_fixed, body.fixed.normal) < 0.02 * body.size;
  }
  return glm::length(from_fixed) < 0.05 * body.size || in_fixed_volume(body, point);
}

// Places of the anchors.

/// Moves a point of the file's mesh onto the surface that contact uses; nullopt if that is not
/// near.
std::optional<glm::dvec3> on_surface(const Body& body, glm::dvec3 point) {
  for (int i = 0; i < 3; ++i) {
    const Distance distance = signed_distance(body.model, body.parts, point);
    if (!std::isfinite(distance.value) || std::abs(distance.value) > 0.1 * body.size) {
      return std::nullopt;
    }
    point -= distance.gradient * distance.value;
  }
  // Inside another part: not on the surface of the union.
  if (std::abs(signed_distance(body.model, body.parts, point).value) > 1e-3 * body.size) {
    return std::nullopt;
  }
  return point;
}

/// The k-th point of the two-dimensional sequence with the plastic number's ratios, which is evenly
/// spread even for few points.
glm::dvec2 even_point(std::size_t k) {
  const double u = 0.5 + 0.7548776662466927 * static_cast<double>(k);
  const double v = 0.5 + 0.5698402909980532 * static_cast<double>(k);
  return {u - std::floor(u), v - std::floor(v)};
}

double triangle_area(const SurfaceMesh& mesh, const glm::uvec3& triangle) {
  const glm::dvec3& a = mesh.positions[triangle.x];
  return 0.5 *
         glm::length(glm::cross(mesh.positions[triangle.y] - a, mesh.positions[triangle.z] - a));
}

/// About kCandidates points spread evenly by area over the free surface.
std::vector<glm::dvec3> candidates_of(const Body& body, const std::vector<PartDescription>& parts) {
  double total = 0.0;
  for (const PartDescription& part : parts) {
    for (const glm::uvec3& triangle : part.surface.triangles) {
      total += triangle_area(part.surface, triangle);
    }
  }
  const double spacing = total / static_cast<double>(kCandidates);  // m^2 for each candidate
  std::vector<glm::dvec3> candidates;
  double area = 0.0;
  double next = 0.5 * spacing;
  std::size_t k = 0;
  for (const PartDescription& part : parts) {
    for (const glm::uvec3& triangle : part.surface.triangles) {
      area += triangle_area(part.surface, triangle);
      while (next < area) {
        next += spacing;
        glm::dvec2 weights = even_point(k++);
        if (weights.x + weights.y > 1.0) {
          weights = glm::dvec2(1.0) - weights;
        }
        const glm::dvec3& a = part.surface.positions[triangle.x];
        const glm::dvec3 point = a + (part.surface.positions[triangle.y] - a) * weights.x +
                                 (part.surface.positions[triangle.z] - a) * weights.y;
        const std::optional<glm::dvec3> moved = on_surface(body, point);
        if (moved && !is_held(body, *moved)) {
          candidates.push_back(*moved);
        }
      }
    }
  }
  return candidates;
}

/// Farthest-point sampling: each next anchor is the candidate farthest from the fixed point and
/// from all before it. The first is the far end of the body's middle line, where contacts are
/// likeliest.
std::vector<glm::dvec3> choose_anchors(const Body& body, const std::vector<glm::dvec3>& candidates,
                                       std::uint32_t count) {
  std::vector<glm::dvec3> anchors;
  if (candidates.empty()) {
    return anchors;
  }
  const glm::dvec3 reference = beam_reference(body.fixed, body.bounds);
  const auto beyond = on_surface(
      body, body.fixed.point + reference * [&] {
        double reach = 0.0;  // the farthest candidate close to the line
        for (const glm::dvec3& candidate : candidates) {
          const glm::dvec3 offset = candidate - body.fixed.point;
          const double along = glm::dot(offset, reference);
          if (glm::length(offset - reference * along) < 0.05 * body.size) {
            reach = std::max(reach, along);
          }
        }
        return reach;
      }());
  anchors.push_back(beyond && !is_held(body, *beyond) ? *beyond : candidates.front());

  std::vector<double> nearest(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    nearest[i] = std::min(glm::length(candidates[i] - body.fixed.point),
                          glm::length(candidates[i] - anchors.front()));
  }
  while (anchors.size() < count) {
    const auto farthest = std::max_element(nearest.begin(), nearest.end());
    if (*farthest < 1e-6 * body.size) {
      break;
    }
    anchors.push_back(candidates[static_cast<std::size_t>(farthest - nearest.begin())]);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      nearest[i] = std::min(nearest[i], glm::length(candidates[i] - anchors.back()));
    }
  }
  return anchors;
}

/// Where a ray of a section leaves the body.
struct RayEnd {
  double distance = 0.0;   // m
  glm::dvec2 normal{0.0};  // of the outline there: unit, section plane; zero where not known
};

/// Follows `direction` from a point inside the body to its surface, at most `reach` far. Steps by
/// the distance, lengthened by Newton's method, are followed by bracketing. Interior distances of
/// convex bodies are concave: there a lengthened step can only end outside, which the bracket
/// corrects.
RayEnd follow_ray(const Body& body, const glm::dvec3& start, const glm::dvec3& direction,
                  const TransverseAxes& axes, double reach) {
  const double smallest_step = 1e-3 * reach;
  const double tolerance = 1e-7 * reach;
  double inside = 0.0;
  double outside = std::numeric_limits<double>::infinity();
  double t = 0.0;
  Distance distance = signed_distance(body.model, body.parts, start);
  for (int i = 0; i < 80; ++i) {
    const double slope = glm::dot(distance.gradient, direction);
    if (i > 0 && std::abs(distance.value) < tolerance) {
      break;
    }
    (distance.value < 0.0 ? inside : outside) = t;
    double step = 0.0;
    if (std::isfinite(outside)) {
      step = slope > 1e-3 ? -distance.value / slope : 0.0;
      if (step == 0.0 || t + step <= inside || t + step >= outside) {
        step = 0.5 * (inside + outside) - t;
      }
    } else {
      step = std::max(std::abs(distance.value) * (slope > 0.25 ? 1.0 / slope : 1.0), smallest_step);
    }
    t += step;
    if (t >= reach && inside < reach && !std::isfinite(outside)) {
      distance = signed_distance(body.model, body.parts, start + direction * reach);
      if (distance.value <= 0.0) {
        return {reach, glm::dvec2(0.0)};
      }
      t = reach;
      continue;
    }
    distance = signed_distance(body.model, body.parts, start + direction * t);
  }
  const glm::dvec2 normal(glm::dot(distance.gradient, axes.first),
                          glm::dot(distance.gradient, axes.second));
  const double length = glm::length(normal);
  return {t, length > 0.05 ? normal / length : glm::dvec2(0.0)};
}

/// The outline's corner or bulge between two neighbouring ray ends, from its tangents there: a
/// corner where they turn sharply, else the middle of the parabola that they span. nullopt where a
/// straight edge does.
std::optional<glm::dvec2> between(const glm::dvec2& a, const glm::dvec2& normal_a,
                                  const glm::dvec2& b, const glm::dvec2& normal_b) {
  constexpr double kStraight = 0.01;  // rad
  constexpr double kCorner = 0.45;    // rad
  const double sine = cross(normal_a, normal_b);
  const double turn = std::atan2(std::abs(sine), glm::dot(normal_a, normal_b));
  if (turn < kStraight || std::abs(sine) < 1e-9) {
    return std::nullopt;
  }
  const double ca = glm::dot(normal_a, a);
  const double cb = glm::dot(normal_b, b);
  const glm::dvec2 meeting =
      glm::dvec2(ca * normal_b.y - cb * normal_a.y, cb * normal_a.x - ca * normal_b.x) / sine;
  const bool in_sector = cross(a, meeting) > 0.0 && cross(meeting, b) > 0.0;
  if (!in_sector || glm::length(meeting) > 2.0 * std::max(glm::length(a), glm::length(b))) {
    return std::nullopt;
  }
  return turn > kCorner ? meeting : 0.25 * a + 0.5 * meeting + 0.25 * b;
}

/// Outline of the section through `point`, counter-clockwise about `point`, which must be inside
/// the body. Clipped to a disc of radius `reach`.
void cut_section(const Body& body, const glm::dvec3& point, const TransverseAxes& axes,
                 double reach, std::vector<glm::dvec2>& outline) {
  std::array<glm::dvec2, kRays> ends;
  std::array<glm::dvec2, kRays> normals;
  for (std::size_t i = 0; i < kRays; ++i) {
    const double angle = 2.0 * pi * static_cast<double>(i) / static_cast<double>(kRays);
    const glm::dvec2 plane_direction(std::cos(angle), std::sin(angle));
    const glm::dvec3 direction = axes.first * plane_direction.x + axes.second * plane_direction.y;
    const RayEnd end = follow_ray(body, point, direction, axes, reach);
    ends[i] = plane_direction * end.distance;
    normals[i] = end.normal;
  }
  outline.clear();
  for (std::size_t i = 0; i < kRays; ++i) {
    const std::size_t next = (i + 1) % kRays;
    outline.push_back(ends[i]);
    if (normals[i] != glm::dvec2(0.0) && normals[next] != glm::dvec2(0.0)) {
      if (const auto corner = between(ends[i], normals[i], ends[next], normals[next])) {
        outline.push_back(*corner);
      }
    }
  }
}

BeamSection section_of(const std::vector<glm::dvec2>& outline) {
  const PolygonMoments moments = polygon_moments(outline);
  const double polar = moments.xx + moments.yy;
  // Saint-Venant: 0 < J <= polar moment for every section, with equality for the circle.
  const double torsion = std::clamp(torsion_constant(outline), 1e-3 * polar, polar);
  return {moments.area, moments.xx, moments.yy, moments.xy, torsion, polar};
}

BeamSection scaled(const BeamSection& section, double factor) {
  return {
      section.area * factor,       section.bending_xx * factor,       section.bending_yy * factor,
      section.bending_xy * factor, section.torsion_constant * factor, section.polar * factor};
}

/// Sections of one beam. Where the straight beam is outside the body (which need not be convex), a
/// station takes the section of the nearest one inside, preferring the one towards the root; a beam
/// that is never inside gets a thin round rod. Sections in a fixed volume are made so stiff that
/// they add nothing.
void cut_beam(const Body& body, const glm::dvec3& anchor, const glm::dvec3& reference,
              std::vector<glm::dvec2>& outline, std::span<BeamSection> sections) {
  constexpr double kRigid = 1e4;
  const glm::dvec3 along = anchor - body.fixed.point;
  const double length = glm::length(along);
  const TransverseAxes axes = transverse_axes(along / length, reference);
  std::array<bool, kBeamStations> known{};
  std::array<bool, kBeamStations> held{};
  for (std::size_t k = 0; k < kBeamStations; ++k) {
    const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(kBeamStations);
    const glm::dvec3 point = body.fixed.point + along * share;
    held[k] = in_fixed_volume(body, point);
    if (signed_distance(body.model, body.parts, point).value >= -1e-4 * length) {
      continue;
    }
    cut_section(body, point, axes, length, outline);
    sections[k] = section_of(outline);
    known[k] = sections[k].area > 0.0;
  }
  const double rod = 0.05 * length;
  const double quarter = pi * rod * rod * rod * rod / 4.0;
  const BeamSection thin{pi * rod * rod, quarter, quarter, 0.0, 2.0 * quarter, 2.0 * quarter};
  for (std::size_t k = 0; k < kBeamStations; ++k) {
    if (known[k]) {
      continue;
    }
    sections[k] = thin;
    for (std::size_t step = 1; step < kBeamStations; ++step) {
      if (step <= k && known[k - step]) {
        sections[k] = sections[k - step];
        break;
      }
      if (k + step < kBeamStations && known[k + step]) {
        sections[k] = sections[k + step];
        break;
      }
    }
  }
  for (std::size_t k = 0; k < kBeamStations; ++k) {
    if (held[k]) {
      sections[k] = scaled(sections[k], kRigid);
    }
  }
}

}  // namespace

PreparedAnchors prepare_anchors(const BodyDescription& description, const Model& model, Range parts,
                                Range volumes, std::uint32_t count) {
  const Bounds bounds = bounds_of(description.parts);
  const Body body{model,
                  parts,
                  description.fixed,
                  model.fixed_volumes.rows<FixedVolume>(volumes),
                  bounds,
                  glm::length(bounds.highest - bounds.lowest)};
  const std::vector<glm::dvec3> anchors =
      choose_anchors(body, candidates_of(body, description.parts), count);
  const glm::dvec3 reference = beam_reference(body.fixed, body.bounds);

  PreparedAnchors prepared;
  prepared.sections.resize(anchors.size() * kBeamStations);
  std::vector<glm::dvec2> outline;
  outline.reserve(2 * kRays);
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    prepared.anchors.push_back({anchors[i]});
    cut_beam(body, anchors[i], reference, outline,
             std::span(prepared.sections).subspan(i * kBeamStations, kBeamStations));
  }
  return prepared;
}

}  // namespace torsion::engine
