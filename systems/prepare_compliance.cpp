#include "systems/prepare_compliance.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <thread>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "systems/body_models/smooth_compliance.hpp"
#include "systems/distance.hpp"
#include "systems/fixed_volume.hpp"
#include "systems/prepare_anchors.hpp"

namespace torsion {
namespace {

/// So many that they are a tenth of a cube's side apart where contacts are expected.
constexpr std::uint32_t kPortsPerBody = 128;
constexpr std::size_t kFewestPorts = 4;
constexpr double kClampOfPoint = 0.25;    // of the shortest side
constexpr double kClampTolerance = 1e-6;  // of the longest side; of a mesh, what its edges are off

/// How far beyond a face of the body what is on it may seem to lie, m. The distance to a mesh
/// rounds edges by up to half a fine cell of its field: a face's rim would not be held.
double face_tolerance(const World& world, std::uint32_t row) {
  const Bounds& bounds = world.bodies.at<Bounds>(row);
  const glm::dvec3 size = bounds.highest - bounds.lowest;
  double tolerance = kClampTolerance * std::max({size.x, size.y, size.z});
  for (const ShapePart& part : world.parts.rows<ShapePart>(world.bodies.at<OwnedRows>(row).parts)) {
    if (part.kind == ShapeKind::kMesh) {
      const DistanceField& field = world.fields.at<DistanceField>(part.field);
      tolerance = std::max(tolerance, 0.5 * field.spacing / field.subdivision);
    }
  }
  return tolerance;
}

bool is_clamped(const World& world, std::uint32_t row, const glm::dvec3& point) {
  const FixedRegion& fixed = world.bodies.at<FixedRegion>(row);
  const Bounds& bounds = world.bodies.at<Bounds>(row);
  const glm::dvec3 size = bounds.highest - bounds.lowest;
  switch (fixed.kind) {
    case FixedKind::kFace:
      return glm::dot(point - fixed.point, fixed.normal) <= face_tolerance(world, row);
    case FixedKind::kPoint:
      return glm::distance(point, fixed.point) <=
             kClampOfPoint * std::min({size.x, size.y, size.z});
    case FixedKind::kVolumes:
      break;
  }
  return std::ranges::any_of(
      world.fixed_volumes.rows<FixedVolume>(fixed.volumes),
      [&point](const FixedVolume& volume) { return in_volume(volume, point); });
}

template <class T>
void add_bytes(std::vector<std::byte>& bytes, std::span<const T> values) {
  const auto raw = std::as_bytes(values);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

/// All that tells the body's shape and clamp from another's.
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

/// The first `rows` of a matrix, column by column: what one force does is together.
void append_values(const Eigen::MatrixXd& matrix, std::size_t rows,
                   std::vector<ComplianceValue>& values) {
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(rows); ++i) {
      values.push_back({matrix(i, j)});
    }
  }
}

}  // namespace

std::uint32_t compliance_elements(const Bounds& bounds) {
  constexpr double kInAll = 4500.0;
  constexpr double kFewest = 8.0;  // along any side (build_solid_grid)
  const glm::dvec3 extent = bounds.highest - bounds.lowest;
  const double longest = std::max({extent.x, extent.y, extent.z});
  std::uint32_t elements = 16;
  const auto in_all = [&](std::uint32_t along) {
    const glm::dvec3 cells = glm::max(extent * (along / longest), glm::dvec3(kFewest));
    return cells.x * cells.y * cells.z;
  };
  while (elements < 40 && in_all(elements + 1) <= kInAll) {
    ++elements;
  }
  return elements;
}

Result<PreparedCompliance> prepare_compliance(const BodyDescription& description,
                                              const World& world, std::uint32_t row, bool use_cache,
                                              const std::function<void(double)>& progress) {
  const Range parts = world.bodies.at<OwnedRows>(row).parts;
  ElasticSolid solid;
  solid.signed_distance = [&world, parts](const glm::dvec3& point) {
    return signed_distance(world, parts, point);
  };
  solid.bounds = world.bodies.at<Bounds>(row);
  solid.clamped = [&world, row](const glm::dvec3& point) {
    return is_clamped(world, row, point);
  };
  solid.elasticity = world.bodies.at<Elasticity>(row);
  const std::vector<Port> ports = choose_ports(solid, kPortsPerBody);
  PreparedCompliance prepared;
  if (ports.size() <= kFewestPorts) {
    return prepared;
  }
  SmoothComplianceOptions options;
  options.progress = progress;
  options.couples = false;
  options.elements = compliance_elements(solid.bounds);
  options.threads = std::max(1U, std::thread::hardware_concurrency());
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

}  // namespace torsion
