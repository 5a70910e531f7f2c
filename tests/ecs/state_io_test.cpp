#include "ecs/state_io.hpp"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "ecs/hash.hpp"
#include "tests/ecs/small_world.hpp"

// For files that are wrong but have a right checksum.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace torsion::engine {
namespace {

constexpr std::size_t kHeaderBytes = 48;
constexpr std::size_t kVersionAt = 8;
constexpr std::size_t kLayoutAt = 16;
constexpr std::size_t kModelAt = 24;
constexpr std::size_t kSizeAt = 32;
constexpr std::size_t kChecksumAt = 40;

template <class T>
void overwrite(std::vector<std::byte>& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof(value));
}

void seal(std::vector<std::byte>& bytes) {
  const std::uint64_t size = bytes.size() - kHeaderBytes;
  overwrite(bytes, kSizeAt, size);
  overwrite<std::uint64_t>(bytes, kChecksumAt, XXH3_64bits(bytes.data() + kHeaderBytes, size));
}

std::vector<std::byte> bytes_of(const World& world) {
  return to_bytes(world.model, world.state);
}

Result<State> state_from(const std::vector<std::byte>& bytes, const std::string& origin) {
  static const Model model = test::small_world(1).model;
  return from_bytes(bytes, model, origin);
}

void expect_refused(const std::vector<std::byte>& bytes, const std::string& because) {
  const Result<State> loaded = state_from(bytes, "saved.state");
  ASSERT_FALSE(loaded.ok());
  EXPECT_NE(loaded.error().text.find("saved.state"), std::string::npos) << loaded.error().text;
  EXPECT_NE(loaded.error().text.find(because), std::string::npos) << loaded.error().text;
}

TEST(StateIoTest, AStateComesBackBitForBit) {
  const World world = test::small_world(1);
  const Result<State> loaded = state_from(bytes_of(world), "memory");
  ASSERT_TRUE(loaded.ok()) << loaded.error().text;
  EXPECT_EQ(hash(loaded.value()), hash(world.state));
  EXPECT_EQ(to_bytes(world.model, loaded.value()), bytes_of(world));
}

TEST(StateIoTest, CapacitiesComeBack) {
  World world = test::small_world(1);
  const State loaded = std::move(state_from(bytes_of(world), "memory")).value();
  EXPECT_EQ(loaded.regions.capacity(), world.state.regions.capacity());
  EXPECT_EQ(loaded.cells.capacity(), world.state.cells.capacity());
}

TEST(StateIoTest, AnEmptyStateComesBack) {
  World world;
  world.model.reserve(Capacities{}, Settings{});
  world.state.reserve(Capacities{}, Settings{});
  const Result<State> loaded = from_bytes(bytes_of(world), world.model, "memory");
  ASSERT_TRUE(loaded.ok()) << loaded.error().text;
  EXPECT_EQ(hash(loaded.value()), hash(world.state));
}

TEST(StateIoTest, EveryTruncationIsRefused) {
  const std::vector<std::byte> whole = bytes_of(test::small_world(1));
  for (std::size_t size = 0; size < whole.size(); size += size < 200 ? 1 : 97) {
    const std::vector<std::byte> part(whole.begin(),
                                      whole.begin() + static_cast<std::ptrdiff_t>(size));
    ASSERT_FALSE(state_from(part, "part").ok()) << size;
  }
  std::vector<std::byte> longer = whole;
  longer.push_back(std::byte{0});
  expect_refused(longer, "cut short or added to");
}

TEST(StateIoTest, EveryFlippedByteIsRefused) {
  std::vector<std::byte> bytes = bytes_of(test::small_world(1));
  for (std::size_t at = 0; at < bytes.size(); at += 13) {
    if (at >= 12 && at < 16) {
      continue;  // the header's padding means nothing
    }
    bytes[at] ^= std::byte{0x40};
    ASSERT_FALSE(state_from(bytes, "flipped").ok()) << at;
    bytes[at] ^= std::byte{0x40};
  }
}

