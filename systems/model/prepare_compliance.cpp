#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/geometry/bounds.hpp"
#include "systems/geometry/distance.hpp"
#include "systems/model/finite_elements/compliance.hpp"
#include "systems/model/finite_elements/solid_surface.hpp"
#include "systems/model/prepare.hpp"

namespace torsion::engine {
namespace {

/// So many that they are a tenth of a cube's side apart where contacts are expected.
constexpr std::uint32_t kPortsPerBody = 128;
constexpr std::size_t kFewestPorts = 4;
constexpr double kClampOfPoint = 0.25;    // of the shortest side
constexpr double kClampTolerance = 1e-6;  // of the longest side; of a mesh, what its edges are off

/// How far outside of a face of the body points on it may seem to lie, m. The distance to a mesh
/// rounds edges by up to half a fine cell of its field: without this, a face's rim would not be
/// held.
double face_tolerance(const Model& model, std::uint32_t row) {
  const Bounds& bounds = model.bodies.at<Bounds>(row);
  const glm::dvec3 size = bounds.highest - bounds.lowest;
  double tolerance = kClampTolerance * std::max({size.x, size.y, size.z});
  for (const ShapePart& part : model.parts.rows<ShapePart>(model.bodies.at<OwnedRows>(row).parts)) {
    if (part.kind == ShapeKind::kMesh) {
      const DistanceField& field = model.fields.at<DistanceField>(part.field);
      tolerance = std::max(tolerance, 0.5 * field.spacing / field.subdivision);
    }
  }
  return tolerance;
}

bool is_clamped(const Model& model, std::uint32_t row, const glm::dvec3& point) {
  const FixedRegion& fixed = model.bodies.at<FixedRegion>(row);
  const Bounds& bounds = model.bodies.at<Bounds>(row);
  const glm::dvec3 size = bounds.highest - bounds.lowest;
  switch (fixed.kind) {
    case FixedKind::kFace:
      return glm::dot(point - fixed.point, fixed.normal) <= face_tolerance(model, row);
    case FixedKind::kPoint:
      return glm::distance(point, fixed.point) <=
             kClampOfPoint * std::min({size.x, size.y, size.z});
    case FixedKind::kVolumes:
      break;
  }
  return std::ranges::any_of(
      model.fixed_volumes.rows<FixedVolume>(fixed.volumes),
      [&point](const FixedVolume& volume) { return in_volume(volume, point); });
}

template <class T>
void add_bytes(std::vector<std::byte>& bytes, std::span<const T> values) {
  const auto raw = std::as_bytes(values);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

/// Everything that distinguishes the body's shape and clamp from another's.
std::vector<std::byte> identity_of(const BodyDescription& description) {
  std::vector<std::byte> bytes;
  for (const PartDescription& part : description.parts) {
    const double numbers[] = {static_cast<double>(part.shape.kind),
                              part.shape.half_extent.x,
                              part.shape.half_extent.y,
                              part.shape.half_extent.z,
                              part.shape.pose.position.x,
                              part.shape.pose.position.y,
                              part.shape.pose.position.z,
                              part.shape.pose.rotation.w,
                              part.shape.pose.rotation.x,
                              part.shape.pose.rotation.y,
                              part.shape.pose.rotation.z};
    add_bytes(bytes, std::span<const double>(numbers));
    if (part.shape.kind == ShapeKind::kMesh) {
      add_bytes(bytes, std::span<const glm::dvec3>(part.surface.positions));
      add_bytes(bytes, std::span<const glm::uvec3>(part.surface.triangles));
      if (part.solid != nullptr) {
        add_bytes(bytes, std::span<const glm::dvec3>(part.solid->positions));
      }
    }
  }
  const FixedRegion& fixed = description.fixed;
  const double clamp[] = {static_cast<double>(fixed.kind),
                          fixed.point.x,
                          fixed.point.y,
                          fixed.point.z,
                          fixed.normal.x,
                          fixed.normal.y,
                          fixed.normal.z};
  add_bytes(bytes, std::span<const double>(clamp));
  for (const FixedVolume& volume : description.fixed_volumes) {
    add_bytes(bytes, std::span<const glm::dmat3>(&volume.to_unit, 1));
    const double rest[] = {volume.center.x, volume.center.y, volume.center.z,
                           static_cast<double>(volume.kind)};
    add_bytes(bytes, std::span<const double>(rest));
  }
  return bytes;
}

/// The first `rows` of a matrix, column by column: the effects of one force lie together.
void append_values(const Eigen::MatrixXd& matrix, std::size_t rows,
                   std::vector<ComplianceValue>& values) {
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(rows); ++i) {
      values.push_back({matrix(i, j)});
    }
  }
}

/// Elements through a wall in its worst orientation: along the coarsest axis of the lattice, but
/// for axes along which the body is no thicker than the wall and has eight elements.
double across_wall(const glm::dvec3& extent, std::uint32_t elements, double wall) {
  const double longest = std::max({extent.x, extent.y, extent.z});
  double coarsest = 0.0;  // m
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = std::max(1.0 * kFewestLatticeCells, elements * extent[axis] / longest);
    if (extent[axis] > 1.5 * wall) {
      coarsest = std::max(coarsest, extent[axis] / cells);
    }
  }
  return coarsest > 0.0 ? wall / coarsest : 1.0 * kFewestLatticeCells;
}

