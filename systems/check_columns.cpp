#include "systems/check_columns.hpp"

#include <cstdio>
#include <cstdlib>

#include "ecs/hash.hpp"

namespace torsion::engine {
namespace {

[[noreturn]] void stop_for(const System<StepContext>& system, ColumnSet undeclared) {
  for (std::size_t column = 0; column < kStateColumns; ++column) {
    if (undeclared.has(column)) {
      std::fprintf(stderr, "system %.*s changes column %.*s, which it does not declare\n",
                   static_cast<int>(system.name.size()), system.name.data(),
                   static_cast<int>(kColumnNames[column].size()), kColumnNames[column].data());
    }
  }
  std::abort();
}

}  // namespace

void run_with_checks(Schedule<StepContext>& schedule, StepContext& context) {
  const std::size_t checked = context.state.clock.step % schedule.rows().size();
  schedule.run_each([&](const System<StepContext>& system) {
    if (system.name != schedule.rows()[checked].system.name) {
      system.run(context);
      return;
    }
    const ColumnHashes before = hash_columns(context.state);
    system.run(context);
    const ColumnSet changed = differing(before, hash_columns(context.state));
    if (const ColumnSet undeclared = changed - system.declared(); !undeclared.empty()) {
      stop_for(system, undeclared);
    }
  });
}

}  // namespace torsion::engine
