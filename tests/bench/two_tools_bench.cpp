// What a step costs with two tools on one soft column: one alone, one that waits beside it for what
// the other makes of the column, and both in contact. Run by ./dev bench.

#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"

namespace torsion::engine {
namespace {

constexpr double kHalfWidth = 0.015;  // m
constexpr double kHalfHeight = 0.05;  // m
constexpr double kBall = 0.02;        // m, radius

SceneDescription column(ContactModel contact) {
  SceneDescription scene;
  scene.bodies.push_back(
      test::make_body({test::make_part(ShapeKind::kBox, {kHalfWidth, kHalfHeight, kHalfWidth},
                                       {glm::dvec3(0.0, kHalfHeight, 0.0), test::kUpright})}));
  BodyDescription& body = scene.bodies[0];
  body.elasticity = {1e6, 0.3, 1100.0};
  body.friction = {0.5, 0.5};
  body.fixed.kind = FixedKind::kFace;
  body.fixed.point = glm::dvec3(0.0);
  body.fixed.normal = {0.0, 1.0, 0.0};
  body.models = {contact, BodyModel::kCompliance};
  for (int tool = 0; tool < 2; ++tool) {
    scene.tools.push_back(
        test::make_tool({test::make_part(ShapeKind::kSphere, glm::dvec3(kBall))}));
  }
  return scene;
}

/// @param gap  m: from the column at rest to the right ball, while the left one has pushed it by 3
///             mm and slides to and fro
void step_of_two_tools(benchmark::State& state, ContactModel contact, double gap) {
  constexpr double kPush = 3e-3;  // m
  constexpr int kComing = 600;    // steps
  test::Hand hand(column(contact));
  int step = 0;
  const auto go_on = [&] {
    const double push = kPush * std::min(1.0, static_cast<double>(step) / kComing);
    const double along = 1e-3 * std::sin(0.01 * step);
    const double x = kHalfWidth + kBall;
    hand.step_to(
        {{{push - x, 0.08, along}, test::kUpright}, {{x + gap, 0.08, 0.0}, test::kUpright}});
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
