// Random scenes, one a seed, and the properties that must hold for each.
// usage: scene_fuzz [SECONDS [FIRST_SEED]]

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <fmt/format.h>

#include "tests/fuzz/scene_properties.hpp"

namespace {

using torsion::engine::test::RandomScene;

/// Of so many, one is run in twice as many steps, too. No multiple of four: all kinds come.
constexpr std::uint64_t kStepsOf = 5;

/// Of four, one is at an edge and one a pinch; the line of a scene says so.
RandomScene scene_of(std::uint64_t seed) {
  switch (seed % 4) {
    case 1:
      return torsion::engine::test::random_scene_at_edge(seed);
    case 3:
      return torsion::engine::test::random_pinch(seed);
    default:
      return torsion::engine::test::random_scene(seed);
  }
}

}  // namespace

int main(int count, char** words) {
  using Clock = std::chrono::steady_clock;
  const double seconds = count > 1 ? std::strtod(words[1], nullptr) : 60.0;
  const std::uint64_t first = count > 2 ? std::strtoull(words[2], nullptr, 10) : 1;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  std::uint64_t seed = first;
  std::uint64_t broken = 0;
  for (; Clock::now() < end; ++seed) {
    const RandomScene scene = scene_of(seed);
    auto property = broken_property(scene);
    if (!property && seed % kStepsOf == 0) {
      property = depends_on_steps(scene);
    }
    if (property) {
      broken += 1;
      fmt::print("seed {}: {}\n  {}\n", seed, *property, scene.text);
      std::fflush(stdout);
    }
  }
  fmt::print("{} scenes, {} broken\n", seed - first, broken);
  return broken == 0 ? 0 : 1;
}
