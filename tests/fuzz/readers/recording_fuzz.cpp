// A recording whose checksum is right, so that what it says is read.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "app/live/recording_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                     ("torsion_fuzz_" + std::to_string(::getpid()) + ".rec");
  const std::uint64_t checksum = XXH3_64bits(data, size);
  {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    file.write(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  }
  const auto recording = torsion::engine::load_recording(path);
  std::filesystem::remove(path);
  return recording || !recording.error().text.empty() ? 0 : 1;
}
