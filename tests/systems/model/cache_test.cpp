#include "systems/model/cache.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace torsion::engine {
namespace {

using Bytes = std::vector<std::byte>;
namespace fs = std::filesystem;

Bytes bytes_of(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  Bytes bytes(count);
  for (std::byte& byte : bytes) {
    byte = static_cast<std::byte>(random() & 0xFFU);
  }
  return bytes;
}

CacheKey key_of(const std::vector<Bytes>& pieces, std::string_view kind = "thing",
                std::uint32_t version = 1) {
  std::vector<std::span<const std::byte>> spans(pieces.begin(), pieces.end());
  return cache_key(kind, version, spans);
}

/// A cache folder of its own for each test, gone afterwards.
class CacheTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = fs::temp_directory_path() / "torsion_cache_XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    set("TORSION_CACHE_DIR", folder_);
  }
  void TearDown() override {
    for (const char* const name : {"TORSION_CACHE_DIR", "XDG_CACHE_HOME"}) {
      unsetenv(name);  // NOLINT(concurrency-mt-unsafe): one thread
    }
    set("HOME", home_);
    fs::remove_all(folder_);
  }

  static void set(const char* name, const std::string& value) {
    setenv(name, value.c_str(), 1);  // NOLINT(concurrency-mt-unsafe): one thread
  }
  static void unset(const char* name) {
    unsetenv(name);  // NOLINT(concurrency-mt-unsafe): one thread
  }
  [[nodiscard]] std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
  std::string home_ = std::getenv("HOME") == nullptr  // NOLINT(concurrency-mt-unsafe)
                          ? ""
                          : std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe)
};

TEST_F(CacheTest, GivesBackWhatWasStored) {
  const CacheKey key = key_of({bytes_of(100, 1)});
  EXPECT_FALSE(load_cached(key).has_value());
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{100'000}}) {
    const Bytes stored = bytes_of(size, 2);
    ASSERT_TRUE(store_cached(key, stored));
    const std::optional<Bytes> loaded = load_cached(key);
    ASSERT_TRUE(loaded.has_value());
    EXPECT_EQ(*loaded, stored);
  }
  EXPECT_EQ(files(), 1U);  // the newest replaced the others, nothing unfinished is left
}

TEST_F(CacheTest, KeysTellContentKindVersionAndTheCutsBetweenPiecesApart) {
  const Bytes a = bytes_of(64, 1);
  Bytes changed = a;
  changed[63] ^= std::byte{1};
  const Bytes front(a.begin(), a.begin() + 10);
  const Bytes back(a.begin() + 10, a.end());
  std::set<std::string> names;
  names.insert(key_of({a}).file_name);
  names.insert(key_of({changed}).file_name);
  names.insert(key_of({front, back}).file_name);
  names.insert(key_of({back, front}).file_name);
  names.insert(key_of({a, {}}).file_name);
  names.insert(key_of({a}, "other").file_name);
  names.insert(key_of({a}, "thing", 2).file_name);
  EXPECT_EQ(names.size(), 7U);
  EXPECT_EQ(key_of({a}).file_name, key_of({bytes_of(64, 1)}).file_name);
}

TEST_F(CacheTest, AFileCutShortAnywhereIsNoEntry) {
  const CacheKey key = key_of({bytes_of(8, 1)});
  ASSERT_TRUE(store_cached(key, bytes_of(500, 3)));
  const fs::path file = folder_ / key.file_name;
  const std::uintmax_t whole = fs::file_size(file);
  for (std::uintmax_t length = whole; length-- > 0;) {
    fs::resize_file(file, length);
    ASSERT_FALSE(load_cached(key).has_value()) << length << " of " << whole << " bytes";
  }
}

TEST_F(CacheTest, AnyChangedByteAndAnyAddedByteIsNoEntry) {
  const CacheKey key = key_of({bytes_of(8, 1)});
  const fs::path file = folder_ / key.file_name;
  const Bytes content = bytes_of(200, 4);
  ASSERT_TRUE(store_cached(key, content));
  const std::uintmax_t size = fs::file_size(file);
  for (std::uintmax_t at = 0; at < size; ++at) {
    ASSERT_TRUE(store_cached(key, content));
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(static_cast<std::streamoff>(at));
    const int byte = stream.get();
    stream.seekp(static_cast<std::streamoff>(at));
    stream.put(static_cast<char>(byte ^ 0x10));
    stream.close();
    ASSERT_FALSE(load_cached(key).has_value()) << "byte " << at;
  }
  ASSERT_TRUE(store_cached(key, content));
  std::ofstream(file, std::ios::app | std::ios::binary).put('x');
  EXPECT_FALSE(load_cached(key).has_value());
  ASSERT_TRUE(store_cached(key, content));  // a bad entry is replaced like a good one
  EXPECT_TRUE(load_cached(key).has_value());
}

