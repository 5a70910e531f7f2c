#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "systems/step.hpp"

namespace torsion::engine {

/// What a subcommand does once its options are read; returns the program's exit code.
using Command = std::function<int()>;

inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;  // bad input, or a run that failed
inline constexpr int kUsage = 2;

/// Each adds one subcommand to `app` and sets `command` when that subcommand was given.
void add_simulate(CLI::App& app, Command& command);
void add_render(CLI::App& app, Command& command);
void add_view(CLI::App& app, Command& command);
void add_export(CLI::App& app, Command& command);
void add_check(CLI::App& app, Command& command);
void add_add_physics(CLI::App& app, Command& command);
void add_new(CLI::App& app, Command& command);
void add_sweep(CLI::App& app, Command& command);
void add_fit(CLI::App& app, Command& command);
void add_devices(CLI::App& app, Command& command);

/// The scene's path and what may be chosen over what it says.
struct SceneOptions {
  std::string scene;
  std::string contact_model = "auto";
  std::string body_model = "auto";
  double rate = 1000.0;          // Hz
  std::uint32_t cells = 0;       // in a round contact; 0: as the models need
  std::uint32_t iterations = 2;  // of contact model patch over its cells in a step

  std::vector<std::string> settings;  // of --set, in their order

  /// @param scene_required  else an empty `scene` stands for none
  void add_to(CLI::App& subcommand, bool scene_required = true);
  /// --set, for commands that prepare a scene once.
  CLI::Option* add_settings_to(CLI::App& subcommand);
  [[nodiscard]] PrepareOptions prepare_options() const;
};

/// Says `text` on stderr and returns kFailed.
int fail(const std::string& text);

}  // namespace torsion::engine
