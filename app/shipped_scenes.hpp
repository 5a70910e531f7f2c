#pragma once

#include <filesystem>

namespace torsion::engine {

/// The scenes that ship: those in share/torsion/scenes beside the folder of the installed program,
/// or in the source tree above the folder that it was built in. Empty where there are neither.
/// @param program  its file
std::filesystem::path shipped_scenes(const std::filesystem::path& program);

/// Those of the program that runs.
std::filesystem::path shipped_scenes();

}  // namespace torsion::engine
