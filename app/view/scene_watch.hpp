#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace torsion::engine {

/// Looks whether the files of a scene have changed on disk: the .gltf or .glb, and the buffers
/// that it names.
class SceneWatch {
 public:
  explicit SceneWatch(std::filesystem::path scene);

  /// True once after a change, when the files have been quiet for one call since: a writer that is
  /// still at work is not read half-way.
  bool changed();
  /// Whether the last call saw files that differ from those of the last change, or of the start.
  [[nodiscard]] bool changing() const { return last_ != known_; }

 private:
  struct Stamp {
    std::filesystem::path path;
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    bool operator==(const Stamp&) const = default;
  };
  std::vector<Stamp> look();

  std::filesystem::path scene_;
  std::optional<Stamp> read_;                   // the scene's file when its buffers were read
  std::vector<std::filesystem::path> buffers_;  // beside it
  std::vector<Stamp> known_;
  std::vector<Stamp> last_;
};

}  // namespace torsion::engine
