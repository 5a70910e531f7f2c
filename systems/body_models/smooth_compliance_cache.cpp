#include <array>
#include <cstring>
#include <optional>

#include "systems/body_models/smooth_compliance.hpp"
#include "systems/cache.hpp"

namespace torsion {
namespace {

constexpr std::uint32_t kVersion = 1;  // raise it when the same solid and ports give other numbers

CacheKey key_of(const ElasticSolid& solid, std::span<const std::byte> identity,
                std::span<const Port> ports, const SmoothComplianceOptions& options) {
  static_assert(sizeof(Port) == 6 * sizeof(double), "ports are hashed as bytes");
  const std::array<std::span<const std::byte>, 5> content{
      identity, std::as_bytes(std::span(&solid.bounds, 1)), std::as_bytes(ports),
      std::as_bytes(std::span(&solid.elasticity.poisson_ratio, 1)),
      std::as_bytes(std::span(&options.elements, 1))};
  return cache_key("smooth_compliance", kVersion, content);
}

/// The matrix for a Young's modulus of 1 Pa, then the asymmetry.
std::vector<std::byte> to_bytes(const SmoothCompliance& compliance, double youngs_modulus) {
  const Eigen::MatrixXd scaled = compliance.matrix * youngs_modulus;
  const auto matrix =
      std::as_bytes(std::span(scaled.data(), static_cast<std::size_t>(scaled.size())));
  const auto asymmetry = std::as_bytes(std::span(&compliance.relative_asymmetry, 1));
  std::vector<std::byte> bytes(matrix.begin(), matrix.end());
  bytes.insert(bytes.end(), asymmetry.begin(), asymmetry.end());
  return bytes;
}

/// nullopt when that is no matrix for so many ports.
std::optional<SmoothCompliance> from_bytes(std::span<const std::byte> bytes, std::size_t ports,
                                           double youngs_modulus) {
  const std::size_t matrix_bytes = 36 * ports * ports * sizeof(double);
  if (bytes.size() != matrix_bytes + sizeof(double)) {
    return std::nullopt;
  }
  const auto side = static_cast<Eigen::Index>(6 * ports);
  SmoothCompliance compliance{Eigen::MatrixXd(side, side), 0.0};
  std::memcpy(compliance.matrix.data(), bytes.data(), matrix_bytes);
  std::memcpy(&compliance.relative_asymmetry, bytes.data() + matrix_bytes, sizeof(double));
  compliance.matrix /= youngs_modulus;
  return compliance;
}

}  // namespace

Result<SmoothCompliance> load_or_build_smooth_compliance(const ElasticSolid& solid,
                                                         std::span<const std::byte> identity,
                                                         std::span<const Port> ports,
                                                         const SmoothComplianceOptions& options) {
  const CacheKey key = key_of(solid, identity, ports, options);
  const double youngs_modulus = solid.elasticity.youngs_modulus;
  if (youngs_modulus > 0.0) {
    if (const std::optional<std::vector<std::byte>> cached = load_cached(key)) {
      if (std::optional<SmoothCompliance> compliance =
              from_bytes(*cached, ports.size(), youngs_modulus)) {
        return *std::move(compliance);
      }
    }
  }
  Result<SmoothCompliance> built = build_smooth_compliance(solid, ports, options);
  if (built) {
    // a cache that cannot be written only costs time
    store_cached(key, to_bytes(built.value(), youngs_modulus));
  }
  return built;
}

}  // namespace torsion
