#include "app/report/csv_report.hpp"

#include <fmt/format.h>

#include "ecs/model_names.hpp"

namespace torsion::engine {
namespace {

std::string field_of(const std::optional<double>& error) {
  return error ? fmt::format("{:.6g}", *error) : std::string();
}

}  // namespace

std::string csv_text(std::span<const MeasuredCase> cases) {
  std::string text =
      "scene,contact_model,body_model,cells,anchors,step_us_median,step_us_p99,force_error,"
      "torque_error,twist_error,memory_bytes\n";
  for (const MeasuredCase& measured : cases) {
    for (const MeasuredRun& one : measured.runs) {
      text += fmt::format(
          "{},{},{},{},{},{:.4g},{:.4g},{},{},{},{}\n", measured.reference_case.name,
          name_of(one.run.models.contact), name_of(one.run.models.body), one.run.cells,
          one.run.anchors, one.run.step_us_median, one.run.step_us_p99, field_of(one.errors.force),
          field_of(one.errors.torque), field_of(one.errors.twist), one.run.memory_bytes);
    }
  }
  return text;
}

}  // namespace torsion::engine
