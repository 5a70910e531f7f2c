#include "app/view/gallery.hpp"

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

namespace torsion::engine {
namespace {

namespace fs = std::filesystem;

/// The torsion_title of the scene that a file shows; nothing where it has none or is no JSON.
std::optional<std::string> title_of(const fs::path& file) {
  std::ifstream stream(file);
  const auto document = nlohmann::json::parse(stream, nullptr, false);
  if (!document.is_object()) {
    return std::nullopt;
  }
  const auto shown = document.find("scene");
  const unsigned row =
      shown != document.end() && shown->is_number_unsigned() ? shown->get<unsigned>() : 0U;
  const nlohmann::json::json_pointer scene("/scenes/" + std::to_string(row) +
                                           "/extras/torsion_title");
  if (!document.contains(scene) || !document[scene].is_string()) {
    return std::nullopt;
  }
  return document[scene].get<std::string>();
}

/// Of a folder's .gltf, by name, those that have a title.
void add_titled(const fs::path& folder, std::vector<GalleryEntry>& gallery) {
  std::error_code missing;
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, missing)) {
    if (entry.path().extension() == ".gltf") {
      files.push_back(entry.path());
    }
  }
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    if (const auto title = title_of(file)) {
      gallery.push_back({file, *title});
    }
  }
}

}  // namespace

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

std::vector<GalleryEntry> read_gallery(const fs::path& scenes) {
  std::vector<GalleryEntry> gallery;
  add_titled(scenes / "gallery", gallery);
  add_titled(scenes, gallery);
  return gallery;
}

std::vector<GalleryEntry> read_gallery() {
  std::error_code unknown;
  return read_gallery(shipped_scenes(fs::read_symlink("/proc/self/exe", unknown)));
}

std::optional<std::size_t> entry_of(const std::vector<GalleryEntry>& gallery,
                                    const fs::path& file) {
  const auto found = std::ranges::find_if(gallery, [&](const GalleryEntry& entry) {
    std::error_code missing;
    return fs::equivalent(entry.file, file, missing);
  });
  return found == gallery.end() ? std::nullopt : std::optional(found - gallery.begin());
}

}  // namespace torsion::engine
