// What a step costs: the shipped scenes in contact, the same body cut ever finer, loading, and a
// whole run against the clock. Run by ./dev bench.
//
// All of them are run five times, in turns; printed are the median of the runs and, in brackets,
// the least, which is what it costs where no neighbour slows the machine down.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <vector>

#include <benchmark/benchmark.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/simulate_loop.hpp"
#include "device/scripted_motion.hpp"
#include "scenes/load_gltf.hpp"
#include "scenes/write_gltf.hpp"
#include "systems/scratch.hpp"
#include "systems/surface/surface_field.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/paths.hpp"

namespace torsion::engine {
namespace {

using SteadyClock = std::chrono::steady_clock;

double seconds_since(SteadyClock::time_point start) {
  return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

/// Counts every step's time and gives the benchmark their median and 99th percentile in us.
class StepTimes {
 public:
  StepTimes() { times_.reserve(1 << 20); }
  void add(double seconds) { times_.push_back(seconds); }
  void report(benchmark::State& state) {
    std::ranges::sort(times_);
    const auto at = [this](double share) {
      return 1e6 * times_[static_cast<std::size_t>(share * static_cast<double>(times_.size() - 1))];
    };
    state.counters["median_us"] = at(0.5);
    state.counters["p99_us"] = at(0.99);
  }

 private:
  std::vector<double> times_;
};

/// Steps through the scripted motion between two times of full contact, to and fro.
void time_contact(benchmark::State& state, Session& session) {
  constexpr double kFirst = 1.0;  // s
  constexpr double kLast = 3.3;   // s
  const double dt = session.simulation.world.model.dt;
  while (session.simulation.world.state.clock.time < kFirst) {
    step_scripted(session);
  }
  StepTimes times;
  double time = kFirst;
  double way = dt;
  for (auto _ : state) {
    way = time + way > kLast || time + way < kFirst ? -way : way;
    time += way;
    for (std::size_t tool = 0; tool < session.tool_poses.size(); ++tool) {
      session.tool_poses[tool] = scripted_pose(session.scene.tools[tool].script, time);
    }
    const auto start = SteadyClock::now();
    step(session.simulation, session.tool_poses);
    const double seconds = seconds_since(start);
    state.SetIterationTime(seconds);
    times.add(seconds);
  }
  times.report(state);
  state.counters["regions"] = session.simulation.world.state.regions.size();
  if (session.simulation.world.state.clock.faults_ever != 0) {
    state.SkipWithError("a fault during the run");
  }
}

/// The paper's models, which the goals of the whole step were set for.
PrepareOptions papers_models() {
  PrepareOptions options;
  options.contact_model = ContactModel::kPaper;
  options.body_model = BodyModel::kSkeleton;
  return options;
}

void step_of_scene(benchmark::State& state, const std::string& name) {
  Result<Session> session = open_session(test::shipped_scene(name), papers_models(), true);
  if (!session) {
    state.SkipWithError(session.error().text.c_str());
    return;
  }
  Session opened = std::move(session).value();
  time_contact(state, opened);
}

/// @return how many cells of a region bear pressure now, on average
double cells_in_contact(const World& world) {
  double cells = 0.0;
  for (std::uint32_t region = 0; region < world.state.regions.size(); ++region) {
    const Range range = world.state.regions.at<RegionIdentity>(region).cells;
    cells += static_cast<double>(std::ranges::count_if(
        world.state.cells.rows<CellTraction>(range),
        [](const CellTraction& traction) { return traction.pressure > 0.0; }));
  }
  return cells / std::max(1.0, static_cast<double>(world.state.regions.size()));
}

/// A half-space model: the whole step, and the model's own share of it as a counter.
/// @param systems  what their names begin with
void step_of_model(benchmark::State& state, const std::string& name, ContactModel contact,
                   std::string_view systems, BodyModel body = BodyModel::kNone) {
  PrepareOptions options;
  options.contact_model = contact;
  options.body_model = body;
  options.settings.grid_side = static_cast<std::uint32_t>(state.range(0));
  Result<Session> opened = open_session(test::shipped_scene(name), options, true);
  if (!opened) {
    state.SkipWithError(opened.error().text.c_str());
    return;
  }
  Session session = std::move(opened).value();
  time_contact(state, session);
  double model = 0.0;  // s a step
  for (const auto& row : session.simulation.scratch->schedule.rows()) {
    if (std::string_view(row.system.name).starts_with(systems)) {
      model += row.timing.total_s / static_cast<double>(row.timing.runs);
    }
  }
  state.counters["model_us"] = 1e6 * model;
  state.counters["cells"] = cells_in_contact(session.simulation.world);
}

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The longest step of a scene's whole motion with contact model patch, regions that begin and
/// grids that are laid anew included. Every iteration does the same steps: the least time of each
/// counts, by the thread's own clock, so that what else the machine did does not.
void longest_step(benchmark::State& state, const std::string& name) {
  PrepareOptions options;
  options.contact_model = ContactModel::kPatch;
  std::vector<double> times;
  for (auto _ : state) {
    Result<Session> opened = open_session(test::shipped_scene(name), options, true);
    if (!opened) {
      state.SkipWithError(opened.error().text.c_str());
      return;
    }
    Session session = std::move(opened).value();
    times.resize(steps_in(session, session.scene.duration), 1.0);
    double whole = 0.0;
    for (double& least : times) {
      const double start = thread_seconds();
      step_scripted(session);
      const double seconds = thread_seconds() - start;
      least = std::min(least, seconds);
      whole += seconds;
    }
    state.SetIterationTime(whole);
  }
  std::ranges::sort(times);
  state.counters["p99_us"] = 1e6 * times[times.size() * 99 / 100];
  state.counters["longest_us"] = 1e6 * times.back();
}

/// What who draws asks for beside the step: of a scene in full contact, with the models that `auto`
/// takes.
void snapshot_of_scene(benchmark::State& state, const std::string& name) {
  Result<Session> opened = open_session(test::shipped_scene(name), PrepareOptions{}, true);
  if (!opened) {
    state.SkipWithError(opened.error().text.c_str());
    return;
  }
  Session session = std::move(opened).value();
  const World& world = session.simulation.world;
  std::uint64_t steps = 0;
  double of_steps = 0.0;  // s, of the last half second
  while (world.state.clock.time < 2.0) {
    const auto start = SteadyClock::now();
    step_scripted(session);
    if (world.state.clock.time > 1.5) {
      of_steps += seconds_since(start);
      ++steps;
    }
  }
  Snapshot snapshot;
  snapshot.reserve(world.model, world.state);
  double of_snapshots = 0.0;
  for (auto _ : state) {
    const auto start = SteadyClock::now();
    take_snapshot(session.simulation, snapshot);
    state.SetIterationTime(seconds_since(start));
    of_snapshots += seconds_since(start);
  }
  state.counters["regions"] = world.state.regions.size();
  // What a step saves where nothing is drawn.
  state.counters["over_a_step"] = of_snapshots / static_cast<double>(state.iterations()) /
                                  (of_steps / static_cast<double>(steps));
}

/// ball_on_cube with the cube as a mesh of about 6 n^2 vertices.
void step_of_mesh(benchmark::State& state) {
  LoadedScene loaded = load_gltf(test::shipped_scene("ball_on_cube"));
  PartDescription& part = loaded.scene->bodies[0].parts[0];
  part = test::make_part(ShapeKind::kBox, part.shape.half_extent, part.shape.pose, true,
                         static_cast<std::uint32_t>(state.range(0)));
  const auto start = SteadyClock::now();
  Result<Simulation> simulation = prepare(*loaded.scene, papers_models());
  if (!simulation) {
    state.SkipWithError(simulation.error().text.c_str());
    return;
  }
  state.counters["prepare_s"] = seconds_since(start);
  state.counters["vertices"] = static_cast<double>(part.surface.positions.size());
  Session session{std::move(*loaded.scene), std::move(simulation).value(), {}};
  session.tool_poses.resize(1);
  time_contact(state, session);
}

/// Writes a scene of a body of about 100 000 triangles and a ball.
std::string write_large_scene(const std::filesystem::path& folder) {
  const auto written = [](const std::string& name, const PartDescription& part) {
    WrittenMesh mesh;
    mesh.name = name;
    for (const glm::dvec3& position : part.surface.positions) {
      mesh.positions.emplace_back(position);
      mesh.normals.emplace_back(glm::normalize(position));
    }
    mesh.triangles = part.surface.triangles;
    return mesh;
  };
  WrittenMesh body =
      written("body", test::make_part(ShapeKind::kEllipsoid, {0.07, 0.05, 0.06}, {}, true, 46));
  WrittenMesh ball =
      written("ball", test::make_part(ShapeKind::kSphere, glm::dvec3(0.03), {}, true, 8));
  ball.pose.position.y = 0.09;
  auto json = nlohmann::json::parse(gltf_bytes({body, ball}, false).value());
  json["nodes"][0]["extras"]["torsion_role"] = "elastic";
  json["nodes"][1]["extras"] = {
      {"torsion_role", "tool"}, {"torsion_device", "mouse"}, {"torsion_shape", "sphere"}};
  std::string path = (folder / "large.gltf").string();
  std::ofstream(path) << json.dump();
  return path;
}

void load_large_scene(benchmark::State& state, bool cached) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("torsion_bench_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  // NOLINTNEXTLINE(concurrency-mt-unsafe): one thread
  setenv("TORSION_CACHE_DIR", (folder / "cache").c_str(), 1);
  const std::string path = write_large_scene(folder);
  if (cached) {
    static_cast<void>(prepare(*load_gltf(path).scene, papers_models()));
  }
  std::size_t triangles = 0;
  for (auto _ : state) {
    if (!cached) {
      std::filesystem::remove_all(folder / "cache");
    }
    const auto start = SteadyClock::now();
    const LoadedScene loaded = load_gltf(path);
    const Result<Simulation> simulation = prepare(*loaded.scene, papers_models());
    const FrameWorld frame = prepare_frame(*loaded.scene, simulation.value().world.model,
                                           simulation.value().world.state);
    state.SetIterationTime(seconds_since(start));
    triangles = frame.body_triangles.size();
  }
  state.counters["triangles"] = static_cast<double>(triangles);
  unsetenv("TORSION_CACHE_DIR");  // NOLINT(concurrency-mt-unsafe): one thread
  std::filesystem::remove_all(folder);
}

void whole_run(benchmark::State& state) {
  double simulated = 0.0;
  double wall = 0.0;
  for (auto _ : state) {
    Result<Session> session =
        open_session(test::shipped_scene("ball_on_cube"), papers_models(), true);
    Progress silent("", true);
    const double duration = session.value().scene.duration;
    const RunStatistics statistics =
        run_fast(session.value(), steps_in(session.value(), duration), RunFiles{}, silent).value();
    state.SetIterationTime(statistics.wall_time);
    simulated += duration;
    wall += statistics.wall_time;
  }
  state.counters["times_real_time"] = simulated / wall;
}

double least(const std::vector<double>& runs) {
  return *std::ranges::min_element(runs);
}

void in_turns(benchmark::internal::Benchmark* bench) {
  bench->UseManualTime()
      ->Unit(benchmark::kMicrosecond)
      ->Repetitions(5)
      ->ReportAggregatesOnly(true)
      ->ComputeStatistics("least", least);
}

/// A row a benchmark: the median of its runs and, in brackets, the least, of its time and counters.
class Rows : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& /*context*/) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    const Run* median = nullptr;
    const Run* fastest = nullptr;
    for (const Run& run : runs) {
      if (run.error_occurred) {
        std::printf("%s: %s\n", run.benchmark_name().c_str(), run.error_message.c_str());
      }
      median = run.aggregate_name == "median" ? &run : median;
      fastest = run.aggregate_name == "least" ? &run : fastest;
    }
    if (runs.size() == 1 && !runs.front().error_occurred) {  // of one that is not repeated
      median = &runs.front();
      fastest = median;
    }
    if (median == nullptr || fastest == nullptr) {
      return;
    }
    const benchmark::BenchmarkName& name = median->run_name;
    std::printf("%-36s", (name.function_name + (name.args.empty() ? "" : "/" + name.args)).c_str());
    std::printf(" mean %.4g (%.4g) %s", median->GetAdjustedRealTime(),
                fastest->GetAdjustedRealTime(), benchmark::GetTimeUnitString(median->time_unit));
    for (const auto& [counter, value] : median->counters) {
      std::printf("  %s %.4g (%.4g)", counter.c_str(), value.value,
                  fastest->counters.at(counter).value);
    }
    std::printf("\n");
    std::fflush(stdout);
  }
};

