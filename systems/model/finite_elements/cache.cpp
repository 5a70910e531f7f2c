#include "systems/model/cache.hpp"

#include <array>
#include <cstring>
#include <optional>

#include "systems/model/finite_elements/compliance.hpp"

namespace torsion {
namespace {

constexpr std::uint32_t kVersion = 6;  // raise it when the same solid and ports give other numbers

std::uint32_t width_of(const SmoothComplianceOptions& options) {
  return options.couples ? 6 : 3;
}

CacheKey key_of(const ElasticSolid& solid, std::span<const std::byte> identity,
                std::span<const Port> ports, const SmoothComplianceOptions& options) {
  static_assert(sizeof(Port) == 6 * sizeof(double), "ports are hashed as bytes");
  const std::uint32_t width = width_of(options);
  const std::array<std::span<const std::byte>, 6> content{
      identity,
      std::as_bytes(std::span(&solid.bounds, 1)),
      std::as_bytes(ports),
      std::as_bytes(std::span(&solid.elasticity.poisson_ratio, 1)),
      std::as_bytes(std::span(&options.elements, 1)),
      std::as_bytes(std::span(&width, 1))};
  return cache_key("smooth_compliance", kVersion, content);
}

std::span<const std::byte> bytes_of(const Eigen::MatrixXd& matrix) {
  return std::as_bytes(std::span(matrix.data(), static_cast<std::size_t>(matrix.size())));
}

/// The matrices, then the asymmetry.
std::vector<std::byte> to_bytes(const SmoothCompliance& compliance) {
  std::vector<std::byte> bytes;
  for (const std::span<const std::byte> part :
       {bytes_of(compliance.matrix), bytes_of(compliance.turns),
        std::as_bytes(std::span(&compliance.relative_asymmetry, 1))}) {
    bytes.insert(bytes.end(), part.begin(), part.end());
  }
  return bytes;
}

/// nullopt when those are no matrices of so many rows.
std::optional<SmoothCompliance> from_bytes(std::span<const std::byte> bytes, std::size_t rows,
                                           bool couples) {
  const std::size_t matrix_bytes = rows * rows * sizeof(double);
  const std::size_t turns_bytes = couples ? 0 : matrix_bytes;
  if (bytes.size() != matrix_bytes + turns_bytes + sizeof(double)) {
    return std::nullopt;
  }
  const auto side = static_cast<Eigen::Index>(rows);
  const Eigen::Index turns_side = couples ? 0 : side;
  SmoothCompliance compliance{Eigen::MatrixXd(side, side), Eigen::MatrixXd(turns_side, turns_side),
                              0.0};
  std::memcpy(compliance.matrix.data(), bytes.data(), matrix_bytes);
  if (turns_bytes > 0) {
    std::memcpy(compliance.turns.data(), bytes.data() + matrix_bytes, turns_bytes);
  }
  std::memcpy(&compliance.relative_asymmetry, bytes.data() + matrix_bytes + turns_bytes,
              sizeof(double));
  return compliance;
}

}  // namespace

Result<SmoothCompliance> load_or_build_smooth_compliance(const ElasticSolid& solid,
                                                         std::span<const std::byte> identity,
                                                         std::span<const Port> ports,
                                                         const SmoothComplianceOptions& options) {
  const double youngs_modulus = solid.elasticity.youngs_modulus;
  if (!(youngs_modulus > 0.0)) {
    return build_smooth_compliance(solid, ports, options);
  }
  const CacheKey key = key_of(solid, identity, ports, options);
  std::optional<SmoothCompliance> found;
  if (const std::optional<std::vector<std::byte>> cached = load_cached(key)) {
    found = from_bytes(*cached, width_of(options) * ports.size(), options.couples);
  }
  if (!found) {
    // For 1 Pa, so that the same bits come out whether they were cached or not, and by whom.
    ElasticSolid unit = solid;
    unit.elasticity.youngs_modulus = 1.0;
    Result<SmoothCompliance> built = build_smooth_compliance(unit, ports, options);
    if (!built) {
      return built.error();
    }
    found = std::move(built).value();
    // a cache that cannot be written only costs time
    store_cached(key, to_bytes(*found));
  }
  found->matrix /= youngs_modulus;
  found->turns /= youngs_modulus;
  return *std::move(found);
}

}  // namespace torsion
