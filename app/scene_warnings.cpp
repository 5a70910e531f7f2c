#include "app/scene_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "render/image_io.hpp"
#include "systems/geometry/distance.hpp"
#include "systems/math/frames.hpp"
#include "systems/model/choose_models.hpp"

namespace torsion::engine {
namespace {

/// Of one tool along its way: how near it comes to any body, and where on it that is.
struct Approach {
  double nearest = 1e300;  // m, negative inside
  std::uint32_t body = 0;
  Bounds touched;  // m, tool: around its points that are inside a body
  bool touches = false;
};

void add_point(Bounds& bounds, bool first, const glm::dvec3& point) {
  bounds.lowest = first ? point : glm::min(bounds.lowest, point);
  bounds.highest = first ? point : glm::max(bounds.highest, point);
}

Approach approach_of(const World& world, std::uint32_t tool,
                     const std::vector<std::vector<Pose>>& poses) {
  Approach approach;
  for (const std::vector<Pose>& at_time : poses) {
    for (const SurfaceSample& sample :
         world.model.samples.rows<SurfaceSample>(world.model.tools.at<OwnedRows>(tool).samples)) {
      const glm::dvec3 point = to_outer(at_time[tool], sample.position);
      for (std::uint32_t body = 0; body < world.model.bodies.size(); ++body) {
        const double distance =
            signed_distance(world.model, world.model.bodies.at<OwnedRows>(body).parts,
                            to_inner(world.model.bodies.at<Pose>(body), point))
                .value;
        if (distance < approach.nearest) {
          approach.nearest = distance;
          approach.body = body;
        }
        if (distance < 0.0) {
          add_point(approach.touched, !approach.touches, sample.position);
          approach.touches = true;
        }
      }
    }
  }
  return approach;
}

Bounds widened(const Bounds& bounds, double by) {
  return {bounds.lowest - by, bounds.highest + by};
}

bool meets(const Bounds& bounds, const glm::dvec3& lowest, const glm::dvec3& highest) {
  for (int axis = 0; axis < 3; ++axis) {
    if (highest[axis] < bounds.lowest[axis] || lowest[axis] > bounds.highest[axis]) {
      return false;
    }
  }
  return true;
}

/// The widest facet within the bounds where a mesh is bent as a facetted round surface is, by more
/// than rounding and by less than at an edge that is meant: across the bend, m.
double widest_facet(const SurfaceMesh& mesh, const Bounds& bounds) {
  constexpr double kLeast = 0.02;  // rad
  constexpr double kMost = 0.9;    // a ball of eight meridians is still one
  struct Side {
    glm::dvec3 normal;
    double area;  // m^2
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Side> sides;
  double widest = 0.0;
  for (const glm::uvec3& triangle : mesh.triangles) {
    const glm::dvec3& a = mesh.positions[triangle.x];
    const glm::dvec3 normal =
        0.5 * glm::cross(mesh.positions[triangle.y] - a, mesh.positions[triangle.z] - a);
    const double area = glm::length(normal);
    for (int corner = 0; area > 0.0 && corner < 3; ++corner) {
      const std::uint32_t from = triangle[corner];
      const std::uint32_t to = triangle[(corner + 1) % 3];
      const Side side{normal / area, area};
      const auto [other, is_first] = sides.emplace(std::minmax(from, to), side);
      if (is_first) {
        continue;
      }
      const double bend =
          std::acos(std::clamp(glm::dot(other->second.normal, side.normal), -1.0, 1.0));
      const glm::dvec3& begin = mesh.positions[from];
      const glm::dvec3& end = mesh.positions[to];
      if (bend > kLeast && bend < kMost &&
          meets(bounds, glm::min(begin, end), glm::max(begin, end))) {
        // The narrower of both: a cylinder's side is long where it goes over into a round end.
        widest =
            std::max(widest, 2.0 * std::min(area, other->second.area) / glm::distance(begin, end));
      }
    }
  }
  return widest;
}

/// The middle one of the longest edges of drawn triangles within the bounds, m; 0 where there is
/// none.
double drawn_facet(const DrawMesh& draw, const Bounds& bounds) {
  std::vector<double> edges;
  for (const glm::uvec3& triangle : draw.triangles) {
    const glm::dvec3 a(draw.positions[triangle.x]);
    const glm::dvec3 b(draw.positions[triangle.y]);
    const glm::dvec3 c(draw.positions[triangle.z]);
    if (meets(bounds, glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c))) {
      edges.push_back(std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)}));
    }
  }
  if (edges.empty()) {
    return 0.0;
  }
  const auto middle = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
  std::nth_element(edges.begin(), middle, edges.end());
  return *middle;
}

