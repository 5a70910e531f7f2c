#include <exception>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/report.hpp"
#ifdef TORSION_WITH_RENDER
#include "render/window.hpp"
#endif

namespace {

int run(int argc, const char* const* argv) {
#ifdef TORSION_WITH_RENDER
  // Without a word, where there is a display: the gallery.
  const char* const view[] = {"torsion", "view"};
  if (argc == 1 && torsion::engine::has_display()) {
    return run(2, view);
  }
#endif
  CLI::App app{"Torsion: a rigid tool that presses on and twists a deformable body"};
  app.require_subcommand(1);
  app.set_version_flag("--version", TORSION_VERSION);
  app.footer("Exit codes: 0 done, 1 bad input or a run that failed, 2 wrong usage.");
  torsion::engine::Command command;
  torsion::engine::add_simulate(app, command);
#ifdef TORSION_WITH_RENDER
  torsion::engine::add_render(app, command);
  torsion::engine::add_view(app, command);
#endif
  torsion::engine::add_export(app, command);
  torsion::engine::add_check(app, command);
  torsion::engine::add_new(app, command);
  torsion::engine::add_add_physics(app, command);
  torsion::engine::add_sweep(app, command);
  torsion::engine::add_fit(app, command);
  torsion::engine::add_devices(app, command);
  torsion::engine::add_report(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? torsion::engine::kDone : torsion::engine::kUsage;
  }
  return command();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    // Out of memory and the like: bad input is reported long before.
    fmt::print(stderr, "torsion: {}\n", error.what());
    return torsion::engine::kFailed;
  }
}
