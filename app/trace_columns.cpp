#include "app/trace_columns.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/split_text.hpp"
#include "scenes/extras.hpp"
#include "systems/math/wrenches.hpp"

namespace torsion::engine {
namespace {

#define TORSION_TRACE_COLUMN(name, value, usual)                                            \
  TraceColumn {                                                                             \
    name,                                                                                   \
        []([[maybe_unused]] const TraceRow& row, [[maybe_unused]] const WorkByKind& work) { \
          return static_cast<double>(value);                                                \
        },                                                                                  \
        usual                                                                               \
  }
#define TORSION_USUAL(name, value) TORSION_TRACE_COLUMN(name, value, true)
#define TORSION_COLUMN(name, value) TORSION_TRACE_COLUMN(name, value, false)
#define TORSION_VECTOR(prefix, unit, vector)                                                    \
  TORSION_COLUMN(prefix "_x_" unit, (vector).x), TORSION_COLUMN(prefix "_y_" unit, (vector).y), \
      TORSION_COLUMN(prefix "_z_" unit, (vector).z)

double stick_fraction(const TraceRow& row) {
  return row.cells == 0 ? 0.0
                        : static_cast<double>(row.stuck_cells) / static_cast<double>(row.cells);
}

constexpr TraceColumn kTraceColumns[] = {
    TORSION_USUAL("tool_x_m", row.pose.position.x),
    TORSION_USUAL("tool_y_m", row.pose.position.y),
    TORSION_USUAL("tool_z_m", row.pose.position.z),
    TORSION_USUAL("tool_qx", row.pose.rotation.x),
    TORSION_USUAL("tool_qy", row.pose.rotation.y),
    TORSION_USUAL("tool_qz", row.pose.rotation.z),
    TORSION_USUAL("tool_qw", row.pose.rotation.w),
    TORSION_USUAL("regions", row.load.regions),
    TORSION_USUAL("cells", row.cells),
    TORSION_USUAL("force_x_N", row.wrench.force.x),
    TORSION_USUAL("force_y_N", row.wrench.force.y),
    TORSION_USUAL("force_z_N", row.wrench.force.z),
    TORSION_USUAL("torque_x_Nm", row.wrench.torque.x),
    TORSION_USUAL("torque_y_Nm", row.wrench.torque.y),
    TORSION_USUAL("torque_z_Nm", row.wrench.torque.z),
    TORSION_USUAL("stick_fraction", stick_fraction(row)),
    TORSION_USUAL("energy_J", row.work),
    TORSION_COLUMN("depth_m", row.depth),
    TORSION_COLUMN("turn_rad", row.turn),
    TORSION_COLUMN("twist_rad", row.twist),
    TORSION_COLUMN("normal_force_N", row.load.normal_sum),
    TORSION_VECTOR("normal_force", "N", row.load.normal.force),
    TORSION_VECTOR("friction", "N", row.load.friction.force),
    TORSION_VECTOR("couple", "Nm", row.load.couple),
    TORSION_VECTOR("lever_torque", "Nm", row.load.normal.torque + row.load.friction.torque),
    TORSION_COLUMN("work_normal_J", work.normal),
    TORSION_COLUMN("work_friction_J", work.friction),
    TORSION_COLUMN("work_couple_J", work.couple),
    TORSION_COLUMN("faults", row.faults),
};
#undef TORSION_VECTOR
#undef TORSION_USUAL
#undef TORSION_COLUMN
#undef TORSION_TRACE_COLUMN

}  // namespace

void WorkByKind::add(const TraceRow& before, const TraceRow& now) {
  const double dt = now.time - before.time;
  const auto of = [&](const Wrench& wrench) {
    return -dt *
           (glm::dot(wrench.force, now.velocity) + glm::dot(wrench.torque, now.angular_velocity));
  };
  normal += of((before.load.normal + now.load.normal) * 0.5);
  friction += of((before.load.friction + now.load.friction) * 0.5);
  couple += of(Wrench{glm::dvec3(0.0), 0.5 * (before.load.couple + now.load.couple)});
}

std::span<const TraceColumn> trace_columns() {
  return kTraceColumns;
}

std::vector<TraceColumn> usual_trace_columns() {
  std::vector<TraceColumn> columns;
  std::ranges::copy_if(kTraceColumns, std::back_inserter(columns), &TraceColumn::usual);
  return columns;
}

Result<std::vector<TraceColumn>> read_trace_columns(const std::string& names) {
  std::vector<TraceColumn> columns;
  for (const std::string& name : split_text(names, ',')) {
    const auto* const found = std::ranges::find(kTraceColumns, name, &TraceColumn::name);
    if (name == "all") {
      columns.assign(std::begin(kTraceColumns), std::end(kTraceColumns));
    } else if (name == "usual") {
      std::ranges::copy(usual_trace_columns(), std::back_inserter(columns));
    } else if (found == std::end(kTraceColumns)) {
      std::vector<std::string_view> known = {"all", "usual"};
      std::ranges::transform(kTraceColumns, std::back_inserter(known), &TraceColumn::name);
      const auto meant = did_you_mean(name, known);
      return Error{fmt::format("there is no column \"{}\"{}; there are {}", name,
                               meant ? ", did you mean \"" + *meant + "\"?" : "",
                               fmt::join(known, ", "))};
    } else {
      columns.push_back(*found);
    }
  }
  for (std::size_t k = 1; k < columns.size(); ++k) {
    const auto end = columns.begin() + static_cast<std::ptrdiff_t>(k);
    if (std::find_if(columns.begin(), end, [&](const TraceColumn& before) {
          return before.name == columns[k].name;
        }) != end) {
      return Error{fmt::format("column \"{}\" is named twice", columns[k].name)};
    }
  }
  return columns;
}

}  // namespace torsion::engine
