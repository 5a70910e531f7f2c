#include "tests/support/paths.hpp"

namespace torsion::engine::test {

std::string source_folder() {
  return TORSION_SOURCE_DIR;
}

std::string build_folder() {
  return TORSION_BINARY_DIR;
}

std::string shipped_scene(const std::string& name) {
  return source_folder() + "/scenes/" + name + ".gltf";
}

}  // namespace torsion::engine::test