/// How far the drawn vertices of a tool or body are from what is felt, over the longest side.
double drawn_apart(const World& world, Range parts, const DrawMesh& draw) {
  glm::dvec3 lowest(1e300);
  glm::dvec3 highest(-1e300);
  double apart = 0.0;
  for (const glm::vec3& position : draw.positions) {
    const glm::dvec3 point(position);
    lowest = glm::min(lowest, point);
    highest = glm::max(highest, point);
    double nearest = 1e300;  // to the surface of any part: those inside others are drawn, too
    for (std::uint32_t part = parts.first; part < parts.first + parts.count; ++part) {
      nearest = std::min(nearest, std::abs(signed_distance(world.model, {part, 1}, point).value));
    }
    apart = std::max(apart, nearest);
  }
  const glm::dvec3 size = highest - lowest;
  return draw.positions.empty() ? 0.0 : apart / std::max({size.x, size.y, size.z, 1e-300});
}

bool has_exact_part(const std::vector<PartDescription>& parts) {
  return std::ranges::any_of(
      parts, [](const PartDescription& part) { return part.shape.kind != ShapeKind::kMesh; });
}

/// Of textures that are not drawn.
void warn_of_textures(const std::string& node, const std::vector<DrawMaterial>& materials,
                      std::vector<std::string>& warnings) {
  constexpr std::uint32_t kLargestSide = 16384;  // pixels, as of what renders on a processor
  std::set<const EncodedImage*> seen;
  for (const DrawMaterial& material : materials) {
    for (const MaterialTexture& texture : material.textures) {
      const EncodedImage* encoded = texture.image.get();
      if (encoded == nullptr || !seen.insert(encoded).second) {
        continue;
      }
      std::string fault = encoded->fault;
      if (fault.empty()) {
        const Result<Image> image = decode_image(encoded->bytes, kLargestSide);
        fault = image ? "" : image.error().text + "; save it as PNG or JPEG";
      }
      if (!fault.empty()) {
        warnings.push_back(fmt::format(R"("{}" is drawn without its texture "{}": {})", node,
                                       encoded->name, fault));
      }
    }
  }
}

/// Of what is drawn of a tool or body.
void warn_of_drawing(const World& world, const std::string& node, Range rows,
                     const std::vector<PartDescription>& parts, const DrawMesh& draw,
                     std::vector<std::string>& warnings) {
  constexpr double kApart = 0.05;  // of the longest side
  const double apart = drawn_apart(world, rows, draw);
  if (has_exact_part(parts) && apart > kApart) {
    warnings.push_back(fmt::format(
        "\"{}\" is felt as an exact shape but drawn as another: vertices are up to {:.2g} % of its "
        "size off; take torsion_draw shape, torsion_shape mesh, or a mesh of the shape",
        node, 100.0 * apart));
  }
  warn_of_textures(node, draw.materials, warnings);
}

/// Of meshes whose facets are longer than the contact is wide.
void warn_of_facets(const std::string& node, const std::vector<PartDescription>& parts,
                    const Bounds& touched, double radius, std::vector<std::string>& warnings) {
  for (const PartDescription& part : parts) {
    const double facet = part.shape.kind == ShapeKind::kMesh
                             ? widest_facet(part.surface, widened(touched, 0.1 * radius))
                             : 0.0;
    if (facet > radius) {
      warnings.push_back(fmt::format(
          "\"{}\" is a round surface of facets up to {:.3g} mm wide where the contact's radius is "
          "{:.3g} mm: what is felt are the facets; cut it to {:.2g} mm there, or take an exact "
          "shape",
          node, 1e3 * facet, 1e3 * radius, 250.0 * radius));
    }
  }
}

