// Damages good scene files in thousands of ways and loads each: the loader must end, with a scene
// or with problems, and never both or neither. The seed is fixed: every run damages the same way.
// The sanitizer builds run this too.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include <gtest/gtest.h>
#include <unistd.h>

#include "scenes/load_gltf.hpp"
#include "tests/support/paths.hpp"

namespace torsion::engine {
namespace {

constexpr int kDamagesOfAFile = 250;
constexpr double kLongest = 5.0;  // s for one file, under sanitizers on a busy machine

std::string read_all(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

using Random = std::mt19937_64;

std::size_t any_below(Random& random, std::size_t end) {
  return end == 0 ? 0 : random() % end;
}

/// Numbers that break careless readers.
const std::vector<std::string> kNumbers = {
    "-1",    "0",    "1",     "2147483648", "4294967296", "1e400", "-0.5", "1099511627776",
    "65535", "null", "\"x\"", "[]",         "{}",         "true",  "44.0", "18446744073709551615"};

/// Replaces one number of the text by another.
void swap_number(std::string& text, Random& random) {
  const auto is_digit = [](char letter) {
    return letter >= '0' && letter <= '9';
  };
  const auto start = text.begin() + static_cast<std::ptrdiff_t>(any_below(random, text.size()));
  const auto first = std::find_if(start, text.end(), is_digit);
  const auto last = std::find_if_not(first, text.end(), is_digit);
  text.replace(first, last, kNumbers[any_below(random, kNumbers.size())]);
}

/// Copies one stretch of the text over another place.
void copy_stretch(std::string& text, Random& random) {
  const std::size_t length = 1 + any_below(random, 60);
  const std::string stretch = text.substr(any_below(random, text.size()), length);
  const std::size_t at = any_below(random, text.size());
  if (random() % 2 == 0) {
    text.insert(at, stretch);
  } else {
    text.replace(at, std::min(length, text.size() - at), stretch);
  }
}

void damage(std::string& bytes, Random& random) {
  const std::size_t times = 1 + any_below(random, 3);
  for (std::size_t i = 0; i < times && !bytes.empty(); ++i) {
    switch (random() % 5) {
      case 0:
        bytes[any_below(random, bytes.size())] = static_cast<char>(random());
        break;
      case 1:
        bytes.resize(any_below(random, bytes.size()));
        break;
      case 2:
        bytes.erase(any_below(random, bytes.size()), 1 + any_below(random, 20));
        break;
      case 3:
        copy_stretch(bytes, random);
        break;
      default:
        swap_number(bytes, random);
    }
  }
}

/// The head of a file, where its structure is: damage to vertices says little.
std::string damaged(std::string bytes, std::size_t head, Random& random) {
  std::string front = bytes.substr(0, head);
  damage(front, random);
  return front + (bytes.size() > head ? bytes.substr(head) : "");
}

class LoadGltfFuzzTest : public testing::TestWithParam<std::string> {
 protected:
  LoadGltfFuzzTest()
      : folder_(std::filesystem::temp_directory_path() /
                ("torsion_fuzz_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~LoadGltfFuzzTest() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_P(LoadGltfFuzzTest, EndsWithASceneOrWithProblems) {
  const std::filesystem::path source =
      std::filesystem::path(test::source_folder()) / "scenes" / GetParam();
  const std::string good = read_all(source);
  ASSERT_FALSE(good.empty());
  const std::filesystem::path buffer = std::filesystem::path(source).replace_extension(".bin");
  if (std::filesystem::exists(buffer)) {
    std::filesystem::copy(buffer, folder_ / buffer.filename());
  }
  // A .glb begins with its framing and its JSON; of a .gltf all is JSON.
  const std::size_t head = std::min<std::size_t>(good.size(), 12'000);
  Random random(20'070'707);
  int refused = 0;
  for (int i = 0; i < kDamagesOfAFile; ++i) {
    const std::filesystem::path path = folder_ / ("damaged" + source.extension().string());
    std::ofstream(path, std::ios::binary) << damaged(good, head, random);
    const auto start = std::chrono::steady_clock::now();
    const LoadedScene loaded = load_gltf(path);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_NE(loaded.scene.has_value(), !loaded.problems.empty()) << "damage " << i;
    EXPECT_LT(seconds, kLongest) << "damage " << i;
    refused += loaded.scene ? 0 : 1;
  }
  // Most damage breaks the JSON; some hits a name or a digit of a position.
  EXPECT_GT(refused, kDamagesOfAFile / 2);
}

INSTANTIATE_TEST_SUITE_P(Scenes, LoadGltfFuzzTest,
                         testing::Values("ball_on_cube.gltf", "compass_on_ellipsoid.gltf",
                                         "blender/knob_on_pad.glb"),
                         [](const testing::TestParamInfo<std::string>& scene) {
                           return std::filesystem::path(scene.param).stem().string();
                         });

}  // namespace
}  // namespace torsion::engine
