#include "app/scene_settings.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "ecs/model_names.hpp"
#include "scenes/conventions.hpp"
#include "scenes/extras.hpp"

namespace torsion::engine {
namespace {

struct Setting {
  std::string node;
  std::string key;
  std::string value;
};

Setting split(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t dot = text.rfind('.', equals);
  return {text.substr(0, dot), text.substr(dot + 1, equals - dot - 1), text.substr(equals + 1)};
}

/// A number of an elastic node by its name; where it stands in several places, it is the same
/// there.
struct BodyNumber {
  std::string_view key;
  std::string_view bounds_of;  // the file's key, without torsion_
  std::vector<double*> (*places)(BodyDescription&);
};
#define TORSION_NUMBER(key, place)              \
  BodyNumber {                                  \
    key, key, [](BodyDescription& body) {       \
      return std::vector<double*>{&body.place}; \
    }                                           \
  }
constexpr BodyNumber kBodyNumbers[] = {
    TORSION_NUMBER("youngs_modulus", elasticity.youngs_modulus),
    TORSION_NUMBER("poisson_ratio", elasticity.poisson_ratio),
    TORSION_NUMBER("density", elasticity.density),
    TORSION_NUMBER("static_friction", friction.static_friction),
    TORSION_NUMBER("dynamic_friction", friction.dynamic_friction),
    {"friction", "dynamic_friction",
     [](BodyDescription& body) {
       return std::vector<double*>{&body.friction.dynamic_friction, &body.friction.static_friction};
     }},
    TORSION_NUMBER("tolerance", models.tolerance),
    TORSION_NUMBER("region_threshold", models.region_threshold)};
#undef TORSION_NUMBER
constexpr std::string_view kBodyTexts[] = {"contact_model", "body_model"};

const SceneKey& scene_key(std::string_view key) {
  return *std::ranges::find(kSceneKeys, "torsion_" + std::string(key), &SceneKey::name);
}

/// The number that the value is, within the bounds of the file's key.
std::optional<double> number_of(const Setting& setting, std::string_view key) {
  const std::optional<double> number = read_number(setting.value);
  return number && scene_key(key).allows(*number) ? number : std::nullopt;
}

/// What a value should have been.
std::string expected(std::string_view key) {
  const SceneKey& known = scene_key(key);
  return known.kind == KeyKind::kWord ? "expected one of " + std::string(known.allowed)
                                      : "expected " + std::string(known.allowed);
}

std::string unknown_key(const Setting& setting, std::span<const std::string_view> keys,
                        const char* what) {
  std::vector<std::string_view> known(keys.begin(), keys.end());
  const auto meant = did_you_mean(setting.key, known);
  return fmt::format("{} has no \"{}\"{}; it has {}", what, setting.key,
                     meant ? ", did you mean \"" + *meant + "\"?" : "", fmt::join(known, ", "));
}

/// Empty, or what is wrong.
std::string set_on_body(const Setting& setting, BodyDescription& body) {
  const auto* const number = std::ranges::find(kBodyNumbers, setting.key, &BodyNumber::key);
  if (number != std::end(kBodyNumbers)) {
    const std::optional<double> value = number_of(setting, number->bounds_of);
    if (!value) {
      return expected(number->bounds_of);
    }
    for (double* const place : number->places(body)) {
      *place = *value;
    }
    return "";
  }
  if (setting.key == "contact_model") {
    const auto model = contact_model_named(setting.value);
    body.models.contact = model.value_or(body.models.contact);
    return model ? "" : expected(setting.key);
  }
  if (setting.key == "body_model") {
    const auto model = body_model_named(setting.value);
    body.models.body = model.value_or(body.models.body);
    return model ? "" : expected(setting.key);
  }
  std::vector<std::string_view> keys;
  std::ranges::transform(kBodyNumbers, std::back_inserter(keys), &BodyNumber::key);
  std::ranges::copy(kBodyTexts, std::back_inserter(keys));
  return unknown_key(setting, keys, "an elastic node");
}

std::string set_on_tool(const Setting& setting, ToolDescription& tool) {
  if (setting.key != "mass") {
    constexpr std::string_view kKeys[] = {"mass"};
    return unknown_key(setting, kKeys, "a tool");
  }
  const std::optional<double> mass = number_of(setting, setting.key);
  if (!mass) {
    return expected(setting.key);
  }
  tool.mass.inertia *= *mass / tool.mass.mass;
  tool.mass.mass = *mass;
  return "";
}

std::string unknown_node(const std::string& node, const SceneDescription& scene) {
  std::vector<std::string_view> names;
  std::ranges::transform(scene.bodies, std::back_inserter(names), &BodyDescription::node);
  std::ranges::transform(scene.tools, std::back_inserter(names), &ToolDescription::node);
  return fmt::format("the scene has no elastic node or tool \"{}\"; it has {}", node,
                     fmt::join(names, ", "));
}

std::string set(const Setting& setting, SceneDescription& scene) {
  const auto body = std::ranges::find(scene.bodies, setting.node, &BodyDescription::node);
  if (body != scene.bodies.end()) {
    return set_on_body(setting, *body);
  }
  const auto tool = std::ranges::find(scene.tools, setting.node, &ToolDescription::node);
  if (tool != scene.tools.end()) {
    return set_on_tool(setting, *tool);
  }
  return unknown_node(setting.node, scene);
}

}  // namespace

std::optional<double> read_number(const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  return read.ec == std::errc{} && read.ptr == end && std::isfinite(number) ? std::optional(number)
                                                                            : std::nullopt;
}

std::string setting_form_problem(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  const std::size_t dot = setting.rfind('.', equals);
  const bool fits = equals != std::string::npos && dot != std::string::npos && dot > 0 &&
                    dot + 1 < equals && equals + 1 < setting.size();
  return fits ? "" : "expected NODE.KEY=VALUE, as cube.youngs_modulus=2e4";
}

Result<Done> apply_settings(std::span<const std::string> settings, SceneDescription& scene) {
  for (const std::string& text : settings) {
    const std::string problem = set(split(text), scene);
    if (!problem.empty()) {
      return Error{fmt::format("{}: --set {}: {}", scene.path, text, problem)};
    }
  }
  for (const BodyDescription& body : scene.bodies) {
    if (body.friction.static_friction < body.friction.dynamic_friction) {
      return Error{fmt::format(
          "{}: --set leaves node \"{}\" with a static_friction of {}, expected at least the "
          "dynamic_friction of {}; set both",
          scene.path, body.node, body.friction.static_friction, body.friction.dynamic_friction)};
    }
  }
  return Done{};
}

Result<SettableNumber> settable_number(const std::string& name, const SceneDescription& scene) {
  const Setting wanted = split(name + "=");
  const auto as_settable = [](std::string_view key, double value) {
    const SceneKey& known = scene_key(key);
    return SettableNumber{value, known.least, known.most, !known.least_is_allowed};
  };
  const auto body = std::ranges::find(scene.bodies, wanted.node, &BodyDescription::node);
  if (body != scene.bodies.end()) {
    const auto* const number = std::ranges::find(kBodyNumbers, wanted.key, &BodyNumber::key);
    if (number == std::end(kBodyNumbers)) {
      std::vector<std::string_view> keys;
      std::ranges::transform(kBodyNumbers, std::back_inserter(keys), &BodyNumber::key);
      return Error{unknown_key(wanted, keys, "an elastic node")};
    }
    BodyDescription copy;
    copy.elasticity = body->elasticity;
    copy.friction = body->friction;
    copy.models = body->models;
    return as_settable(number->bounds_of, *number->places(copy).front());
  }
  const auto tool = std::ranges::find(scene.tools, wanted.node, &ToolDescription::node);
  if (tool == scene.tools.end()) {
    return Error{unknown_node(wanted.node, scene)};
  }
  if (wanted.key != "mass") {
    constexpr std::string_view kKeys[] = {"mass"};
    return Error{unknown_key(wanted, kKeys, "a tool")};
  }
  return as_settable("mass", tool->mass.mass);
}

}  // namespace torsion::engine
