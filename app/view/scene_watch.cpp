#include "app/view/scene_watch.hpp"

#include <fstream>

#include <nlohmann/json.hpp>

namespace torsion::engine {
namespace {

namespace fs = std::filesystem;

/// The buffers beside a .gltf; none where it cannot be read or has them inside.
std::vector<fs::path> buffers_of(const fs::path& scene) {
  std::vector<fs::path> paths;
  if (scene.extension() != ".gltf") {
    return paths;
  }
  std::ifstream file(scene, std::ios::binary);
  constexpr bool kThrow = false;
  const nlohmann::json json = nlohmann::json::parse(file, nullptr, kThrow);
  if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) {
    return paths;
  }
  for (const nlohmann::json& buffer : json["buffers"]) {
    if (buffer.is_object() && buffer.contains("uri") && buffer["uri"].is_string()) {
      const auto uri = buffer["uri"].get<std::string>();
      if (uri.rfind("data:", 0) != 0) {
        paths.push_back(scene.parent_path() / uri);
      }
    }
  }
  return paths;
}

}  // namespace

SceneWatch::SceneWatch(fs::path scene) : scene_(std::move(scene)), known_(look()), last_(known_) {}

/// Reads the scene's file only where it has changed: it may be long.
std::vector<SceneWatch::Stamp> SceneWatch::look() {
  const auto stamp_of = [](const fs::path& path) {
    std::error_code gone;
    Stamp stamp{path, fs::last_write_time(path, gone), 0};
    stamp.size = fs::file_size(path, gone);
    return stamp;
  };
  std::vector<Stamp> stamps = {stamp_of(scene_)};
  if (read_ != stamps.front()) {
    read_ = stamps.front();
    buffers_ = buffers_of(scene_);
  }
  for (const fs::path& path : buffers_) {
    stamps.push_back(stamp_of(path));
  }
  return stamps;
}

bool SceneWatch::changed() {
  std::vector<Stamp> now = look();
  const bool quiet = now == last_;
  last_ = std::move(now);
  if (!quiet || last_ == known_) {
    return false;
  }
  known_ = last_;
  return true;
}

}  // namespace torsion::engine
