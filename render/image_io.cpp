#include "render/image_io.hpp"

#include <string>

#include <png.h>
#include <unistd.h>

namespace torsion::engine {

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

}  // namespace torsion::engine
