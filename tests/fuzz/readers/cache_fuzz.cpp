// An entry of the cache, as it may lie in a folder that others write to.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

#include <unistd.h>

#include "systems/geometry/distance_field.hpp"
#include "systems/model/cache.hpp"
#include "tests/support/contact_scenes.hpp"

namespace {

std::filesystem::path own_folder() {
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("torsion_fuzz_cache_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  ::setenv("TORSION_CACHE_DIR", folder.c_str(), 1);
  return folder;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path folder = own_folder();
  static const torsion::engine::SurfaceMesh mesh =
      torsion::engine::test::tessellate(torsion::engine::ShapeKind::kBox, glm::dvec3(0.01), 2);
  static const auto whole = torsion::engine::load_or_build_distance_field({mesh, mesh});
  // The file that it has written, with the input over its end.
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::fstream file(entry.path(), std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(-static_cast<std::streamoff>(
                   std::min<std::size_t>(size, std::filesystem::file_size(entry.path()))),
               std::ios::end);
    file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  }
  const auto again = torsion::engine::load_or_build_distance_field({mesh, mesh});
  if (!again || again.value().nodes.size() != whole.value().nodes.size()) {
    std::abort();
  }
  return 0;
}