/// Of contacts with a body, as far as its tools' way tells.
void warn_of_contact(const SceneDescription& scene, const Simulation& simulation, std::uint32_t row,
                     const ExpectedContact& contact, std::vector<std::string>& warnings) {
  const BodyDescription& body = scene.bodies[row];
  const double facet = drawn_facet(body.draw, widened(contact.touched, contact.radius));
  if (facet > 2.0 * contact.radius) {
    warnings.push_back(fmt::format(
        "\"{}\" is drawn with faces of {:.3g} mm where the contact's radius is {:.3g} mm: neither "
        "dent nor twist will show; cut it to {:.2g} mm there (forces do not depend on it)",
        body.node, 1e3 * facet, 1e3 * contact.radius, 500.0 * contact.radius));
  }
  warn_of_facets(body.node, body.parts, contact.touched, contact.radius, warnings);
  const ModelChoice& choice = simulation.choices[row];
  const std::optional<double> error = model_error(choice, contact, body.elasticity.poisson_ratio);
  if (error && *error > choice.models.tolerance) {
    warnings.push_back(fmt::format(
        "\"{}\": the torque of contact model {} may be off by {:.2g} % of its largest, more than "
        "torsion_tolerance ({:.2g} %)",
        body.node, choice.models.contact == ContactModel::kMdr ? "mdr" : "patch", 100.0 * *error,
        100.0 * choice.models.tolerance));
  }
}

/// Of a grid that the command line has made coarser than the models need.
void warn_of_grid(const Simulation& simulation, const PrepareOptions& options,
                  std::vector<std::string>& warnings) {
  const std::uint32_t needed = choose_grid_side(simulation.choices);
  if (options.settings.grid_side != 0 && options.settings.grid_side < needed) {
    warnings.push_back(fmt::format(
        "{} cells a side are fewer than the {} that keep the error within torsion_tolerance",
        options.settings.grid_side, needed));
  }
}

}  // namespace

std::vector<std::string> scene_warnings(const SceneDescription& scene, const Simulation& simulation,
                                        const std::vector<std::vector<Pose>>& poses,
                                        const PrepareOptions& options) {
  const World& world = simulation.world;
  std::vector<std::string> warnings;
  double radius = 0.0;  // m, of the widest contact
  std::vector<ExpectedContact> contacts;
  for (std::uint32_t row = 0; row < scene.bodies.size(); ++row) {
    contacts.push_back(expect_contact(world.model, row, poses));
    radius = std::max(radius, contacts.back().radius);
  }
  for (std::uint32_t row = 0; row < scene.tools.size(); ++row) {
    const ToolDescription& tool = scene.tools[row];
    warn_of_drawing(world, tool.node, world.model.tools.at<OwnedRows>(row).parts, tool.parts,
                    tool.draw, warnings);
    if (poses.empty()) {
      continue;
    }
    const Approach approach = approach_of(world, row, poses);
    if (!approach.touches) {
      warnings.push_back(fmt::format(
          R"(tool "{}" never touches anything on its way: it comes within {:.3g} mm of "{}")",
          tool.node, 1e3 * approach.nearest, scene.bodies[approach.body].node));
    } else {
      warn_of_facets(tool.node, tool.parts, approach.touched, radius, warnings);
    }
  }
  for (std::uint32_t row = 0; row < scene.bodies.size(); ++row) {
    const BodyDescription& body = scene.bodies[row];
    warn_of_drawing(world, body.node, world.model.bodies.at<OwnedRows>(row).parts, body.parts,
                    body.draw, warnings);
    if (contacts[row].any) {
      warn_of_contact(scene, simulation, row, contacts[row], warnings);
    }
  }
  warn_of_grid(simulation, options, warnings);
  return warnings;
}

}  // namespace torsion::engine
