// A saved state in which bytes are changed and the checksum is right again, so that what comes
// after it is read. The input is a list of changes: four bytes say where, one says what.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "ecs/state_io.hpp"
#include "tests/support/contact_scenes.hpp"

namespace {

struct Base {
  torsion::engine::Model model;
  std::vector<std::byte> bytes;
  std::size_t content = 0;  // where it begins, behind the header, which ends with its checksum
};

std::uint64_t checksum_of(std::span<const std::byte> content) {
  return XXH3_64bits(content.data(), content.size());
}

Base make_base() {
  torsion::engine::PrepareOptions options;
  options.contact_model = torsion::engine::ContactModel::kMdr;
  options.body_model = torsion::engine::BodyModel::kNone;
  options.use_cache = false;
  auto simulation = torsion::engine::prepare(torsion::engine::test::ball_on_cube(), options);
  torsion::engine::World& world = simulation.value().world;
  std::vector<std::byte> bytes = torsion::engine::to_bytes(world.model, world.state);
  Base base{std::move(world.model), std::move(bytes), 0};
  for (std::size_t at = sizeof(std::uint64_t); at < 256; ++at) {
    std::uint64_t there = 0;
    std::memcpy(&there, base.bytes.data() + at - sizeof there, sizeof there);
    if (there == checksum_of(std::span(base.bytes).subspan(at))) {
      base.content = at;
      return base;
    }
  }
  std::abort();  // the format has changed
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Base base = make_base();
  std::vector<std::byte> bytes = base.bytes;
  constexpr std::size_t kChange = 5;
  for (std::size_t at = 0; at + kChange <= size; at += kChange) {
    std::uint32_t where = 0;
    std::memcpy(&where, data + at, sizeof where);
    bytes[base.content + where % (bytes.size() - base.content)] =
        static_cast<std::byte>(data[at + sizeof where]);
  }
  const std::uint64_t checksum = checksum_of(std::span(bytes).subspan(base.content));
  std::memcpy(bytes.data() + base.content - sizeof checksum, &checksum, sizeof checksum);
  const auto state = torsion::engine::from_bytes(bytes, base.model, "fuzz");
  return state || !state.error().text.empty() ? 0 : 1;
}
