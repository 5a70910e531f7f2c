#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "ecs/result.hpp"
#include "ecs/world.hpp"

namespace torsion {

// A saved world: magic, version, a hash of the layout of every saved type, the tables with their
// capacities, and a checksum. A world that is loaded has the hash() of the one
// that was saved and goes on bit for bit. The format is this build's own: another layout of the
// components is refused, not converted.

/// The world as bytes.
[[nodiscard]] std::vector<std::byte> to_bytes(const World& world);

/// The world that `bytes` hold. Fails on anything cut short, changed, of another version or layout,
/// or naming rows that do not exist. `origin` is how messages call the source.
Result<World> from_bytes(std::span<const std::byte> bytes, std::string_view origin);

/// Writes the world to `path` by way of a temporary file beside it, so that `path` is never
/// half-written.
Result<Done> save_world(const World& world, const std::filesystem::path& path);

/// Reads what save_world wrote; fails as from_bytes does, and if `path` cannot be read.
Result<World> load_world(const std::filesystem::path& path);

}  // namespace torsion
