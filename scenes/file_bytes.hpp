#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "ecs/result.hpp"

namespace torsion::engine {

/// Largest file that is read: a scene beyond it is a mistake.
inline constexpr std::uint64_t kLargestFile = std::uint64_t{1} << 30;  // bytes

/// All bytes of a regular file. Errors: missing, not a regular file (a pipe would block for ever),
/// not readable, larger than `largest`.
Result<std::vector<unsigned char>> read_file_bytes(const std::filesystem::path& path,
                                                   std::uint64_t largest = kLargestFile);

/// Where a scene's relative URI leads. Errors: absolute paths, other schemes, "..", links or
/// encoded characters that lead out of `folder`.
Result<std::filesystem::path> path_inside(const std::filesystem::path& folder,
                                          const std::string& uri);

}  // namespace torsion::engine
