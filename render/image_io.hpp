#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "ecs/result.hpp"
#include "render/image.hpp"

namespace torsion::engine {

/// Writes a PNG by way of a temporary file beside it, so that `path` is never half-written. Errors:
/// the folder is missing or cannot be written, the disk is full.
Result<Done> write_png(const Image& image, const std::filesystem::path& path);

/// Reads a PNG of any kind as RGBA.
Result<Image> read_png(const std::filesystem::path& path);

/// Decodes a PNG or JPEG of any kind as RGBA.
/// @param bytes  of the file
/// @param largest_side  pixels; a larger image is an error
/// Error: what is wrong, without the image's name.
Result<Image> decode_image(std::span<const unsigned char> bytes, std::uint32_t largest_side);

}  // namespace torsion::engine
