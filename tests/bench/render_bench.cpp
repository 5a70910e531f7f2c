// What a picture costs: 100 k vertices deformed and drawn at 1280x720, each pass by the device's
// clock, and both compute passes against the same arithmetic in one thread of C++ over the same
// rows. Wanted where the device is the processor (lavapipe, which uses all its cores): at most
// twice the time of C++ for the deformation with every vertex turned, and five times for normals.
// With less to turn, C++ skips and the device stays at its price of reading and writing rows.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "render/normal_rings.hpp"
#include "render/renderer.hpp"
#include "systems/surface_field.hpp"
#include "tests/render/render_scenes.hpp"

namespace {

using namespace torsion;  // NOLINT(google-build-using-namespace): one program, one namespace

constexpr std::uint32_t kSquares = 128;  // 6 x 129 x 129 vertices
constexpr int kFrames = 30;
constexpr double kWantedDeform = 2.0;
constexpr double kWantedNormals = 5.0;

/// A quarter of the values are less: a machine's neighbours slow some frames down, none speeds one
/// up.
double lower_quartile(std::vector<double> values) {
  const auto quarter = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 4);
  std::ranges::nth_element(values, quarter);
  return *quarter;
}

/// Lower quartile of the times of `f`, ms.
template <class F>
double milliseconds_of(F&& f) {
  std::vector<double> times;
  for (int i = 0; i < kFrames; ++i) {
    const auto start = std::chrono::steady_clock::now();
    f();
    times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
            .count());
  }
  return lower_quartile(times);
}

/// Lower quartiles over kFrames frames, printed as a row.
PassTimes measure(const TwistedCube& scene, std::uint32_t samples, const char* name) {
  RendererOptions options;
  options.samples = samples;
  Result<Renderer> renderer = Renderer::create(options, scene.frame);
  if (!renderer) {
    std::fprintf(stderr, "%s\n", renderer.error().text.c_str());
    std::exit(1);  // NOLINT(concurrency-mt-unsafe): no other thread runs
  }
  DrawOptions draw;
  draw.heat_map = HeatMap::kTwist;
  std::vector<PassTimes> frames;
  for (int i = 0; i < kFrames + 2; ++i) {  // the first two compile shaders
    const auto number =
        renderer.value().draw(scene.frame, scene.snapshot, scene.camera, draw, nullptr);
    frames.push_back(renderer.value().pass_times(number.value()).value());
  }
  PassTimes passes;
  std::printf("%-22s", name);
  for (const PassTime& pass : kPasses) {
    std::vector<double> times;
    for (std::size_t i = 2; i < frames.size(); ++i) {
      times.push_back(frames[i].*pass.time);
    }
    passes.*pass.time = lower_quartile(times);
    std::printf("%11.3f", passes.*pass.time);
  }
  std::printf("   ms on %s\n", renderer.value().device_name().c_str());
  return passes;
}

void compare(const char* pass, double device, double cpu, double wanted) {
  std::printf("%-8s device %7.3f ms, one thread of C++ %7.3f ms, ratio %5.2f", pass, device, cpu,
              device / cpu);
  if (wanted > 0.0) {
    std::printf(" (wanted <= %.0f)", wanted);
  }
  std::printf("\n");
}

/// The twins over the same rows.
/// @param wanted_deform, wanted_normals  ratios to beat; 0 where there is no goal
void compare_with_cpu(const FrameWorld& frame, const PassTimes& device, double wanted_deform,
                      double wanted_normals) {
  std::vector<glm::vec4> positions(frame.body_vertices.size());
  std::vector<glm::vec4> normals(frame.body_vertices.size());
  const NormalRings rings = make_normal_rings(frame);
  compare("deform", device.deform, milliseconds_of([&] { deform_vertices(frame, 0, positions); }),
          wanted_deform);
  compare("normals", device.normals,
          milliseconds_of([&] { vertex_normals(frame, rings, 0, positions, normals); }),
          wanted_normals);
}

}  // namespace

int main() {
  TwistedCube scene = twisted_cube(1.0, kSquares);
  std::printf("%u vertices, %u triangles, 1280x720\n%-22s", scene.frame.body_vertices.size(),
              scene.frame.body_triangles.size(), "");
  for (const PassTime& pass : kPasses) {
    std::printf("%11s", pass.name);
  }
  std::printf("\n");
  const PassTimes all_turned = measure(scene, 1, "1 region, 1 sample");
  measure(scene, 4, "1 region, 4 samples");
  compare_with_cpu(scene.frame, all_turned, kWantedDeform, kWantedNormals);

  // What is usual: a twist that ends within a few contact radii.
  for (TwistAngle& angle : scene.frame.twist.column<TwistAngle>()) {
    angle.angle = std::abs(angle.angle) < 0.1F ? 0.0F : angle.angle;
  }
  compare_with_cpu(scene.frame, measure(scene, 1, "twist near the contact"), 0.0, kWantedNormals);

  scene.frame.bodies.at<FrameBody>(0).regions_drawn = 0;
  compare_with_cpu(scene.frame, measure(scene, 1, "no region"), 0.0, kWantedNormals);
  return 0;
}
