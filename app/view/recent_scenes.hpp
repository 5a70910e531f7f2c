#pragma once

#include <filesystem>
#include <vector>

namespace torsion::engine {

// So many are kept.
inline constexpr std::size_t kRecentScenes = 3;

/// Scenes that a person has opened, the newest first, as far as they are still there.
/// @param list  the file that holds them, a path a line
std::vector<std::filesystem::path> recent_scenes(const std::filesystem::path& list);

/// Puts a scene first on the list. Where that cannot be written, nothing happens: it is a comfort.
void remember_scene(const std::filesystem::path& list, const std::filesystem::path& scene);

}  // namespace torsion::engine
