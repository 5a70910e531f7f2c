#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>
#include <vector>

#include "ecs/column_set.hpp"

namespace torsion::engine {

/// One system of a schedule. `run` is a free function over the tables that Context reaches.
template <class Context>
struct System {
  std::string_view name;
  std::string_view purpose;                  // one line for `torsion check`
  std::string_view needs;                    // what a scene must have for it, in words
  bool (*needed)(const Context&) = nullptr;  // nullptr: always
  void (*run)(Context&) = nullptr;
  ColumnSet writes = {};   // columns of State of which it finds what they hold in this step
  ColumnSet carries = {};  // columns whose last step's values it brings over to this one's rows

  /// All that it may change.
  [[nodiscard]] constexpr ColumnSet declared() const { return writes | carries; }
};

/// Runs systems in the order given, and times each. What no entity needs is
/// left out at construction: it costs nothing, and `is_on` says so.
template <class Context>
class Schedule {
 public:
  struct Timing {
    std::uint64_t runs = 0;
    double total_s = 0.0;
    double longest_s = 0.0;
  };
  struct Row {
    System<Context> system;
    bool on = true;
    Timing timing;
  };

  Schedule() = default;

  /// Decides once, from the tables as loaded, which systems run. Load time only.
  Schedule(std::vector<System<Context>> systems, const Context& context) {
    rows_.reserve(systems.size());
    for (const System<Context>& system : systems) {
      rows_.push_back({system, system.needed == nullptr || system.needed(context), Timing{}});
    }
  }

  /// One step: every system that is on, in order. Allocates nothing.
  void run(Context& context) {
    run_each([&context](const System<Context>& system) { system.run(context); });
  }

  /// The same, each by run_system(system).
  template <class RunSystem>
  void run_each(const RunSystem& run_system) {
    auto start = std::chrono::steady_clock::now();
    for (Row& row : rows_) {
      if (!row.on) {
        continue;
      }
      run_system(row.system);
      const auto end = std::chrono::steady_clock::now();
      const double elapsed = std::chrono::duration<double>(end - start).count();
      start = end;
      row.timing.runs += 1;
      row.timing.total_s += elapsed;
      row.timing.longest_s = elapsed > row.timing.longest_s ? elapsed : row.timing.longest_s;
    }
  }

  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }

  [[nodiscard]] bool is_on(std::string_view name) const {
    for (const Row& row : rows_) {
      if (row.system.name == name) {
        return row.on;
      }
    }
    return false;
  }

 private:
  std::vector<Row> rows_;
};

}  // namespace torsion::engine
