// A scene file.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "scenes/load_gltf.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const bool binary = size >= 4 && data[0] == 'g' && data[1] == 'l';
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() /
      ("torsion_fuzz_" + std::to_string(::getpid()) + (binary ? ".glb" : ".gltf"));
  {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  }
  const torsion::engine::LoadedScene loaded = torsion::engine::load_gltf(path);
  std::filesystem::remove(path);
  if (loaded.scene.has_value() == !loaded.problems.empty()) {
    std::abort();  // both, or neither
  }
  return 0;
}
