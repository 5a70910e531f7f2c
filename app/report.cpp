#include "app/report.hpp"

#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "app/output_file.hpp"
#include "app/progress.hpp"
#include "app/report/csv_report.hpp"
#include "app/report/element_cases.hpp"
#include "app/report/exact_cases.hpp"
#include "systems/fault.hpp"

namespace torsion {
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

Result<Done> write_file(const std::filesystem::path& path, const std::string& text) {
  Result<OutputFile> file = OutputFile::create(path);
  if (!file) {
    return file.error();
  }
  file.value().write(text);
  return file.value().commit();
}

int report(const ReportOptions& options) {
  const std::filesystem::path folder(options.out);
  const std::filesystem::path csv = folder / "report.csv";
  const Result<Done> made = make_parent_folder(csv);
  if (!made) {
    return fail(made.error().text);
  }
  const Result<std::vector<MeasuredCase>> cases = run_all(options);
  if (!cases) {
    return fail(cases.error().text);
  }
  const Result<Done> written = write_file(csv, csv_text(cases.value()));
  if (!written) {
    return fail(written.error().text);
  }
  if (!options.quiet) {
    fmt::print("{}\n", csv.string());
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

}  // namespace torsion
