#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/shipped_scenes.hpp"
#include "render/image.hpp"

namespace torsion::engine {

/// A scene that ships with the program, or one of a person's own, for the list in the window.
struct GalleryEntry {
  std::filesystem::path file;
  std::string title;    // torsion_title of the scene
  std::string caption;  // its torsion_caption, may be empty
  Image picture;        // kCardWidth x kCardHeight; empty: there is none

  bool operator==(const GalleryEntry&) const = default;
};

// Pixels: of the picture of a scene, three times those of its card.
inline constexpr std::uint32_t kCardWidth = 219;
inline constexpr std::uint32_t kCardHeight = 144;

/// The .gltf with a torsion_title in `scenes`/gallery, in the order of their names, then those in
/// `scenes` itself. The picture of any is `scenes`/gallery/NAME.png; one of another size is left
/// out.
std::vector<GalleryEntry> read_gallery(const std::filesystem::path& scenes);

/// The gallery of the program that runs.
std::vector<GalleryEntry> read_gallery();

/// Which entry a file is.
std::optional<std::size_t> entry_of(const std::vector<GalleryEntry>& gallery,
                                    const std::filesystem::path& file);

}  // namespace torsion::engine
