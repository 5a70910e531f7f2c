#include "app/commands.hpp"

#include <fmt/format.h>

namespace torsion {

void SceneOptions::add_to(CLI::App& subcommand) {
  subcommand.add_option("SCENE", scene, "A .gltf or .glb by the conventions of docs/scenes.md")
      ->required();
  subcommand.add_option("--contact-model", contact_model, "auto or paper")
      ->check(CLI::IsMember({"auto", "paper"}));
  subcommand.add_option("--body-model", body_model, "auto, none or skeleton")
      ->check(CLI::IsMember({"auto", "none", "skeleton"}));
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
