#pragma once

#include <string>

namespace torsion::engine::test {

/// The project's root folder, where the tests' own files are.
std::string source_folder();

/// Where this build's programs are.
std::string build_folder();

/// A shipped scene's file.
/// @param name  without ".gltf"
std::string shipped_scene(const std::string& name);

}  // namespace torsion::engine::test