TEST(StateIoTest, RefusalsSayWhy) {
  const std::vector<std::byte> whole = bytes_of(test::small_world(1));
  std::vector<std::byte> bytes = whole;
  bytes[0] = std::byte{'X'};
  expect_refused(bytes, "does not begin with TORSTATE");
  bytes = whole;
  overwrite<std::uint32_t>(bytes, kVersionAt, 99);
  expect_refused(bytes, "version 99");
  bytes = whole;
  overwrite<std::uint64_t>(bytes, kLayoutAt, 1);
  expect_refused(bytes, "another build");
  bytes = whole;
  overwrite<std::uint64_t>(bytes, kModelAt, 1);
  expect_refused(bytes, "another scene");
  bytes = whole;
  bytes.back() ^= std::byte{1};
  expect_refused(bytes, "checksum");
  expect_refused({}, "shorter than its header");
}

// The first table is `bodies`: its size and capacity are the first two numbers after the clock.
TEST(StateIoTest, HostileCountsWithARightChecksumAreRefusedWithoutTakingTheMemory) {
  for (const std::uint32_t count : {2U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFFFU}) {
    std::vector<std::byte> bytes = bytes_of(test::small_world(1));
    overwrite(bytes, kHeaderBytes + sizeof(Clock), count);
    overwrite(bytes, kHeaderBytes + sizeof(Clock) + 4, 0xFFFFFFFFU);
    seal(bytes);
    expect_refused(bytes, "damaged");
  }
}

TEST(StateIoTest, ARowThatDoesNotExistIsRefused) {
  World world = test::small_world(1);
  world.state.regions.at<RegionIdentity>(0).body = 17;
  expect_refused(bytes_of(world), "regions row 0: its body is not there");
}

// Whatever is between a right header and a right checksum: a world that passes the checks, or an
// Error. Run under the sanitizers this proves that the reader stays inside its bytes.
TEST(StateIoTest, NoiseWithARightChecksumNeverCrashes) {
  const std::vector<std::byte> whole = bytes_of(test::small_world(1));
  const Model model = test::small_world(1).model;
  std::mt19937 random(7);  // the same run every time
  for (int round = 0; round < 2000; ++round) {
    std::vector<std::byte> bytes = whole;
    const int changes = 1 + static_cast<int>(random() % 8);
    for (int change = 0; change < changes; ++change) {
      const std::size_t content = bytes.size() - kHeaderBytes;
      const std::size_t at = kHeaderBytes + random() % content;
      if (random() % 8 == 0) {
        bytes.resize(at + 1);
      } else {
        bytes[at] = static_cast<std::byte>(random());
      }
    }
    seal(bytes);
    const Result<State> loaded = from_bytes(bytes, model, "noise");
    if (loaded.ok()) {
      ASSERT_EQ(to_bytes(model, loaded.value()), bytes);
    } else {
      ASSERT_FALSE(loaded.error().text.empty());
    }
  }
}

class StateFileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("torsion_state_" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

  std::filesystem::path folder_;
};

TEST_F(StateFileTest, AFileComesBackAndNothingElseIsLeft) {
  const World world = test::small_world(1);
  const auto path = folder_ / "world.state";
  ASSERT_TRUE(save_state(world.model, test::small_world(2).state, path).ok());
  ASSERT_TRUE(save_state(world.model, world.state, path).ok());
  EXPECT_EQ(files(), 1U);
  const Result<State> loaded = load_state(world.model, path);
  ASSERT_TRUE(loaded.ok()) << loaded.error().text;
  EXPECT_EQ(hash(loaded.value()), hash(world.state));
}

TEST_F(StateFileTest, AMissingFolderIsAnErrorThatNamesThePath) {
  const auto path = folder_ / "no_such_folder" / "world.state";
  const World world = test::small_world(1);
  const Result<Done> saved = save_state(world.model, world.state, path);
  ASSERT_FALSE(saved.ok());
  EXPECT_NE(saved.error().text.find("no_such_folder"), std::string::npos);
  const Result<State> loaded = load_state(world.model, path);
  ASSERT_FALSE(loaded.ok());
  EXPECT_NE(loaded.error().text.find("no_such_folder"), std::string::npos);
}

TEST_F(StateFileTest, AFailedSaveLeavesNothingBehind) {
  // A folder in the place of the file: the rename is refused.
  const auto path = folder_ / "world.state";
  std::filesystem::create_directories(path / "full");
  const World world = test::small_world(1);
  EXPECT_FALSE(save_state(world.model, world.state, path).ok());
  EXPECT_EQ(files(), 1U);
  EXPECT_FALSE(load_state(world.model, path).ok());
}

}  // namespace
}  // namespace torsion::engine
