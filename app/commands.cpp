#include "app/commands.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/scene_settings.hpp"
#include "ecs/model_names.hpp"

namespace torsion::engine {
namespace {

constexpr std::uint32_t kFewestCells = 16;
constexpr std::uint32_t kMostCells = 2500;

/// Takes the models that this version has and names them where another is asked for.
CLI::Validator model_among(std::span<const std::string_view> names) {
  return {[names](const std::string& name) -> std::string {
            return std::ranges::find(names, name) != names.end()
                       ? ""
                       : fmt::format("this version has no model \"{}\"; it has {}", name,
                                     fmt::join(names, ", "));
          },
          fmt::format("{}", fmt::join(names, "|"))};
}

/// Cells along the side of a grid that has a border of a cell and a half around a round contact of
/// `cells` cells.
std::uint32_t grid_side_for(std::uint32_t cells) {
  const double across = std::sqrt(4.0 * cells / std::numbers::pi);
  return cells == 0 ? 0 : static_cast<std::uint32_t>(std::ceil(across)) + 3U;
}

}  // namespace

void SceneOptions::add_to(CLI::App& subcommand, bool scene_required) {
  subcommand.add_option("SCENE", scene, "A .gltf or .glb by the conventions of docs/scenes.md")
      ->required(scene_required);
  subcommand.add_option("--contact-model", contact_model, "How a contact gives force and torque")
      ->check(model_among(kContactModelNames));
  subcommand.add_option("--body-model", body_model, "How a body deforms away from the contact")
      ->check(model_among(kBodyModelNames));
  subcommand.add_option("--rate", rate, "Steps a second (Hz), 1000 unless said")
      ->check(CLI::Range(1.0, 1e6));
  subcommand
      .add_option("--cells", cells,
                  "Cells of a round contact, 16 to 2500; unless said as the models need")
      ->check(CLI::Range(kFewestCells, kMostCells));
  subcommand
      .add_option(
          "--iterations", iterations,
          "Iterations of contact model patch in a step, at most; 2 unless said, friction's 8")
      ->check(CLI::Range(1U, kMostIterations));
}

CLI::Option* SceneOptions::add_settings_to(CLI::App& subcommand) {
  return subcommand
      .add_option("--set", settings,
                  "NODE.KEY=VALUE: a value over what the scene says, as cube.youngs_modulus=2e4")
      ->check(CLI::Validator(setting_form_problem, "NODE.KEY=VALUE"))
      ->take_all()
      ->expected(1);
}

PrepareOptions SceneOptions::prepare_options() const {
  PrepareOptions options;
  options.rate = rate;
  options.contact_model = contact_model_named(contact_model).value_or(ContactModel::kAuto);
  options.body_model = body_model_named(body_model).value_or(BodyModel::kAuto);
  options.settings = {grid_side_for(cells), iterations};
  return options;
}

int fail(const std::string& text) {
  fmt::print(stderr, "{}{}", text, text.empty() || text.back() != '\n' ? "\n" : "");
  return kFailed;
}

}  // namespace torsion::engine