TEST_F(CacheTest, AHeaderThatPromisesTooMuchTakesNoMemory) {
  const CacheKey key = key_of({bytes_of(8, 1)});
  ASSERT_TRUE(store_cached(key, bytes_of(200, 4)));
  std::fstream stream(folder_ / key.file_name, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(8);                                    // the length
  const std::uint64_t huge = ~std::uint64_t{0} - 31;  // with the header's 32 bytes it wraps to 0
  stream.write(reinterpret_cast<const char*>(&huge), sizeof(huge));
  stream.close();
  EXPECT_FALSE(load_cached(key).has_value());
}

TEST_F(CacheTest, ManyWritersAtOnceLeaveOneWholeEntry) {
  const CacheKey key = key_of({bytes_of(8, 1)});
  const std::vector<Bytes> contents{bytes_of(50'000, 1), bytes_of(70'000, 2), bytes_of(10, 3)};
  std::vector<std::jthread> writers;
  writers.reserve(contents.size());
  for (const Bytes& content : contents) {
    writers.emplace_back([&key, &content] {
      for (int i = 0; i < 50; ++i) {
        EXPECT_TRUE(store_cached(key, content));
        const std::optional<Bytes> seen = load_cached(key);
        // What another has just renamed into place, or an entry swapped between opening and asking
        // its size; never a mixture.
        if (seen.has_value()) {
          EXPECT_TRUE(*seen == content || seen->size() != content.size());
        }
      }
    });
  }
  writers.clear();
  const std::optional<Bytes> last = load_cached(key);
  ASSERT_TRUE(last.has_value());
  EXPECT_NE(std::find(contents.begin(), contents.end(), *last), contents.end());
  EXPECT_EQ(files(), 1U);
}

TEST_F(CacheTest, AWriterKilledHalfWayDoesNoHarm) {
  const CacheKey key = key_of({bytes_of(8, 1)});
  const Bytes content = bytes_of(100, 1);
  ASSERT_TRUE(store_cached(key, content));
  // What it leaves is a file under another name.
  std::ofstream(folder_ / (key.file_name + ".part-abc123")) << "half";
  EXPECT_EQ(load_cached(key), content);
  EXPECT_TRUE(store_cached(key, content));
}

TEST_F(CacheTest, AFolderThatCannotBeWrittenOnlyMeansNoEntry) {
  const CacheKey key = key_of({bytes_of(8, 1)});
  const fs::path file = folder_ / "a_file";
  std::ofstream(file) << "not a folder";
  set("TORSION_CACHE_DIR", file / "below");
  EXPECT_FALSE(store_cached(key, bytes_of(10, 1)));
  EXPECT_FALSE(load_cached(key).has_value());
  set("TORSION_CACHE_DIR", "/proc/self/no_such_folder");  // not even root can make it
  EXPECT_FALSE(store_cached(key, bytes_of(10, 1)));
  EXPECT_FALSE(load_cached(key).has_value());
}

TEST_F(CacheTest, AFolderInThePlaceOfAnEntryOnlyMeansNoEntry) {
  const CacheKey key = key_of({bytes_of(8, 1)});
  fs::create_directories(folder_ / key.file_name / "inside");
  EXPECT_FALSE(load_cached(key).has_value());
  EXPECT_FALSE(store_cached(key, bytes_of(10, 1)));
  EXPECT_EQ(files(), 1U);
}

TEST_F(CacheTest, FolderIsTheChosenOneElseXdgElseHome) {
  EXPECT_EQ(cache_folder(), folder_);
  unset("TORSION_CACHE_DIR");
  set("XDG_CACHE_HOME", "/somewhere/else");
  EXPECT_EQ(cache_folder(), "/somewhere/else/torsion");
  set("XDG_CACHE_HOME", "relative/is/ignored");
  set("HOME", "/home/someone");
  EXPECT_EQ(cache_folder(), "/home/someone/.cache/torsion");
  unset("XDG_CACHE_HOME");
  unset("HOME");
  EXPECT_EQ(cache_folder(), "");
  EXPECT_FALSE(store_cached(key_of({bytes_of(8, 1)}), bytes_of(10, 1)));
}

}  // namespace
}  // namespace torsion::engine
