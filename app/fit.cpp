#include <chrono>
#include <memory>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.hpp"
#include "app/fit/fit_output.hpp"
#include "app/live/interrupt.hpp"
#include "app/output_file.hpp"
#include "app/report/gnuplot.hpp"
#include "app/scene_settings.hpp"
#include "app/session.hpp"

namespace torsion::engine {
namespace {

constexpr double kMostFitSteps = 2e7;  // of a run: hours of measurement at 1 kHz

struct FitOptions {
  SceneOptions scene;
  std::string measured;
  std::vector<std::string> free;
  std::vector<std::string> columns;
  std::vector<double> torque_about;
  std::string page;
  std::string table;
  std::uint32_t jobs = 0;  // 0: as many as there are cores
  bool json = false;
  bool quiet = false;
};

Result<FitProblem> read_problem(const FitOptions& options) {
  std::vector<ColumnSource> sources;
  for (const std::string& text : options.columns) {
    Result<ColumnSource> source = read_column_source(text);
    if (!source) {
      return source.error();
    }
    sources.push_back(std::move(source).value());
  }
  Result<Session> opened = open_scene(options.scene.scene);
  if (!opened) {
    return opened.error();
  }
  SceneDescription& scene = opened.value().scene;
  if (const Result<Done> set = apply_settings(options.scene.settings, scene); !set) {
    return set.error();
  }
  Result<std::vector<FreeParameter>> parameters = read_parameters(options.free, scene);
  if (!parameters) {
    return parameters.error();
  }
  const Result<MeasuredTable> table = read_measured_table(options.measured);
  if (!table) {
    return table.error();
  }
  Result<Measurement> measured = read_measurement(table.value(), scene, sources);
  if (!measured) {
    return measured.error();
  }
  Measurement& measurement = measured.value();
  if (!options.torque_about.empty()) {
    measurement.torque_about = {options.torque_about[0], options.torque_about[1],
                                options.torque_about[2]};
  }
  const double seconds = measurement.times.back() - measurement.times.front();
  if (seconds * options.scene.rate > kMostFitSteps) {
    return Error{
        fmt::format("{}: time_s goes over {:.6g} s, more than {:.0f} steps; is it in s? --column "
                    "time_s=NAME*1e-3 changes its unit",
                    options.measured, seconds, kMostFitSteps)};
  }
  Result<FitProblem> problem =
      make_fit_problem(std::move(scene), options.scene.prepare_options(), std::move(measurement),
                       std::move(parameters).value());
  if (problem) {
    problem.value().jobs =
        options.jobs > 0 ? options.jobs : std::max(1U, std::thread::hardware_concurrency());
  }
  return problem;
}

/// One line on a terminal, written again at each iteration.
class FitTeller {
 public:
  explicit FitTeller(bool quiet) : on_(!quiet && ::isatty(STDERR_FILENO) != 0) {}
  ~FitTeller() {
    if (on_) {
      fmt::print(stderr, "\r\033[K");
    }
  }
  FitTeller(const FitTeller&) = delete;
  FitTeller& operator=(const FitTeller&) = delete;
  FitTeller(FitTeller&&) = delete;
  FitTeller& operator=(FitTeller&&) = delete;
  void tell(std::uint64_t runs) const {
    if (on_) {
      fmt::print(stderr, "\r\033[Kfitting: {} runs", runs);
    }
  }

 private:
  bool on_;
};

/// What is asked for, but for the words to the terminal.
Result<Done> write_results(const FitOptions& options, const FitProblem& problem,
                           const FitResult& result, const FitFacts& facts) {
  std::vector<FileText> files;
  if (!options.table.empty()) {
    files.push_back({options.table, fit_table(problem, result)});
  }
  if (!options.page.empty()) {
    const Result<std::string> page = fit_page(problem, result, facts);
    if (!page) {
      return page.error();
    }
    files.push_back({options.page, page.value()});
  }
  return write_files(files);
}

/// A fit takes minutes: what would fail after it is tried before.
Result<Done> try_results(const FitOptions& options) {
  std::vector<std::filesystem::path> paths;
  for (const std::string& path : {options.table, options.page}) {
    if (!path.empty()) {
      paths.emplace_back(path);
    }
  }
  const Result<Done> plots = options.page.empty() ? Result<Done>(Done{}) : try_gnuplot();
  return plots ? try_files(paths) : plots;
}

int fit(const FitOptions& options) {
  const Interrupt interrupt;
  if (const Result<Done> tried = try_results(options); !tried) {
    return fail(tried.error().text);
  }
  const auto start = std::chrono::steady_clock::now();
  Result<FitProblem> problem = read_problem(options);
  if (!problem) {
    return fail(problem.error().text);
  }
  Result<FitResult> result = [&] {
    const FitTeller teller(options.quiet || options.json);
    return fit_scene(problem.value(), [&](std::uint64_t runs) {
      teller.tell(runs);
      return !interrupt.within(0);
    });
  }();
  if (!result) {
    return fail(result.error().text);
  }
  const FitFacts facts{
      options.measured,
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
  if (const Result<Done> written = write_results(options, problem.value(), result.value(), facts);
      !written) {
    return fail(written.error().text);
  }
  if (options.json) {
    fmt::print("{}", fit_json(problem.value(), result.value(), facts));
  } else if (!options.quiet) {
    fmt::print("{}", fit_text(problem.value(), result.value(), facts));
  }
  return kDone;
}

}  // namespace

void add_fit(CLI::App& app, Command& command) {
  CLI::App* subcommand = app.add_subcommand(
      "fit", "Find values of a scene with which its forces and torques are those measured");
  auto options = std::make_shared<FitOptions>();
  options->scene.add_to(*subcommand);
  subcommand
      ->add_option("MEASURED", options->measured,
                   "CSV file of times, poses, forces and torques, named as in a trace")
      ->required();
  subcommand
      ->add_option("--free", options->free,
                   "NODE.KEY of what is to be found, several with commas between; also "
                   "TOOL.offset_x, offset_y, offset_z: how far measured positions are off")
      ->required()
      ->delimiter(',')
      ->take_all()
      ->expected(1);
  subcommand
      ->add_option("--column", options->columns,
                   "NAME=COLUMN or NAME=COLUMN*FACTOR: the file's column for a trace's, several")
      ->take_all()
      ->expected(1);
  subcommand
      ->add_option("--torque-about", options->torque_about,
                   "X,Y,Z (m, in the tool's frame) of the point that torques are about; else the "
                   "mass centre")
      ->delimiter(',')
      ->expected(3);
  options->scene.add_settings_to(*subcommand);
  subcommand->add_option("--report", options->page, "HTML page to write, with curves");
  subcommand->add_option("--out", options->table,
                         "CSV file to write: measured and fitted, row by row");
  subcommand->add_option("--jobs", options->jobs, "Runs at the same time; else one a core")
      ->check(CLI::Range(1U, 1024U));
  subcommand->add_flag("--json", options->json, "Print the result as JSON");
  subcommand->add_flag("--quiet", options->quiet, "Print nothing but errors");
  subcommand->callback([options, &command] {
    command = [options] {
      return fit(*options);
    };
  });
}

}  // namespace torsion::engine