/// The solid's share of the bounds' volume.
double filled_share(const ElasticSolid& solid) {
  constexpr int kAlong = 16;
  int inside = 0;
  for (int i = 0; i < kAlong * kAlong * kAlong; ++i) {
    const glm::dvec3 share =
        (glm::dvec3(i % kAlong, i / kAlong % kAlong, i / (kAlong * kAlong)) + 0.5) /
        static_cast<double>(kAlong);
    const glm::dvec3 point =
        solid.bounds.lowest + share * (solid.bounds.highest - solid.bounds.lowest);
    inside += solid.signed_distance(point).value < 0.0 ? 1 : 0;
  }
  return static_cast<double>(inside) / (kAlong * kAlong * kAlong);
}

/// More elements where walls are thin, so that a wall has three, as long as there are no more than
/// 12000.
std::uint32_t elements_for_walls(const ElasticSolid& solid, double wall, std::uint32_t elements) {
  constexpr double kAcrossWall = 3.0;
  constexpr double kInAll = 12000.0;
  constexpr std::uint32_t kMost = 64;
  const glm::dvec3 extent = solid.bounds.highest - solid.bounds.lowest;
  const double filled = filled_share(solid);
  while (elements < kMost && across_wall(extent, elements, wall) < kAcrossWall &&
         filled * lattice_cells(extent, elements + 1) <= kInAll) {
    ++elements;
  }
  return elements;
}

/// With three digits.
std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Whether elements and ports are fine enough for a body's walls.
/// @return what to do where they are not
Result<Done> holds_walls(const ElasticSolid& solid, double wall, std::uint32_t elements,
                         std::span<const Port> ports, const ExpectedPlace& place) {
  constexpr double kFewestAcross = 1.4;    // elements: with fewer, walls have holes
  constexpr double kFarthestApart = 1.25;  // over the thickness
  const double across = across_wall(solid.bounds.highest - solid.bounds.lowest, elements, wall);
  if (across < kFewestAcross) {
    return Error{"the body's walls are " + text_of(1e3 * wall) + " mm thick, " + text_of(across) +
                 " of its finite elements, which is too few: make them thicker, or take body model "
                 "skeleton or none"};
  }
  const double apart = port_distance_over_thickness(solid, ports, place);
  if (apart > kFarthestApart) {
    return Error{"the body's walls are " + text_of(1e3 * wall) +
                 " mm thick, and the points at which its compliance is known are up to " +
                 text_of(apart) + " times as far apart as it is thick" +
                 (place.known ? " where contacts are expected"
                              : "; an animation of the tool says where they are needed") +
                 ": make the walls thicker, or take body model skeleton or none"};
  }
  return Done{};
}

}  // namespace

Result<PreparedCompliance> prepare_compliance(const BodyDescription& description,
                                              const Model& model, std::uint32_t row,
                                              const ExpectedPlace& place, std::uint32_t threads,
                                              bool use_cache,
                                              const std::function<void(double)>& progress) {
  const Range parts = model.bodies.at<OwnedRows>(row).parts;
  ElasticSolid solid;
  solid.signed_distance = [&model, parts](const glm::dvec3& point) {
    return signed_distance(model, parts, point);
  };
  solid.bounds = model.bodies.at<Bounds>(row);
  solid.clamped = [&model, row](const glm::dvec3& point) {
    return is_clamped(model, row, point);
  };
  solid.elasticity = model.bodies.at<Elasticity>(row);
  const double wall = wall_thickness(solid, sample_solid_surface(solid));
  const std::vector<Port> ports = choose_ports(solid, kPortsPerBody, place);
  PreparedCompliance prepared;
  if (ports.size() <= kFewestPorts) {
    return prepared;
  }
  SmoothComplianceOptions options;
  options.progress = progress;
  options.couples = false;
  options.elements = elements_for_walls(solid, wall, compliance_elements(solid.bounds));
  if (const Result<Done> fits = holds_walls(solid, wall, options.elements, ports, place); !fits) {
    return Error{"node '" + description.node + "', body model compliance: " + fits.error().text};
  }
  options.threads = threads;
  const Result<SmoothCompliance> built =
      use_cache ? load_or_build_smooth_compliance(solid, identity_of(description), ports, options)
                : build_smooth_compliance(solid, ports, options);
  if (!built) {
    return Error{"node '" + description.node + "', body model compliance: " + built.error().text};
  }
  for (const Port& port : ports) {
    prepared.ports.push_back({port.position, port.normal});
    if (prepared.anchors.size() < kAnchorsPerBody) {
      prepared.anchors.push_back({port.position});
    }
  }
  append_values(built.value().matrix, 3 * prepared.ports.size(), prepared.values);
  append_values(built.value().turns, 3 * prepared.anchors.size(), prepared.values);
  return prepared;
}

}  // namespace torsion::engine
