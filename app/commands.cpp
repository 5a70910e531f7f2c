#include "app/commands.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace torsion {
namespace {

/// Takes the models that this version has and names them where another is asked for.
CLI::Validator model_among(const std::vector<std::string>& names) {
  return {[names](const std::string& name) -> std::string {
            return std::ranges::find(names, name) != names.end()
                       ? ""
                       : fmt::format("this version has no model \"{}\"; it has {}", name,
                                     fmt::join(names, ", "));
          },
          fmt::format("{}", fmt::join(names, "|"))};
}

}  // namespace

void SceneOptions::add_to(CLI::App& subcommand) {
  subcommand.add_option("SCENE", scene, "A .gltf or .glb by the conventions of docs/scenes.md")
      ->required();
  subcommand.add_option("--contact-model", contact_model, "How a contact gives force and torque")
      ->check(model_among({"auto", "paper"}));
  subcommand.add_option("--body-model", body_model, "How a body deforms away from the contact")
      ->check(model_among({"auto", "none", "skeleton"}));
  subcommand.add_option("--rate", rate, "Steps a second (Hz), 1000 unless said")
      ->check(CLI::Range(1.0, 1e6));
}

PrepareOptions SceneOptions::prepare_options() const {
  PrepareOptions options;
  options.rate = rate;
  options.contact_model = contact_model == "paper" ? ContactModel::kPaper : ContactModel::kAuto;
  if (body_model == "none") {
    options.body_model = BodyModel::kNone;
  } else if (body_model == "skeleton") {
    options.body_model = BodyModel::kSkeleton;
  }
  return options;
}

int fail(const std::string& text) {
  fmt::print(stderr, "{}{}", text, text.empty() || text.back() != '\n' ? "\n" : "");
  return kFailed;
}

}  // namespace torsion
