#include "systems/prepare_compliance.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/geometric.hpp>

#include "systems/body_models/smooth_compliance.hpp"
#include "systems/distance.hpp"
#include "systems/prepare_anchors.hpp"

namespace torsion {
namespace {

constexpr double kClampOfPoint = 0.25;    // of the shortest side
constexpr double kClampTolerance = 1e-6;  // of the longest side

bool in_volume(const FixedVolume& volume, const glm::dvec3& point) {
  const glm::dvec3 unit = volume.to_unit * (point - volume.center);
  return volume.kind == VolumeKind::kSphere
             ? glm::length(unit) <= 1.0
             : std::max({std::abs(unit.x), std::abs(unit.y), std::abs(unit.z)}) <= 1.0;
}

bool is_clamped(const World& world, std::uint32_t row, const glm::dvec3& point) {
  const FixedRegion& fixed = world.bodies.at<FixedRegion>(row);
  const Bounds& bounds = world.bodies.at<Bounds>(row);
  const glm::dvec3 size = bounds.highest - bounds.lowest;
  switch (fixed.kind) {
    case FixedKind::kFace:
      return glm::dot(point - fixed.point, fixed.normal) <=
             kClampTolerance * std::max({size.x, size.y, size.z});
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

}  // namespace

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
  const std::vector<Port> ports = choose_ports(solid, kAnchorsPerBody);
  PreparedCompliance prepared;
  if (ports.size() <= 4) {
    return prepared;
  }
  SmoothComplianceOptions options;
  options.progress = progress;
  const Result<SmoothCompliance> built =
      use_cache ? load_or_build_smooth_compliance(solid, identity_of(description), ports, options)
                : build_smooth_compliance(solid, ports, options);
  if (!built) {
    return Error{"node '" + description.node + "', body model compliance: " + built.error().text};
  }
  for (const Port& port : ports) {
    prepared.anchors.push_back({port.position, port.normal});
  }
  const Eigen::MatrixXd& matrix = built.value().matrix;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      prepared.values.push_back({matrix(i, j)});
    }
  }
  return prepared;
}

}  // namespace torsion
