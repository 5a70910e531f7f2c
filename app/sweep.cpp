#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/live/interrupt.hpp"
#include "app/output_file.hpp"
#include "app/progress.hpp"
#include "app/session.hpp"
#include "app/sweep/partial_table.hpp"
#include "app/sweep/study.hpp"
#include "app/sweep/study_table.hpp"
#include "device/scripted_motion.hpp"
#include "ecs/hash.hpp"

namespace torsion::engine {
namespace {

struct SweepOptions {
  SceneOptions scene;
  std::string out;
  std::string columns;
  double seconds = -1.0;   // s; negative: to the end of the longest animation
  std::uint32_t jobs = 0;  // 0: as many as there are cores
  bool quiet = false;
};

Result<Study> read_study(const SweepOptions& options) {
  Study study;
  for (const std::string& setting : options.scene.settings) {
    Result<Axis> axis = read_axis(setting);
    if (!axis) {
      return axis.error();
    }
    if (std::ranges::find(study.axes, axis.value().name, &Axis::name) != study.axes.end()) {
      return Error{"--set " + setting + ": " + axis.value().name +
                   " is set twice; say all of its values at once"};
    }
    study.axes.push_back(std::move(axis).value());
  }
  Result<std::vector<WantedColumn>> wanted = read_wanted_columns(options.columns);
  if (!wanted) {
    return wanted.error();
  }
  study.wanted = std::move(wanted).value();
  if (study.runs() > kMostRuns) {
    return Error{fmt::format("--set: these are more than {} runs; take fewer values", kMostRuns)};
  }
  Result<Session> opened = open_scene(options.scene.scene);
  if (!opened) {
    return opened.error();
  }
  const SceneDescription& scene = opened.value().scene;
  study.seconds = options.seconds < 0.0 ? scene.duration : options.seconds;
  if (study.seconds <= 0.0) {
    return Error{scene.path +
                 ": no animation moves a tool, so there is no end to run to; say --seconds"};
  }
  PrepareOptions prepare_options = options.scene.prepare_options();
  prepare_options.threads = 1;  // runs are what is done at the same time
  prepare_options.expected_poses = expected_poses(scene);
  study.variants =
      std::make_unique<SceneVariants>(std::move(opened).value().scene, prepare_options);
  return study;
}

/// Of everything that a line of the table depends on: the program, the scene as the file has it,
/// prepared, and the study's own words.
Result<std::string> identity_of(const Study& study) {
  const Result<SceneVariant> first = study.variants->make({});
  if (!first) {
    return first.error();
  }
  std::string identity = fmt::format("torsion {} sweep {:016x} {} s", TORSION_VERSION,
                                     hash(first.value().simulation.world), study.seconds);
  for (const Axis& axis : study.axes) {
    identity += " " + axis.name + "=";
    for (const std::string& value : axis.values) {
      identity += value + ",";
    }
  }
  for (const WantedColumn& column : study.wanted) {
    identity += " " + column.name;
  }
  return identity;
}

/// What the threads of a sweep share.
struct Work {
  const Study& study;
  PartialTable& table;
  std::mutex mutex{};     // of `table` and `problem`
  std::string problem{};  // the first; empty: none
  std::atomic<std::uint64_t> next{0};
  std::atomic<std::uint64_t> done{0};
  std::atomic<bool> stop{false};
};

void run_some(Work& work) {
  const std::uint64_t runs = work.study.runs();
  while (!work.stop) {
    const std::uint64_t run = work.next++;
    if (run >= runs) {
      return;
    }
    {
      const std::lock_guard lock(work.mutex);
      if (work.table.has(run)) {
        ++work.done;
        continue;
      }
    }
    const Result<std::string> line = run_one(work.study, run);
    const std::lock_guard lock(work.mutex);
    const Result<Done> added = line ? work.table.add(run, line.value()) : line.error();
    if (!added) {
      work.problem = work.problem.empty() ? added.error().text : work.problem;
      work.stop = true;
      return;
    }
    ++work.done;
  }
}

/// @return what stopped it; empty when all runs are done
std::string run_all(const Study& study, const SweepOptions& options, PartialTable& table) {
  const Interrupt interrupt;
  Work work{study, table};
  std::vector<std::thread> threads;
  const std::uint32_t jobs =
      options.jobs > 0 ? options.jobs : std::max(1U, std::thread::hardware_concurrency());
  for (std::uint32_t job = 0; job < jobs; ++job) {
    threads.emplace_back(run_some, std::ref(work));
  }
  {
    Progress progress("running", options.quiet);
    while (!work.stop && work.done < study.runs()) {
      progress.show(static_cast<double>(work.done) / static_cast<double>(study.runs()));
      work.stop = work.stop || interrupt.within(20);
    }
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  if (!work.problem.empty() || work.done == study.runs()) {
    return work.problem;
  }
  return fmt::format("stopped after {} of {} runs; the same command goes on ({})", work.done.load(),
                     study.runs(), table.path().string());
}

int sweep(const SweepOptions& options) {
  const Result<Study> study = read_study(options);
  if (!study) {
    return fail(study.error().text);
  }
  const Result<Done> folder = make_parent_folder(options.out);
  if (!folder) {
    return fail(folder.error().text);
  }
  if (const Result<OutputFile> tried = OutputFile::create(options.out); !tried) {
    return fail(tried.error().text);
  }
  const Result<std::string> identity = identity_of(study.value());
  if (!identity) {
    return fail(identity.error().text);
  }
  Result<PartialTable> table = PartialTable::open(options.out, identity.value());
  if (!table) {
    return fail(table.error().text);
  }
  const std::size_t before = table.value().lines().size();
  const auto start = std::chrono::steady_clock::now();
  const std::string stopped = run_all(study.value(), options, table.value());
  if (!stopped.empty()) {
    return fail(stopped);
  }
  if (const Result<Done> done =
          write_study_table(options.out, study.value().header(), table.value().lines());
      !done) {
    return fail(done.error().text);
  }
  table.value().remove();
  if (!options.quiet) {
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double steps = static_cast<double>(study.value().runs() - before) *
                         study.value().seconds * options.scene.rate;
    fmt::print("{}: {} runs of {:.4g} s, {} of them found done, in {:.1f} s; {:.3g} steps/s\n",
               options.out, study.value().runs(), study.value().seconds, before, seconds,
               steps / seconds);
  }
  return kDone;
}

}  // namespace

void add_sweep(CLI::App& app, Command& command) {
  CLI::App* subcommand = app.add_subcommand(
      "sweep", "Run a scene once for every combination of values; write what each comes to");
  auto options = std::make_shared<SweepOptions>();
  options->scene.add_to(*subcommand);
  options->scene.add_settings_to(*subcommand)
      ->required()
      ->description("NODE.KEY=VALUES, several: a,b,c or FIRST:LAST:COUNT or FIRST:LAST:COUNTlog");
  subcommand->add_option("--out", options->out, "CSV or HDF5 (.h5) file to write, one row a run")
      ->required();
  subcommand->add_option("--columns", options->columns,
                         "More of each run: first, last, min, max or mean of a trace's column, as "
                         "max:couple_y_Nm, with commas between");
  subcommand->add_option("--seconds", options->seconds, "How long; else the animation's length")
      ->check(CLI::Range(0.0, 1e6));
  subcommand->add_option("--jobs", options->jobs, "Runs at the same time; else one a core")
      ->check(CLI::Range(1U, 1024U));
  subcommand->add_flag("--quiet", options->quiet, "Print nothing but errors");
  subcommand->callback([options, &command] {
    command = [options] {
      return sweep(*options);
    };
  });
}

}  // namespace torsion::engine