BENCHMARK_CAPTURE(step_of_scene, ball_on_cube, "ball_on_cube")->Iterations(20000)->Apply(in_turns);
BENCHMARK_CAPTURE(step_of_scene, many_regions, "many_regions")->Iterations(5000)->Apply(in_turns);
BENCHMARK_CAPTURE(step_of_scene, mallet_on_ellipsoid, "mallet_on_ellipsoid")
    ->Iterations(5000)
    ->Apply(in_turns);
BENCHMARK_CAPTURE(step_of_scene, compass_on_ellipsoid, "compass_on_ellipsoid")
    ->Iterations(5000)
    ->Apply(in_turns);
BENCHMARK_CAPTURE(step_of_scene, ball_on_cube_soft, "ball_on_cube_soft")
    ->Iterations(5000)
    ->Apply(in_turns);
// Cells along a side of the grid. The goal for patch is set for 64 cells in contact: a round one
// has 57 of 11 x 11 (ball_on_cube, pressed and turned at full depth), 70 of 12 x 12 and 128 of 16 x
// 16; ten regions have about 58 each of 12 x 12. `cells` says how many there are at a region.
BENCHMARK_CAPTURE(step_of_model, mdr_ball_on_cube, "ball_on_cube", ContactModel::kMdr, "mdr_")
    ->Arg(12)
    ->Iterations(20000)
    ->Apply(in_turns);
