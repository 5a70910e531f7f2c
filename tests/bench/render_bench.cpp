// What a picture costs: 100 k vertices deformed and drawn at 1280x720, each pass by the device's
// clock, and both compute passes against the same arithmetic in one thread of C++ over the same
// rows. Wanted where the device is the processor (lavapipe, which uses all its cores): at most
// twice the time of C++ for the deformation with every vertex turned, and five times for normals.
// With less to turn, C++ skips vertices and the device turns them by nothing.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "render/normal_rings.hpp"
#include "render/renderer.hpp"
#include "systems/surface/surface_field.hpp"
#include "tests/render/render_scenes.hpp"

namespace {

using namespace torsion::engine;  // NOLINT(google-build-using-namespace): one program, one
                                  // namespace

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

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Time of `f`, ms: the better of two runs, the first of which fills the caches.
template <class F>
double milliseconds_of(F&& f) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 2; ++i) {
    const auto start = std::chrono::steady_clock::now();
    f();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count());
  }
  return best;
}

/// The twins of the compute passes, over the rows that these read.
class CpuTwins {
 public:
  explicit CpuTwins(const FrameWorld& frame)
      : frame_(&frame),
        rings_(make_normal_rings(frame)),
        positions_(frame.body_vertices.size()),
        normals_(frame.body_vertices.size()) {}

  double deform() {
    return milliseconds_of([&] { deform_vertices(*frame_, 0, positions_); });
  }
  double normals() {
    return milliseconds_of([&] { vertex_normals(*frame_, rings_, 0, positions_, normals_); });
  }

 private:
  const FrameWorld* frame_;
  NormalRings rings_;
  std::vector<glm::vec4> positions_;
  std::vector<glm::vec4> normals_;
};

/// What each frame gave, ms.
struct Measured {
  std::vector<PassTimes> passes;
  std::vector<double> cpu_deform;
  std::vector<double> cpu_normals;
};

void print(const char* name, const Measured& measured, const std::string& device) {
  std::printf("%-22s", name);
  for (const PassTime& pass : kPasses) {
    std::vector<double> times;
    for (const PassTimes& frame : measured.passes) {
      times.push_back(frame.*pass.time);
    }
    std::printf("%11.3f", lower_quartile(times));
  }
  std::printf("   ms on %s\n", device.c_str());
}

/// kFrames frames, each followed by the twins: a machine shared with others is now fast, now slow,
/// and only neighbours in time compare. Passes are printed as a row.
Measured measure(const TwistedCube& scene, std::uint32_t samples, const char* name) {
  RendererOptions options;
  options.samples = samples;
  Result<Renderer> renderer = Renderer::create(options, scene.frame);
  if (!renderer) {
    std::fprintf(stderr, "%s\n", renderer.error().text.c_str());
    std::exit(1);  // NOLINT(concurrency-mt-unsafe): no other thread runs
  }
  DrawOptions draw;
  draw.heat_map = HeatMap::kTwist;
  CpuTwins cpu(scene.frame);
  Measured measured;
  for (int i = -2; i < kFrames; ++i) {  // the first two compile shaders
    const auto number =
        renderer.value().draw(scene.frame, scene.snapshot, scene.camera, draw, nullptr);
    const PassTimes passes = renderer.value().pass_times(number.value()).value();
    const double cpu_deform = cpu.deform();
    const double cpu_normals = cpu.normals();
    if (i >= 0) {
      measured.passes.push_back(passes);
      measured.cpu_deform.push_back(cpu_deform);
      measured.cpu_normals.push_back(cpu_normals);
    }
  }
  print(name, measured, renderer.value().device_name());
  return measured;
}

void compare(const char* name, double PassTimes::*pass, const Measured& measured,
             const std::vector<double>& cpu, double wanted) {
  std::vector<double> device;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < cpu.size(); ++i) {
    device.push_back(measured.passes[i].*pass);
    ratios.push_back(device.back() / cpu[i]);
  }
  std::printf("%-8s device %7.3f ms, one thread of C++ %7.3f ms, ratio %5.2f", name, median(device),
              median(cpu), median(ratios));
  if (wanted > 0.0) {
    std::printf(" (wanted <= %.0f)", wanted);
  }
  std::printf("\n");
}

/// Medians over the frames, of the ratios too.
/// @param wanted_deform, wanted_normals  ratios to beat; 0 where there is no goal
void compare_with_cpu(const Measured& measured, double wanted_deform, double wanted_normals) {
  compare("deform", &PassTimes::deform, measured, measured.cpu_deform, wanted_deform);
  compare("normals", &PassTimes::normals, measured, measured.cpu_normals, wanted_normals);
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
  const Measured all_turned = measure(scene, 1, "1 region, 1 sample");
  measure(scene, 4, "1 region, 4 samples");
  compare_with_cpu(all_turned, kWantedDeform, kWantedNormals);

  // What is usual: a twist that ends within a few contact radii.
  for (TwistAngle& angle : scene.frame.twist.column<TwistAngle>()) {
    angle.angle = std::abs(angle.angle) < 0.1F ? 0.0F : angle.angle;
  }
  compare_with_cpu(measure(scene, 1, "twist near the contact"), 0.0, kWantedNormals);

  scene.frame.bodies.at<FrameBody>(0).regions_drawn = 0;
  compare_with_cpu(measure(scene, 1, "no region"), 0.0, kWantedNormals);
  return 0;
}
