#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ecs/result.hpp"
#include "systems/geometry/distance_field.hpp"

namespace torsion::engine {

/// Names one entry of the cache: the kind of thing and the hash of all that it was made from.
struct CacheKey {
  std::string file_name;
};

/// The key of what is made from `content`. Pieces count with their lengths, so that no two lists of
/// pieces collide by running into one another; the hash is XXH3-128.
/// @param kind     what is made: letters, digits and underscores; part of the file's name
/// @param version  raised when the same content gives other bytes
CacheKey cache_key(std::string_view kind, std::uint32_t version,
                   std::span<const std::span<const std::byte>> content);

/// Where entries are: $TORSION_CACHE_DIR, else $XDG_CACHE_HOME/torsion, else $HOME/.cache/torsion;
/// empty when none of these is set, and then nothing is cached.
std::filesystem::path cache_folder();

/// What was stored under `key`, or nullopt: nothing there, cut short, or changed since.
std::optional<std::vector<std::byte>> load_cached(const CacheKey& key);

/// Stores `bytes` under `key`: a whole file under another name, then renamed, so that a reader sees
/// all or nothing and two writers at once do no harm. False where the folder cannot be written,
/// which is not an error: the cache only saves time.
bool store_cached(const CacheKey& key, std::span<const std::byte> bytes);

/// A distance field as build_distance_field makes it, from the user's cache where the same mesh was
/// met before; stores it there if not.
Result<BuiltField> load_or_build_distance_field(const FieldOfMesh& mesh,
                                                const FieldOptions& options = {});

}  // namespace torsion::engine
