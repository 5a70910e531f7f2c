#include "app/shipped_scenes.hpp"

namespace torsion::engine {

namespace fs = std::filesystem;

fs::path shipped_scenes(const fs::path& program) {
  std::error_code missing;
  for (fs::path folder = program.parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    for (const char* scenes : {"share/torsion/scenes", "scenes"}) {
      if (fs::is_directory(folder / scenes / "gallery", missing)) {
        return folder / scenes;
      }
    }
  }
  return {};
}

fs::path shipped_scenes() {
  std::error_code unknown;
  return shipped_scenes(fs::read_symlink("/proc/self/exe", unknown));
}

}  // namespace torsion::engine
