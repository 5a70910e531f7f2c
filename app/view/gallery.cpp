#include "app/view/gallery.hpp"

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

#include "render/image_io.hpp"

namespace torsion::engine {
namespace {

namespace fs = std::filesystem;

/// A text among the extras of the scene that a file shows.
std::optional<std::string> text_of(const nlohmann::json& extras, const char* key) {
  return extras.contains(key) && extras[key].is_string()
             ? std::optional(extras[key].get<std::string>())
             : std::nullopt;
}

/// What a file says of itself; nothing where it has no title or is no JSON.
std::optional<GalleryEntry> entry_from(const fs::path& file) {
  std::ifstream stream(file);
  const auto document = nlohmann::json::parse(stream, nullptr, false);
  if (!document.is_object()) {
    return std::nullopt;
  }
  const auto shown = document.find("scene");
  const unsigned row =
      shown != document.end() && shown->is_number_unsigned() ? shown->get<unsigned>() : 0U;
  const nlohmann::json::json_pointer place("/scenes/" + std::to_string(row) + "/extras");
  if (!document.contains(place) || !document[place].is_object()) {
    return std::nullopt;
  }
  const nlohmann::json& extras = document[place];
  const auto title = text_of(extras, "torsion_title");
  if (!title) {
    return std::nullopt;
  }
  return GalleryEntry{file, *title, text_of(extras, "torsion_caption").value_or(""), {}};
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
    if (auto entry = entry_from(file)) {
      gallery.push_back(*std::move(entry));
    }
  }
}

}  // namespace

std::vector<GalleryEntry> read_gallery(const fs::path& scenes) {
  std::vector<GalleryEntry> gallery;
  add_titled(scenes / "gallery", gallery);
  add_titled(scenes, gallery);
  add_titled(scenes / "looks", gallery);
  for (GalleryEntry& entry : gallery) {
    Result<Image> picture = read_png(scenes / "gallery" / entry.file.stem().concat(".png"));
    if (picture && picture.value().width == kCardWidth && picture.value().height == kCardHeight) {
      entry.picture = std::move(picture).value();
    }
  }
  return gallery;
}

std::vector<GalleryEntry> read_gallery() {
  return read_gallery(shipped_scenes());
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
