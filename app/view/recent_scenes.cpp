#include "app/view/recent_scenes.hpp"

#include <algorithm>
#include <fstream>
#include <string>

#include "app/output_file.hpp"

namespace torsion::engine {

namespace fs = std::filesystem;

std::vector<fs::path> recent_scenes(const fs::path& list) {
  std::vector<fs::path> scenes;
  std::ifstream lines(list);
  std::string line;
  while (scenes.size() < kRecentScenes && std::getline(lines, line)) {
    std::error_code missing;
    if (fs::is_regular_file(line, missing)) {
      scenes.emplace_back(line);
    }
  }
  return scenes;
}

void remember_scene(const fs::path& list, const fs::path& scene) {
  std::error_code failed;
  const fs::path whole = fs::canonical(scene, failed);
  if (failed || whole.string().find('\n') != std::string::npos) {
    return;
  }
  std::vector<fs::path> scenes = recent_scenes(list);
  std::erase(scenes, whole);
  scenes.insert(scenes.begin(), whole);
  std::string text;
  for (std::size_t i = 0; i < std::min(scenes.size(), kRecentScenes); ++i) {
    text += scenes[i].string() + "\n";
  }
  fs::create_directories(list.parent_path(), failed);
  const FileText file{list.string(), text};
  static_cast<void>(write_files({&file, 1}));
}

}  // namespace torsion::engine
