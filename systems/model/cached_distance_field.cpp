#include "systems/model/cached_distance_field.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "systems/model/cache.hpp"

namespace torsion {
namespace {

// Of the bytes in the cache: raise it when the same mesh gives others.
constexpr std::uint32_t kFieldVersion = 1;

}  // namespace

Result<BuiltField> load_or_build_distance_field(const FieldOfMesh& mesh,
                                                const FieldOptions& options) {
  const std::array<std::uint32_t, 2> resolution{options.coarse_cells, options.subdivision};
  std::vector<std::span<const std::byte>> content{std::as_bytes(std::span(resolution)),
                                                  std::as_bytes(std::span(mesh.part.positions)),
                                                  std::as_bytes(std::span(mesh.part.triangles))};
  if (&mesh.solid != &mesh.part) {
    content.push_back(std::as_bytes(std::span(mesh.solid.positions)));
    content.push_back(std::as_bytes(std::span(mesh.solid.triangles)));
  }
  const CacheKey key = cache_key("distance_field", kFieldVersion, content);
  if (const std::optional<std::vector<std::byte>> cached = load_cached(key)) {
    if (std::optional<BuiltField> field = field_from_bytes(*cached)) {
      return *std::move(field);
    }
  }
  Result<BuiltField> built = build_distance_field(mesh, options);
  if (built) {
    store_cached(key, to_bytes(built.value()));  // a cache that cannot be written only costs time
  }
  return built;
}

}  // namespace torsion
