#include "app/report.hpp"

#include <array>
#include <filesystem>
#include <memory>
#include <span>

#include <fmt/format.h>

#include "app/output_file.hpp"
#include "app/progress.hpp"
#include "app/report/csv_report.hpp"
#include "app/report/element_cases.hpp"
#include "app/report/exact_cases.hpp"
#include "app/report/gnuplot.hpp"
#include "app/report/html_report.hpp"
#ifdef TORSION_WITH_RENDER
#include "app/report/scene_picture.hpp"
#include "app/run_page/run_page.hpp"
#endif

namespace torsion::engine {
namespace {

struct ReportOptions {
  std::string out;
  bool quick = false;
  bool quiet = false;
};

Result<std::vector<MeasuredCase>> run_all(const ReportOptions& options) {
  std::vector<MeasuredCase> cases;
  std::size_t runs = 0;
  for (const auto& some_cases : {exact_cases, element_cases}) {
    for (ReferenceCase& reference_case : some_cases(options.quick)) {
      runs += model_pairs(reference_case, options.quick).size();
      cases.push_back({std::move(reference_case), {}});
    }
  }
  Progress progress("measuring", options.quiet);
  std::size_t done = 0;
  for (MeasuredCase& measured : cases) {
    for (const ModelPair& models : model_pairs(measured.reference_case, options.quick)) {
      Result<CaseRun> run = run_case(measured.reference_case, models);
      if (!run) {
        return Error{measured.reference_case.name + ": " + run.error().text};
      }
      const CaseErrors errors = errors_of(measured.reference_case, run.value());
      measured.runs.push_back({std::move(run).value(), errors});
      progress.show(static_cast<double>(++done) / static_cast<double>(runs));
    }
  }
  return cases;
}

/// What is seen of each case; nothing where this machine cannot draw, which it says once.
ReportViews draw_views(std::span<const MeasuredCase> cases, bool quiet) {
  ReportViews views;
  views.pictures.resize(cases.size());
  views.runs.resize(cases.size());
#ifdef TORSION_WITH_RENDER
  Progress progress("drawing", quiet);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Result<std::string> picture = scene_picture(cases[i].reference_case);
    Result<std::string> run =
        picture ? scene_run(cases[i].reference_case) : Result<std::string>(picture.error());
    if (!run) {
      fmt::print(stderr, "no pictures of the scenes: {}\n", run.error().text);
      break;
    }
    views.pictures[i] = std::move(picture).value();
    views.runs[i] = std::move(run).value();
    progress.show(static_cast<double>(i + 1) / static_cast<double>(cases.size()));
  }
  const bool any = !views.runs.empty() && !views.runs.front().empty();
  views.run_parts = any ? run_page_parts() : std::string();
#else
  static_cast<void>(quiet);
#endif
  return views;
}

int report(const ReportOptions& options) {
  if (options.out.empty()) {
    fmt::print(stderr, "--out \"\": expected a folder; . is the one that you are in\n");
    return kUsage;
  }
  const std::filesystem::path folder(options.out);
  const std::array paths = {folder / "report.csv", folder / "report.html"};
  // Measuring takes minutes: what would fail after it is tried before.
  if (const Result<Done> plots = try_gnuplot(); !plots) {
    return fail(plots.error().text);
  }
  if (const Result<Done> tried = try_files(paths); !tried) {
    return fail(tried.error().text);
  }
  const Result<std::vector<MeasuredCase>> cases = run_all(options);
  if (!cases) {
    return fail(cases.error().text);
  }
  const Machine machine = this_machine();
  const ReportViews views = draw_views(cases.value(), options.quiet);
  const Result<std::string> html = html_text(cases.value(), views, machine);
  if (!html) {
    return fail(html.error().text);
  }
  const Result<Done> written = write_files(
      std::array{FileText{paths[0], csv_text(cases.value())}, FileText{paths[1], html.value()}});
  if (!written) {
    return fail(written.error().text);
  }
  if (!options.quiet) {
    fmt::print("{}\n{}\n", paths[0].string(), paths[1].string());
  }
  return kDone;
}

}  // namespace

void add_report(CLI::App& app, Command& command) {
  CLI::App* subcommand =
      app.add_subcommand("report", "Measure speed and error of all models on reference cases");
  auto options = std::make_shared<ReportOptions>();
  subcommand->add_option("--out", options->out, "Folder for report.csv and report.html")
      ->required();
  subcommand->add_flag("--quick", options->quick, "Fewer steps and grids: under a minute");
  subcommand->add_flag("--quiet", options->quiet, "Print nothing but errors");
  subcommand->callback([options, &command] {
    command = [options] {
      return report(*options);
    };
  });
}

}  // namespace torsion::engine
