#include "ecs/state_io.hpp"

#define XXH_INLINE_ALL
#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <string>
#include <typeinfo>

#include <unistd.h>
#include <xxhash.h>

#include "ecs/check_state.hpp"
#include "ecs/hash.hpp"

namespace torsion::engine {
namespace {

struct Header {
  std::array<char, 8> magic;
  std::uint32_t version;
  std::uint32_t padding;
  std::uint64_t layout;    // layout_hash()
  std::uint64_t model;     // hash() of the model
  std::uint64_t size;      // bytes after the header
  std::uint64_t checksum;  // XXH3 of them
};

constexpr std::array<char, 8> kMagic = {'T', 'O', 'R', 'S', 'T', 'A', 'T', 'E'};
constexpr std::uint32_t kVersion = 3;
// Room beyond the rows that a file may ask for, bytes: the capacities are the one number in it that
// its own length does not bound. A scene of 64 bodies needs under 40 MiB.
constexpr std::uint64_t kLargestSpareRoom = std::uint64_t{1} << 28U;

template <class T>
void describe(std::string& text) {
  text.append(typeid(T).name()).append(":").append(std::to_string(sizeof(T))).append(";");
}

template <class... Ts>
void describe_table(std::string& text, const Table<Ts...>& /*table*/) {
  (describe<Ts>(text), ...);
  text.append("|");
}

// Changes with the name, size and place of every column; also with the byte order.
std::uint64_t layout_hash() {
  std::string text;
  const State state;
  describe<Clock>(text);
  std::apply([&text](const auto&... tables) { (describe_table(text, tables), ...); },
             state.tables());
  const std::uint32_t order = 0x01020304;
  text.append(std::string(reinterpret_cast<const char*>(&order), sizeof(order)));
  return XXH3_64bits(text.data(), text.size());
}

class Writer {
 public:
  explicit Writer(std::vector<std::byte>& bytes) : bytes_(bytes) {}

  void number(std::uint32_t value) { raw(std::as_bytes(std::span(&value, 1))); }

  void raw(std::span<const std::byte> piece) {
    const std::size_t before = bytes_.size();
    bytes_.resize(before + piece.size());
    std::ranges::copy(piece, bytes_.begin() + static_cast<std::ptrdiff_t>(before));
  }

  template <class AnyTable>
  void table(const AnyTable& table) {
    number(table.size());
    number(table.capacity());
    table.each_column(
        [this](std::span<const std::byte> column, std::size_t /*row_size*/) { raw(column); });
  }

 private:
  std::vector<std::byte>& bytes_;
};

// Reads nothing beyond its bytes: after the first piece that is not there, everything is zero and
// ok() is false.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] bool at_end() const { return rest_.empty(); }

  std::uint32_t number() {
    std::uint32_t value = 0;
    raw(std::as_writable_bytes(std::span(&value, 1)));
    return value;
  }

  void raw(std::span<std::byte> target) {
    if (!ok_ || target.size() > rest_.size()) {
      ok_ = false;
      return;
    }
    if (!target.empty()) {
      std::memcpy(target.data(), rest_.data(), target.size());
      rest_ = rest_.subspan(target.size());
    }
  }

  template <class... Ts>
  void table(Table<Ts...>& table) {
    constexpr std::uint64_t kRowBytes = (sizeof(Ts) + ...);
    const std::uint32_t size = number();
    const std::uint32_t capacity = number();
    if (!ok_ || size > capacity || size * kRowBytes > rest_.size() ||
        !take_spare_room((capacity - size) * kRowBytes)) {
      ok_ = false;
      return;
    }
    table.reserve(capacity);
    table.append(size);
    table.each_column(
        [this](std::span<std::byte> column, std::size_t /*row_size*/) { raw(column); });
  }

 private:
  bool take_spare_room(std::uint64_t bytes) {
    if (bytes > kLargestSpareRoom - spare_room_) {
      return false;
    }
    spare_room_ += bytes;
    return true;
  }

  std::span<const std::byte> rest_;
  std::uint64_t spare_room_ = 0;
  bool ok_ = true;
};

Error failure(std::string_view origin, std::string_view what) {
  return Error{std::string(origin).append(": ").append(what)};
}

}  // namespace

std::vector<std::byte> to_bytes(const Model& model, const State& state) {
  std::vector<std::byte> bytes(sizeof(Header));
  Writer writer(bytes);
  writer.raw(std::as_bytes(std::span(&state.clock, 1)));
  std::apply([&writer](const auto&... tables) { (writer.table(tables), ...); }, state.tables());
  const std::span<const std::byte> content = std::span(bytes).subspan(sizeof(Header));
  const Header header{kMagic,
                      kVersion,
                      0,
                      layout_hash(),
                      hash(model),
                      content.size(),
                      XXH3_64bits(content.data(), content.size())};
  std::memcpy(bytes.data(), &header, sizeof(header));
  return bytes;
}

Result<State> from_bytes(std::span<const std::byte> bytes, const Model& model,
                         std::string_view origin) {
  Header header{};
  if (bytes.size() < sizeof(header)) {
    return failure(origin, "is not a saved state: shorter than its header");
  }
  std::memcpy(&header, bytes.data(), sizeof(header));
  const std::span<const std::byte> content = bytes.subspan(sizeof(header));
  if (header.magic != kMagic) {
    return failure(origin, "is not a saved state: it does not begin with TORSTATE");
  }
  if (header.version != kVersion) {
    return failure(origin, "has version " + std::to_string(header.version) +
                               " of the format, this program reads " + std::to_string(kVersion));
  }
  if (header.layout != layout_hash()) {
    return failure(origin,
                   "was saved by another build of the program; save it again with this one");
  }
  if (header.model != hash(model)) {
    return failure(origin,
                   "was saved of another scene, or with other models or settings; load it with "
                   "those");
  }
  if (header.size != content.size()) {
    return failure(origin, "should have " + std::to_string(header.size) +
                               " bytes after its header and has " + std::to_string(content.size()) +
                               "; it was cut short or added to");
  }
  if (header.checksum != XXH3_64bits(content.data(), content.size())) {
    return failure(origin, "is damaged: its checksum does not fit");
  }

  State state;
  Reader reader(content);
  reader.raw(std::as_writable_bytes(std::span(&state.clock, 1)));
  std::apply([&reader](auto&... tables) { (reader.table(tables), ...); }, state.tables());
  if (!reader.ok() || !reader.at_end()) {
    return failure(origin, "is damaged: its tables do not fill it");
  }
  if (const Result<Done> checked = check_state(model, state); !checked) {
    return failure(origin, "is damaged: " + checked.error().text);
  }
  return state;
}

Result<Done> save_state(const Model& model, const State& state, const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = to_bytes(model, state);
  // The process number keeps two programs that save to one path out of each other's temporary file.
  std::filesystem::path temporary = path;
  temporary += ".part" + std::to_string(::getpid());
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code ignored;
  if (!file) {
    std::filesystem::remove(temporary, ignored);
    return failure(path.string(),
                   "cannot be written: does its folder exist, with room and the "
                   "right to write?");
  }
  std::error_code error;
  std::filesystem::rename(temporary, path, error);
  if (error) {
    std::filesystem::remove(temporary, ignored);
    return failure(path.string(), "cannot be written: " + error.message());
  }
  return Done{};
}

Result<State> load_state(const Model& model, const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) {
    return failure(path.string(), "cannot be read: " + error.message());
  }
  std::vector<std::byte> bytes(size);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file) {
    return failure(path.string(), "cannot be read");
  }
  return from_bytes(bytes, model, path.string());
}

}  // namespace torsion::engine
