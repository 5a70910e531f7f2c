#define XXH_INLINE_ALL

#include "systems/model/cache.hpp"

#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <unistd.h>
#include <xxhash.h>

namespace torsion::engine {
namespace {

constexpr std::array<char, 8> kMagic{'T', 'O', 'R', 'S', 'C', 'A', 'C', '1'};

/// The start of every file of the cache.
struct FileHeader {
  std::array<char, 8> magic = kMagic;
  std::uint64_t length = 0;  // bytes that follow
  std::uint64_t hash_low = 0;
  std::uint64_t hash_high = 0;
};

FileHeader header_of(std::span<const std::byte> bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {kMagic, bytes.size(), hash.low64, hash.high64};
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

bool write_file(int descriptor, std::span<const std::byte> bytes) {
  File file(fdopen(descriptor, "wb"), std::fclose);
  if (!file) {
    close(descriptor);
    return false;
  }
  // No fsync: a file damaged by a power cut fails its checksum and is made again.
  const FileHeader header = header_of(bytes);
  const bool written = std::fwrite(&header, sizeof(header), 1, file.get()) == 1 &&
                       (bytes.empty() ||  // an empty span may have no address
                        std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size());
  return std::fclose(file.release()) == 0 && written;
}

}  // namespace

CacheKey cache_key(std::string_view kind, std::uint32_t version,
                   std::span<const std::span<const std::byte>> content) {
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                              XXH3_freeState);
  XXH3_128bits_reset(state.get());
  XXH3_128bits_update(state.get(), &version, sizeof(version));
  for (const std::span<const std::byte> piece : content) {
    const std::uint64_t length = piece.size();
    XXH3_128bits_update(state.get(), &length, sizeof(length));
    XXH3_128bits_update(state.get(), piece.data(), piece.size());
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
  std::array<char, 33> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx%016llx",
                static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return {std::string(kind) + "-" + digits.data()};
}

std::filesystem::path cache_folder() {
  // Read at load time, before threads of the program change anything.
  const auto variable = [](const char* name) -> std::filesystem::path {
    const char* const value =
        std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nobody calls setenv
    return value == nullptr ? "" : value;
  };
  if (std::filesystem::path chosen = variable("TORSION_CACHE_DIR"); !chosen.empty()) {
    return chosen;
  }
  if (const std::filesystem::path base = variable("XDG_CACHE_HOME"); base.is_absolute()) {
    return base /
           "torsion";  // the XDG base directory specification: relative paths are to be ignored
  }
  if (const std::filesystem::path home = variable("HOME"); !home.empty()) {
    return home / ".cache" / "torsion";
  }
  return {};
}

std::optional<std::vector<std::byte>> load_cached(const CacheKey& key) {
  const std::filesystem::path folder = cache_folder();
  if (folder.empty()) {
    return std::nullopt;
  }
  const File file(std::fopen((folder / key.file_name).c_str(), "rbe"), std::fclose);
  FileHeader header;
  if (!file || std::fread(&header, sizeof(header), 1, file.get()) != 1 || header.magic != kMagic) {
    return std::nullopt;
  }
  std::error_code failure;
  const std::uintmax_t size = std::filesystem::file_size(folder / key.file_name, failure);
  if (failure || size != sizeof(header) + header.length) {
    return std::nullopt;
  }
  std::vector<std::byte> bytes(header.length);
  if (!bytes.empty() && std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) {
    return std::nullopt;
  }
  const FileHeader found = header_of(bytes);
  if (found.hash_low != header.hash_low || found.hash_high != header.hash_high) {
    return std::nullopt;
  }
  return bytes;
}

bool store_cached(const CacheKey& key, std::span<const std::byte> bytes) {
  const std::filesystem::path folder = cache_folder();
  if (folder.empty()) {
    return false;
  }
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) {
    return false;
  }
  std::string unfinished = folder / (key.file_name + ".part-XXXXXX");
  const int descriptor = mkostemp(unfinished.data(), O_CLOEXEC);
  if (descriptor < 0) {
    return false;
  }
  if (write_file(descriptor, bytes)) {
    std::filesystem::rename(unfinished, folder / key.file_name, failure);
    if (!failure) {
      return true;
    }
  }
  std::filesystem::remove(unfinished, failure);
  return false;
}

namespace {

// For the bytes in the cache: raise it when the same mesh gives others.
constexpr std::uint32_t kFieldVersion = 2;

}  // namespace

Result<BuiltField> load_or_build_distance_field(const FieldOfMesh& mesh,
                                                const FieldOptions& options) {
  const std::array<std::uint32_t, 2> resolution{options.coarse_cells, options.subdivision};
  std::vector<std::span<const std::byte>> content{std::as_bytes(std::span(resolution)),
                                                  std::as_bytes(std::span(mesh.part.positions)),
                                                  std::as_bytes(std::span(mesh.part.triangles))};
  if (&mesh.solid != &mesh.part) {
    content.push_back(std::as_bytes(std::span(mesh.solid.positions)));
    content.push_back(std::as_bytes(std::span(mesh.solid.triangles)));
  }
  const CacheKey key = cache_key("distance_field", kFieldVersion, content);
  if (const std::optional<std::vector<std::byte>> cached = load_cached(key)) {
    if (std::optional<BuiltField> field = field_from_bytes(*cached)) {
      return *std::move(field);
    }
  }
  Result<BuiltField> built = build_distance_field(mesh, options);
  if (built) {
    store_cached(key, to_bytes(built.value()));  // a cache that cannot be written only costs time
  }
  return built;
}

}  // namespace torsion::engine
