#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/commands.hpp"
#include "app/output_file.hpp"
#include "app/shipped_scenes.hpp"

namespace torsion::engine {
namespace {

namespace fs = std::filesystem;

struct NewOptions {
  std::string name;
  std::string from = "ball";
};

std::vector<std::string> template_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code missing;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, missing)) {
    if (entry.path().extension() == ".gltf") {
      names.push_back(entry.path().stem().string());
    }
  }
  std::ranges::sort(names);
  return names;
}

int new_scene(const NewOptions& options) {
  const fs::path folder = shipped_scenes() / "templates";
  const std::vector<std::string> names = template_names(folder);
  if (std::ranges::find(names, options.from) == names.end()) {
    fmt::print(
        stderr, "--from {}: there is no such scene to begin from; there are {}\n", options.from,
        names.empty() ? "none beside the program" : fmt::format("{}", fmt::join(names, ", ")));
    return kUsage;
  }
  fs::path path = options.name;
  if (path.extension() != ".gltf") {
    path += ".gltf";
  }
  std::error_code missing;
  if (fs::exists(path, missing)) {
    return fail(path.string() + " is there already: take another name, or move it away");
  }
  std::ostringstream text;
  text << std::ifstream(folder / (options.from + ".gltf"), std::ios::binary).rdbuf();
  const FileText file{path, text.str()};
  if (const Result<Done> done = write_files({&file, 1}); !done) {
    return fail(done.error().text);
  }
  fmt::print(
      "{0}\n"
      "  a scene of shapes without meshes, with a word on each node (\"comment\"); change sizes "
      "and\n"
      "  torsion_ keys in any editor, or open it in Blender; what the keys mean is in "
      "docs/scenes.md\n"
      "next: torsion view {0} and keep it open: it follows the file; torsion check {0}\n",
      path.string());
  return kDone;
}

}  // namespace

void add_new(CLI::App& app, Command& command) {
  CLI::App* subcommand = app.add_subcommand("new", "Write a scene to begin from");
  auto options = std::make_shared<NewOptions>();
  subcommand->add_option("NAME", options->name, "Of the scene, NAME.gltf")->required();
  subcommand->add_option("--from", options->from,
                         "ball, disc, drill, fingertip or screwdriver; ball unless said");
  subcommand->callback([options, &command] {
    command = [options] {
      return new_scene(*options);
    };
  });
}

}  // namespace torsion::engine
