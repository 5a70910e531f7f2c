// Times of what bodies take at load, of the beam skeleton and of the surface field on a cube with
// one contact region.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "systems/body/skeleton/skeleton.hpp"
#include "systems/model/finite_elements/compliance.hpp"
#include "systems/model/prepare.hpp"
#include "systems/surface/surface_field.hpp"
#include "systems/surface/take_snapshot.hpp"
#include "tests/systems/body_scene.hpp"
#include "tests/systems/model/finite_elements/elastic_solids.hpp"

namespace {

using namespace torsion::engine;  // NOLINT(google-build-using-namespace): one program, one
                                  // namespace

/// A ball of radius 0.05 m, 2 mm deep in the top of the cube.
void press(World& world) {
  add_region(world, {.point = {0.0, 0.05, 0.0},
                     .force_on_body = {1.0, -10.0, 0.0},
                     .radius = 0.014,
                     .depth = 0.002});
  world.state.regions.at<RegionMotion>(0).axis_share = 1.0;
  world.state.regions.at<RegionMotion>(0).axis = glm::dvec3(0.0, 1.0, 0.0);
  world.state.regions.at<RegionFriction>(0).stick_turn = 0.2;
  world.state.regions.at<RegionFriction>(0).stick_radius = 0.01;
  world.state.tools.at<ToolPose>(0).now.position = glm::dvec3(0.0, 0.098, 0.0);
}

void skeleton_with_one_region(benchmark::State& state) {
  World world = body_world(exact_body(ShapeKind::kBox, glm::dvec3(0.05), FixedKind::kPoint));
  press(world);
  Snapshot snapshot;
  snapshot.reserve(world.model, world.state);
  capture(world.model, world.state, snapshot);
  for (auto _ : state) {
    skeleton_motions(world.model, world.state, snapshot);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(skeleton_with_one_region);

void summary_of_the_main_beam(benchmark::State& state) {
  const World world = body_world(exact_body(ShapeKind::kBox, glm::dvec3(0.05), FixedKind::kPoint));
  const Elasticity& elasticity = world.model.bodies.at<Elasticity>(0);
  for (auto _ : state) {
    benchmark::DoNotOptimize(beam_spring(main_beam(world.model, 0, {0.01, 0.05, 0.0}), elasticity));
  }
}
BENCHMARK(summary_of_the_main_beam);

void anchors_and_sections_at_load(benchmark::State& state) {
  const BodyDescription body =
      exact_body(ShapeKind::kEllipsoid, {0.06, 0.04, 0.05}, FixedKind::kPoint);
  const World world = body_world(body);
  for (auto _ : state) {
    benchmark::DoNotOptimize(prepare_anchors(body, world.model, Range{0, 1}, Range{}));
  }
}
BENCHMARK(anchors_and_sections_at_load)->Unit(benchmark::kMillisecond);

void smooth_compliance_of_a_cube_at_load(benchmark::State& state) {
  const ElasticSolid cube = block_solid({1.0, 1.0, 1.0}, 0.45);
  const std::vector<Port> ports = choose_ports(cube, 64);
  for (auto _ : state) {
    benchmark::DoNotOptimize(build_smooth_compliance(
        cube, ports, {static_cast<std::uint32_t>(state.range(0)), 1, {}, true}));
  }
}
BENCHMARK(smooth_compliance_of_a_cube_at_load)
    ->ArgName("elements")
    ->Arg(16)
    ->Arg(24)
    ->Unit(benchmark::kMillisecond);

/// A cube cut so that it has about the given number of vertices.
struct Frame {
  explicit Frame(std::int64_t vertices) {
    std::uint32_t cells = 1;
    while (std::int64_t{6} * (cells + 1) * (cells + 1) < vertices) {
      ++cells;
    }
    scene.bodies.push_back(exact_body(ShapeKind::kBox, glm::dvec3(0.05), FixedKind::kFace, cells));
    scene.tools.emplace_back();
    world = body_world(scene.bodies.front());
    press(world);
    frame = prepare_frame(scene, world.model, world.state);
    snapshot.reserve(world.model, world.state);
    capture(world.model, world.state, snapshot);
    skeleton_motions(world.model, world.state, snapshot);
  }
  SceneDescription scene;
  World world;
  FrameWorld frame;
  Snapshot snapshot;
};

void surface_field_of_one_region(benchmark::State& state) {
  Frame drawn(state.range(0));
  for (auto _ : state) {
    surface_field(drawn.world.model, drawn.snapshot, drawn.frame);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(surface_field_of_one_region)
    ->Arg(1000)
    ->Arg(10000)
    ->Arg(100000)
    ->Unit(benchmark::kMillisecond);

/// Nine more regions on the top of the same cube.
void surface_field_of_ten_regions(benchmark::State& state) {
  Frame drawn(state.range(0));
  for (int i = 1; i < 10; ++i) {
    const double angle = 0.7 * i;
    const std::uint32_t region =
        add_region(drawn.world, {.point = {0.03 * std::cos(angle), 0.05, 0.03 * std::sin(angle)},
                                 .force_on_body = {0.0, -1.0, 0.0},
                                 .radius = 0.005,
                                 .depth = 0.0005});
    drawn.world.state.regions.at<RegionMotion>(region) =
        drawn.world.state.regions.at<RegionMotion>(0);
    drawn.world.state.regions.at<RegionFriction>(region) =
        drawn.world.state.regions.at<RegionFriction>(0);
  }
  capture(drawn.world.model, drawn.world.state, drawn.snapshot);
  for (auto _ : state) {
    surface_field(drawn.world.model, drawn.snapshot, drawn.frame);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(surface_field_of_ten_regions)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);

/// Regions of a half-space model with body model compliance: every vertex gets discs' turns,
/// blocks' dents and the body's own turn.
void surface_field_of_half_space(benchmark::State& state) {
  Frame drawn(state.range(1));
  World& world = drawn.world;
  world.model.bodies.at<BodyModels>(0) = {ContactModel::kPatch, BodyModel::kCompliance};
  for (std::int64_t i = 1; i < state.range(0); ++i) {
    const double angle = 0.7 * static_cast<double>(i);
    add_region(world, {.point = {0.03 * std::cos(angle), 0.05, 0.03 * std::sin(angle)},
                       .force_on_body = {0.0, -1.0, 0.0},
                       .radius = 0.005,
                       .depth = 0.0005});
  }
  capture(world.model, world.state, drawn.snapshot);
  for (std::uint32_t region = 0; region < world.state.regions.size(); ++region) {
    RegionField& field = drawn.snapshot.region_fields.at<RegionField>(region);
    field.radius = world.state.regions.at<Contact>(region).radius;
    field.spread = 0.1 * field.radius;
    std::ranges::fill(field.turn, 0.01);
    for (std::uint32_t block = 0; block < kFieldBlocks * kFieldBlocks; ++block) {
      const glm::dvec2 place(block % kFieldBlocks, block / kFieldBlocks);
      field.blocks[block] = {0.4 * field.radius * (place - 2.0), 0.04};
    }
    std::ranges::fill(drawn.snapshot.region_fields.at<AnchorTurns>(region).turn, 0.01);
  }
  for (auto _ : state) {
    surface_field(world.model, drawn.snapshot, drawn.frame);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(surface_field_of_half_space)
    ->ArgsProduct({{1, 10}, {10000, 100000}})
    ->Unit(benchmark::kMillisecond);

void deform_on_the_cpu(benchmark::State& state) {
  Frame drawn(state.range(0));
  surface_field(drawn.world.model, drawn.snapshot, drawn.frame);
  std::vector<glm::vec4> positions(drawn.frame.body_vertices.size());
  for (auto _ : state) {
    deform_vertices(drawn.frame, 0, positions);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(deform_on_the_cpu)->Arg(100000)->Unit(benchmark::kMillisecond);

}  // namespace
