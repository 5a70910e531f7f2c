#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/drawn_detail.hpp"
#include "app/scene_warnings.hpp"
#include "app/session.hpp"
#include "device/scripted_motion.hpp"
#include "ecs/memory.hpp"
#include "ecs/model_names.hpp"
#include "scenes/load_gltf.hpp"
#include "systems/scratch.hpp"

namespace torsion::engine {
namespace {

struct CheckOptions {
  SceneOptions scene;
  bool json = false;
  bool verbose = false;
};

nlohmann::ordered_json problems_json(const std::vector<Problem>& problems) {
  auto list = nlohmann::ordered_json::array();
  for (const Problem& problem : problems) {
    list.push_back({{"file", problem.file},
                    {"where", problem.where},
                    {"key", problem.key},
                    {"value", problem.value},
                    {"expected", problem.expected},
                    {"mend", problem.mend}});
  }
  return list;
}

int report_problems(const std::vector<Problem>& problems, bool json) {
  if (json) {
    fmt::print("{}\n", nlohmann::ordered_json{{"problems", problems_json(problems)}}.dump(2));
  } else {
    fmt::print("{}{} problem{}\n", to_text(problems), problems.size(),
               problems.size() == 1 ? "" : "s");
  }
  return kFailed;
}

const char* shape_name(ShapeKind kind) {
  constexpr const char* kNames[] = {"sphere", "ellipsoid", "box", "cylinder", "capsule", "mesh"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string parts_text(const std::vector<PartDescription>& parts) {
  std::string text;
  for (const PartDescription& part : parts) {
    text += (text.empty() ? "" : ", ") + std::string(shape_name(part.shape.kind));
    if (part.shape.kind == ShapeKind::kMesh) {
      text += fmt::format(" of {} triangles", part.surface.triangles.size());
    }
  }
  return text;
}

const char* fixed_text(FixedKind kind) {
  constexpr const char* kNames[] = {"a point", "a face", "volumes"};
  return kNames[static_cast<std::size_t>(kind)];
}

/// What runs for one body, as `check` says it in words and as JSON.
struct BodyReport {
  const BodyDescription& scene;
  const ModelChoice& choice;
  std::uint32_t anchors;
};

BodyReport report_of(const SceneDescription& scene, const Simulation& simulation,
                     std::uint32_t row) {
  return {scene.bodies[row], simulation.choices[row],
          simulation.world.model.bodies.at<OwnedRows>(row).anchors.count};
}

void print_body(const BodyReport& report) {
  const BodyDescription& body = report.scene;
  const glm::dvec3& point = body.fixed.point;
  fmt::print(
      "body \"{}\"  {}; E {:.4g} Pa, nu {:.3g}, rho {:.4g} kg/m^3, mu_s {:.3g}, mu_d {:.3g}\n"
      "  fixed by {} at ({:.4g}, {:.4g}, {:.4g}) m in its frame; regions nearer than {:.3g} mm "
      "are one; {} anchors\n",
      body.node, parts_text(body.parts), body.elasticity.youngs_modulus,
      body.elasticity.poisson_ratio, body.elasticity.density, body.friction.static_friction,
      body.friction.dynamic_friction, fixed_text(body.fixed.kind), point.x, point.y, point.z,
      1e3 * report.choice.models.region_threshold, report.anchors);
  const ModelChoice& choice = report.choice;
  fmt::print("  contact model {} ({})\n  body model {} ({})\n", name_of(choice.models.contact),
             choice.contact_why, name_of(choice.models.body), choice.body_why);
}

void print_tool(const ToolDescription& tool, std::uint32_t samples) {
  fmt::print("tool \"{}\"  {}; {:.4g} kg; held by {}, {:.3f} s of motion; {} surface samples\n",
             tool.node, parts_text(tool.parts), tool.mass.mass, tool.device, tool.script.end_time,
             samples);
  if (tool.device != "animation") {
    fmt::print("  \"{}\" holds it in a session ({}); elsewhere only an animation moves it\n",
               tool.device, tool.device == "usb" ? "simulate --realtime" : "view");
  }
}

void print_scene(const SceneDescription& scene, const Simulation& simulation,
                 const std::vector<std::string>& warnings) {
  const World& world = simulation.world;
  fmt::print("{}: no problems{}\n", scene.path,
             warnings.empty()
                 ? ""
                 : fmt::format(", {} warning{}", warnings.size(), warnings.size() == 1 ? "" : "s"));
  for (const std::string& warning : warnings) {
    fmt::print("warning: {}\n", warning);
  }
  for (std::uint32_t row = 0; row < scene.bodies.size(); ++row) {
    print_body(report_of(scene, simulation, row));
  }
  for (std::uint32_t row = 0; row < scene.tools.size(); ++row) {
    print_tool(scene.tools[row], world.model.tools.at<OwnedRows>(row).samples.count);
  }
  for (const std::string& node : simulation.united_nodes) {
    fmt::print("\"{}\" has meshes that overlap: they count as one solid, their union\n", node);
  }
}

/// For who wants to know what a step costs and why.
void print_systems(const Simulation& simulation) {
  fmt::print("physics tables: {:.1f} MiB\nwhat a step does, in order:\n",
             static_cast<double>(memory_of(simulation.world)) / (1024.0 * 1024.0));
  for (const auto& row : simulation.scratch->schedule.rows()) {
    fmt::print("  {:3}  {:24}  {}{}\n", row.on ? "on" : "off", row.system.name, row.system.purpose,
               row.on ? "" : fmt::format(" (off: it needs {})", row.system.needs));
  }
}

nlohmann::ordered_json scene_json(const SceneDescription& scene, const Simulation& simulation,
                                  const std::vector<std::string>& warnings) {
  const World& world = simulation.world;
  nlohmann::ordered_json json = {{"scene", scene.path},
                                 {"problems", nlohmann::json::array()},
                                 {"warnings", warnings},
                                 {"duration_s", scene.duration},
                                 {"physics_bytes", memory_of(world)}};
  for (std::uint32_t row = 0; row < scene.bodies.size(); ++row) {
    const BodyReport report = report_of(scene, simulation, row);
    json["bodies"].push_back({{"node", report.scene.node},
                              {"parts", report.scene.parts.size()},
                              {"anchors", report.anchors},
                              {"contact_model", name_of(report.choice.models.contact)},
                              {"contact_model_why", report.choice.contact_why},
                              {"body_model", name_of(report.choice.models.body)},
                              {"body_model_why", report.choice.body_why}});
  }
  for (std::uint32_t row = 0; row < scene.tools.size(); ++row) {
    const ToolDescription& tool = scene.tools[row];
    json["tools"].push_back(
        {{"node", tool.node},
         {"parts", tool.parts.size()},
         {"mass_kg", tool.mass.mass},
         {"device", tool.device},
         {"surface_samples", world.model.tools.at<OwnedRows>(row).samples.count}});
  }
  json["united_nodes"] = simulation.united_nodes;
  for (const auto& row : simulation.scratch->schedule.rows()) {
    json["systems"].push_back({{"name", row.system.name},
                               {"on", row.on},
                               {"purpose", row.system.purpose},
                               {"needs", row.system.needs}});
  }
  return json;
}

int check(const CheckOptions& options) {
  const LoadedScene loaded = load_gltf(options.scene.scene);
  if (!loaded.scene) {
    return report_problems(loaded.problems, options.json);
  }
  PrepareOptions chosen = options.scene.prepare_options();
  chosen.expected_poses = expected_poses(*loaded.scene);
  Result<Simulation> prepared = prepare_with_bar(*loaded.scene, chosen, options.json);
  if (!prepared) {
    return report_problems({{options.scene.scene, "", "", "", prepared.error().text, ""}},
                           options.json);
  }
  SceneDescription as_drawn = *loaded.scene;
  refine_drawn_bodies(as_drawn, prepared.value().world.model, chosen.expected_poses);
  const std::vector<std::string> warnings =
      scene_warnings(as_drawn, prepared.value(), chosen.expected_poses, chosen);
  if (options.json) {
    fmt::print("{}\n", scene_json(*loaded.scene, prepared.value(), warnings).dump(2));
  } else {
    print_scene(*loaded.scene, prepared.value(), warnings);
    if (options.verbose) {
      print_systems(prepared.value());
    }
  }
  return kDone;
}

}  // namespace

void add_check(CLI::App& app, Command& command) {
  CLI::App* subcommand =
      app.add_subcommand("check", "Say all that is wrong with a scene, or what would run and why");
  auto options = std::make_shared<CheckOptions>();
  options->scene.add_to(*subcommand);
  subcommand->add_flag("--json", options->json, "Print as JSON");
  subcommand->add_flag("--verbose", options->verbose,
                       "Also what a step does, in order, and the memory of the physics tables");
  subcommand->callback([options, &command] {
    command = [options] {
      return check(*options);
    };
  });
}

}  // namespace torsion::engine
