#pragma once

#include <filesystem>

#include "ecs/result.hpp"
#include "render/image.hpp"

namespace torsion::engine {

/// Writes a PNG by way of a temporary file beside it, so that `path` is never half-written. Errors:
/// the folder is missing or cannot be written, the disk is full.
Result<Done> write_png(const Image& image, const std::filesystem::path& path);

/// Reads a PNG of any kind as RGBA.
Result<Image> read_png(const std::filesystem::path& path);

}  // namespace torsion::engine
