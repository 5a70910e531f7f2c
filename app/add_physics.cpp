#include "scenes/add_physics.hpp"

#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/output_file.hpp"
#include "scenes/load_gltf.hpp"

namespace torsion::engine {
namespace {

struct AddPhysicsOptions {
  std::string asset;
  std::string out;
  PhysicsToAdd add;
};

int add_physics(const AddPhysicsOptions& options) {
  const std::string extension = std::filesystem::path(options.out).extension().string();
  if (extension != ".gltf" && extension != ".glb") {
    fmt::print(stderr, "--out {}: expected a .gltf or .glb\n", options.out);
    return kUsage;
  }
  const Result<PhysicsAdded> added = with_physics(options.asset, options.add, extension == ".glb");
  if (!added) {
    return fail(added.error().text);
  }
  const FileText file{options.out, added.value().bytes};
  if (const Result<Done> done = write_files({&file, 1}); !done) {
    return fail(done.error().text);
  }
  fmt::print("{}\n", options.out);
  for (const std::string& line : added.value().assumed) {
    fmt::print("  {}\n", line);
  }
  const LoadedScene loaded = load_gltf(options.out);
  if (!loaded.scene) {
    return fail(
        "it is written, but is no scene yet:\n" + to_text(loaded.problems) +
        "  where the mesh is the matter: --shape box, ellipsoid, ... takes an exact shape of "
        "its size");
  }
  fmt::print("next: torsion check {0}; torsion view {0}\n", options.out);
  return kDone;
}

}  // namespace

void add_add_physics(CLI::App& app, Command& command) {
  CLI::App* subcommand =
      app.add_subcommand("add-physics", "Make a scene of somebody's glTF; say what was assumed");
  auto options = std::make_shared<AddPhysicsOptions>();
  subcommand->add_option("ASSET", options->asset, "A .gltf or .glb")->required();
  subcommand
      ->add_option("--out", options->out, "The scene, a .gltf or .glb with its buffers inside")
      ->required();
  subcommand->add_option("--body", options->add.body,
                         "Node that is elastic; else the only one with a mesh");
  subcommand->add_option("--tool", options->add.tool,
                         "Node that is the tool; else a ball is added above the body");
  subcommand
      ->add_option("--shape", options->add.shape,
                   "An exact shape of the body's size in place of its mesh")
      ->check(CLI::IsMember({"box", "sphere", "ellipsoid", "cylinder", "capsule"}));
  subcommand->callback([options, &command] {
    command = [options] {
      return add_physics(*options);
    };
  });
}

}  // namespace torsion::engine
