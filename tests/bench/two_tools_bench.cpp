// What a step costs with two tools on one soft column: one alone, one that waits beside it for what
// the other makes of the column, and both in contact. Run by ./dev bench.

#include <algorithm>
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "tests/support/contact_scenes.hpp"
#include "tests/support/pinched_column.hpp"

namespace torsion::engine {
namespace {

/// @param gap  m: from the column at rest to the right ball, while the left one has pushed it by 3
///             mm and slides to and fro
void step_of_two_tools(benchmark::State& state, ContactModel contact, double gap) {
  constexpr double kPush = 3e-3;   // m
  constexpr int kComing = 600;     // steps
  constexpr double kWidth = 0.03;  // m
  test::Hand hand(test::pinched_column(kWidth, contact, 0.5));
  int step = 0;
  const auto go_on = [&] {
    const double push = kPush * std::min(1.0, static_cast<double>(step) / kComing);
    std::vector<Pose> poses = test::pinch_poses(kWidth, push, -gap);
    poses[0].position.z = 1e-3 * std::sin(0.01 * step);
    hand.step_to(poses);
    ++step;
  };
  while (step < 2 * kComing) {
    go_on();
  }
  for (auto _ : state) {
    go_on();
  }
  state.counters["regions"] = hand.world().state.regions.size();
}

BENCHMARK_CAPTURE(step_of_two_tools, mdr_one_far_away, ContactModel::kMdr, 1.0);
BENCHMARK_CAPTURE(step_of_two_tools, mdr_one_waits, ContactModel::kMdr, 4e-3);
BENCHMARK_CAPTURE(step_of_two_tools, mdr_pinch, ContactModel::kMdr, 1e-3);
BENCHMARK_CAPTURE(step_of_two_tools, patch_one_far_away, ContactModel::kPatch, 1.0);
BENCHMARK_CAPTURE(step_of_two_tools, patch_one_waits, ContactModel::kPatch, 4e-3);
BENCHMARK_CAPTURE(step_of_two_tools, patch_pinch, ContactModel::kPatch, 1e-3);

}  // namespace
}  // namespace torsion::engine
