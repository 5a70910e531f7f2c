#include "render/image_io.hpp"

#include <memory>
#include <string>

#include <png.h>
#include <turbojpeg.h>
#include <unistd.h>

namespace torsion::engine {
namespace {

Error too_large(std::uint32_t width, std::uint32_t height, std::uint32_t largest_side) {
  return Error{"it is " + std::to_string(width) + "x" + std::to_string(height) +
               " pixels; each side may be 1 to " + std::to_string(largest_side)};
}

bool fits(std::uint32_t width, std::uint32_t height, std::uint32_t largest_side) {
  return width >= 1 && height >= 1 && width <= largest_side && height <= largest_side;
}

Result<Image> decode_png(std::span<const unsigned char> bytes, std::uint32_t largest_side) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()) == 0) {
    return Error{std::string("it is a damaged PNG: ") + header.message};
  }
  if (!fits(header.width, header.height, largest_side)) {
    png_image_free(&header);
    return too_large(header.width, header.height, largest_side);
  }
  header.format = PNG_FORMAT_RGBA;
  Image image{header.width, header.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(header))};
  if (png_image_finish_read(&header, nullptr, image.rgba.data(), 0, nullptr) == 0) {
    return Error{std::string("it is a damaged PNG: ") + header.message};
  }
  return image;
}

Result<Image> decode_jpeg(std::span<const unsigned char> bytes, std::uint32_t largest_side) {
  const std::unique_ptr<void, int (*)(void*)> decoder(tjInitDecompress(), tjDestroy);
  const auto damaged = [&] {
    return Error{std::string("it is a damaged JPEG: ") + tjGetErrorStr2(decoder.get())};
  };
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int colors = 0;
  if (tjDecompressHeader3(decoder.get(), bytes.data(), bytes.size(), &width, &height, &subsampling,
                          &colors) != 0) {
    return damaged();
  }
  const auto columns = static_cast<std::uint32_t>(width);
  const auto rows = static_cast<std::uint32_t>(height);
  if (!fits(columns, rows, largest_side)) {
    return too_large(columns, rows, largest_side);
  }
  Image image{columns, rows, std::vector<std::uint8_t>(std::size_t{columns} * rows * 4)};
  if (tjDecompress2(decoder.get(), bytes.data(), bytes.size(), image.rgba.data(), width, 0, height,
                    TJPF_RGBA, TJFLAG_STOPONWARNING) != 0) {
    return damaged();
  }
  return image;
}

}  // namespace

Result<Done> write_png(const Image& image, const std::filesystem::path& path) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = image.width;
  header.height = image.height;
  header.format = PNG_FORMAT_RGBA;
  std::filesystem::path temporary = path;
  temporary += std::string(".").append(std::to_string(::getpid())).append(".tmp");
  std::error_code failed;
  const int written =
      png_image_write_to_file(&header, temporary.c_str(), 0, image.rgba.data(), 0, nullptr);
  if (written != 0) {
    std::filesystem::rename(temporary, path, failed);
  }
  if (written == 0 || failed) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    return Error{path.string() + ": the picture cannot be written: " +
                 (failed ? failed.message() : std::string(header.message))};
  }
  return Done{};
}

Result<Image> read_png(const std::filesystem::path& path) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&header, path.c_str()) == 0) {
    return Error{path.string() + ": the picture cannot be read: " + header.message};
  }
  header.format = PNG_FORMAT_RGBA;
  Image image{header.width, header.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(header))};
  if (png_image_finish_read(&header, nullptr, image.rgba.data(), 0, nullptr) == 0) {
    return Error{path.string() + ": the picture cannot be read: " + header.message};
  }
  return image;
}

Result<Image> decode_image(std::span<const unsigned char> bytes, std::uint32_t largest_side) {
  constexpr unsigned char kPngStart = 0x89;  // their files begin 89 50 4E 47 and FF D8 FF
  constexpr unsigned char kJpegStart = 0xFF;
  if (bytes.empty()) {
    return Error{"its file is missing or empty"};
  }
  if (bytes.front() == kPngStart) {
    return decode_png(bytes, largest_side);
  }
  if (bytes.front() == kJpegStart) {
    return decode_jpeg(bytes, largest_side);
  }
  return Error{"it is neither a PNG nor a JPEG, the two kinds that glTF has"};
}

}  // namespace torsion::engine
