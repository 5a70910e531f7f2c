#pragma once

#include "app/commands.hpp"

namespace torsion::engine {

/// As the functions of app/commands.hpp: the subcommand report.
void add_report(CLI::App& app, Command& command);

}  // namespace torsion::engine