BENCHMARK_CAPTURE(step_of_model, patch_ball_on_cube, "ball_on_cube", ContactModel::kPatch,
                  "patch_forces")
    ->Arg(11)
    ->Arg(12)
    ->Arg(16)
    ->Iterations(20000)
    ->Apply(in_turns);
BENCHMARK_CAPTURE(step_of_model, patch_many_regions, "many_regions", ContactModel::kPatch,
                  "patch_forces")
    ->Arg(12)
    ->Iterations(5000)
    ->Apply(in_turns);
BENCHMARK_CAPTURE(step_of_model, patch_many_regions_compliance, "many_regions",
                  ContactModel::kPatch, "patch_forces", BodyModel::kCompliance)
    ->Arg(12)
    ->Iterations(5000)
    ->Apply(in_turns);
BENCHMARK_CAPTURE(snapshot_of_scene, ball_on_cube_soft, "ball_on_cube_soft")
    ->Iterations(5000)
    ->Apply(in_turns);
BENCHMARK_CAPTURE(snapshot_of_scene, many_regions, "many_regions")
    ->Iterations(5000)
    ->Apply(in_turns);
// 6 (2 n)^2 vertices: 1 k, 10 k, 100 k, 1 M.
BENCHMARK(step_of_mesh)->Arg(6)->Arg(20)->Arg(65)->Arg(204)->Iterations(10000)->Apply(in_turns);
BENCHMARK_CAPTURE(load_large_scene, first, false)
    ->Iterations(1)
    ->Apply(in_turns)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(load_large_scene, cached, true)
    ->Iterations(3)
    ->Apply(in_turns)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(whole_run)->Iterations(3)->Apply(in_turns)->Unit(benchmark::kMillisecond);

/// Once, since it takes the least of three runs itself.
void register_longest_steps() {
  for (const char* const scene :
       {"ball_on_cube", "ball_on_cube_soft", "mallet_on_ellipsoid", "mallet_on_ellipsoid_soft",
        "compass_on_ellipsoid", "compass_on_ellipsoid_soft", "many_regions", "two_bodies"}) {
    benchmark::RegisterBenchmark((std::string("longest_step/") + scene).c_str(),
                                 [scene](benchmark::State& state) { longest_step(state, scene); })
        ->UseManualTime()
        ->Iterations(3)
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace
}  // namespace torsion::engine

int main(int argc, char** argv) {
  torsion::engine::register_longest_steps();
  std::vector<char*> arguments(argv, argv + argc);
  std::string interleave = "--benchmark_enable_random_interleaving=true";
  arguments.insert(arguments.begin() + 1, interleave.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) {
    return 2;
  }
  torsion::engine::Rows rows;
  benchmark::RunSpecifiedBenchmarks(&rows);
  return 0;
}
