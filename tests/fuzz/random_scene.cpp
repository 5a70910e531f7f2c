#include "tests/fuzz/random_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "ecs/model_names.hpp"
#include "tests/support/contact_scenes.hpp"

namespace torsion::engine::test {
namespace {

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}

  /// The same on every machine: the library's distributions are not.
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11U) * 0x1p-53;
  }
  double logarithmic(double low, double high) {
    return std::exp(between(std::log(low), std::log(high)));
  }
  std::size_t one_of(std::size_t count) { return static_cast<std::size_t>(random_() % count); }
  /// Components from -1 to 1. Braces: in this order with every compiler.
  glm::dvec2 plane() { return glm::dvec2{between(-1.0, 1.0), between(-1.0, 1.0)}; }
  bool chance(double share) { return between(0.0, 1.0) < share; }

 private:
  std::mt19937_64 random_;
};

constexpr glm::dquat kUpright(1.0, 0.0, 0.0, 0.0);

struct Made {
  PartDescription part;
  std::string text;
};

/// @param size  m, of its longest half extent
Made random_part(Dice& dice, double size, const glm::dvec3& place) {
  constexpr ShapeKind kKinds[] = {ShapeKind::kSphere, ShapeKind::kBox, ShapeKind::kEllipsoid,
                                  ShapeKind::kCylinder, ShapeKind::kCapsule};
  constexpr const char* kNames[] = {"sphere", "box", "ellipsoid", "cylinder", "capsule"};
  const std::size_t kind = dice.one_of(std::size(kKinds));
  glm::dvec3 half(size);
  if (kKinds[kind] != ShapeKind::kSphere) {
    half.x *= dice.between(0.4, 1.0);
    half.z *= dice.between(0.4, 1.0);
    half.y *= dice.between(0.4, 1.0);
  }
  if (kKinds[kind] == ShapeKind::kCylinder || kKinds[kind] == ShapeKind::kCapsule) {
    half.z = half.x;
  }
  if (kKinds[kind] == ShapeKind::kCapsule) {
    half.y = std::max(half.y, 1.2 * half.x);
  }
  const bool as_mesh = dice.chance(0.3);
  const auto fineness = static_cast<std::uint32_t>(2 + dice.one_of(12));
  return {make_part(kKinds[kind], half, {place, kUpright}, as_mesh, fineness),
          fmt::format("{}{}", kNames[kind], as_mesh ? fmt::format(" mesh {}", fineness) : "")};
}

glm::dquat random_rotation(Dice& dice) {
  const glm::dvec2 first = dice.plane();
  const glm::dvec2 second = dice.plane();
  const glm::dquat any(first.x, first.y, second.x, second.y);
  return glm::length(any) > 0.1 ? glm::normalize(any) : kUpright;
}

void add_tool(Dice& dice, double size, double side, RandomScene& random) {
  const double radius = size * dice.between(0.15, 0.6);
  std::vector<PartDescription> parts;
  Made first = random_part(dice, radius, glm::dvec3(0.0));
  random.text += "; tool " + first.text;
  parts.push_back(std::move(first.part));
  if (dice.chance(0.2)) {
    Made second = random_part(dice, 0.6 * radius, {0.9 * radius, 0.0, 0.0});
    random.text += " and " + second.text;
    parts.push_back(std::move(second.part));
  }
  random.scene.tools.push_back(make_tool(std::move(parts)));
  random.scene.tools.back().node = fmt::format("tool {}", random.scene.tools.size());
  RandomWay way;
  way.beside =
      glm::dvec2(0.5 * side * size, 0.0) + (side == 0.0 ? 0.4 : 0.08) * size * dice.plane();
  way.rotation = dice.chance(0.5) ? kUpright : random_rotation(dice);
  way.depth = radius * dice.logarithmic(2e-3, 0.08);
  const double slide = dice.chance(0.3) ? 0.0 : way.depth * dice.between(0.0, 3.0);
  way.slide = slide * dice.plane();
  way.turn = dice.chance(0.3) ? 0.0 : dice.between(-0.6, 0.6);
  random.text += fmt::format(", {:.3g} deep, turned by {:.2g}", way.depth, way.turn);
  random.ways.push_back(way);
}

/// Materials, models, and whether its lowest face is fixed or the middle of that.
void add_physics(Dice& dice, RandomScene& random, BodyDescription& body) {
  body.elasticity.youngs_modulus = dice.logarithmic(1.0, 1e12);
  body.elasticity.poisson_ratio = dice.chance(0.2) ? 0.5 : dice.between(0.0, 0.5);
  const double dynamic = dice.chance(0.1) ? 0.0 : dice.logarithmic(0.01, 10.0);
  body.friction = {dynamic * (dice.chance(0.7) ? 1.0 : dice.between(1.0, 2.0)), dynamic};
  if (dice.chance(0.5)) {
    body.fixed.kind = FixedKind::kFace;
    body.fixed.normal = {0.0, 1.0, 0.0};
  }
  constexpr ContactModel kContacts[] = {ContactModel::kPaper, ContactModel::kMdr,
                                        ContactModel::kPatch};
  constexpr BodyModel kBodies[] = {BodyModel::kNone, BodyModel::kSkeleton, BodyModel::kCompliance};
  body.models.contact = kContacts[dice.one_of(3)];
  // A body's compliance takes a second.
  body.models.body = dice.chance(0.2) ? kBodies[2] : kBodies[dice.one_of(2)];
  random.text += fmt::format(", E {:.3g}, nu {:.3g}, mu {:.3g} {:.3g}, {} {}",
                             body.elasticity.youngs_modulus, body.elasticity.poisson_ratio,
                             body.friction.static_friction, body.friction.dynamic_friction,
                             name_of(body.models.contact), name_of(body.models.body));
}

void add_rate(Dice& dice, RandomScene& random) {
  random.options.rate = dice.logarithmic(100.0, 1e5);
  random.options.use_cache = false;
  random.text += fmt::format("; {:.4g} Hz", random.options.rate);
}

}  // namespace

RandomScene random_scene(std::uint64_t seed) {
  Dice dice(seed);
  RandomScene random;
  const double size = dice.logarithmic(1e-6, 100.0);
  random.size = 2.0 * size;
  std::vector<PartDescription> parts;
  Made first = random_part(dice, size, glm::dvec3(0.0));
  random.text = fmt::format("{:.3g} m, body {}", 2.0 * size, first.text);
  parts.push_back(std::move(first.part));
  if (dice.chance(0.2)) {
    Made second = random_part(dice, 0.6 * size, {0.5 * size, 0.4 * size, 0.0});
    random.text += " and " + second.text;
    parts.push_back(std::move(second.part));
  }
  BodyDescription body = make_body(std::move(parts));
  add_physics(dice, random, body);
  random.scene.bodies.push_back(std::move(body));
  const bool two = dice.chance(0.2);
  add_tool(dice, size, two ? -1.0 : 0.0, random);
  if (two) {
    add_tool(dice, size, 1.0, random);
  }
  add_rate(dice, random);
  return random;
}

RandomScene random_pinch(std::uint64_t seed) {
  Dice dice(seed);
  RandomScene random;
  const double size = dice.logarithmic(1e-6, 100.0);
  random.size = 2.0 * size;
  constexpr ShapeKind kKinds[] = {ShapeKind::kBox, ShapeKind::kCylinder, ShapeKind::kEllipsoid};
  constexpr const char* kNames[] = {"box", "cylinder", "ellipsoid"};
  const std::size_t kind = dice.one_of(std::size(kKinds));
  const double width = dice.logarithmic(0.15, 0.7);
  const bool as_mesh = dice.chance(0.3);
  const auto fineness = static_cast<std::uint32_t>(3 + dice.one_of(12));
  BodyDescription body = make_body({make_part(kKinds[kind], size * glm::dvec3(width, 1.0, width),
                                              {glm::dvec3(0.0), kUpright}, as_mesh, fineness)});
  random.text = fmt::format("{:.3g} m, body {}{}, {:.2g} wide", 2.0 * size, kNames[kind],
                            as_mesh ? fmt::format(" mesh {}", fineness) : "", width);
  add_physics(dice, random, body);
  body.fixed.kind = FixedKind::kFace;
  body.fixed.normal = {0.0, 1.0, 0.0};
  random.scene.bodies.push_back(std::move(body));
  const double height = dice.between(-0.2, 0.85);
  const bool together = dice.chance(0.7);
  for (const double side : {1.0, -1.0}) {
    add_tool(dice, dice.between(0.7, 2.0) * width * size, 0.0, random);
    RandomWay& way = random.ways.back();
    // y to the side, x along the column: down on one side, up on the other.
    way.axes = glm::angleAxis(-0.5 * std::numbers::pi * side, glm::dvec3(0.0, 0.0, 1.0));
    way.beside = size * glm::dvec2{-side * (height + dice.between(-0.05, 0.05)),
                                   dice.between(-0.2, 0.2) * width};
    if (together && side < 0.0) {
      way.slide = random.ways.front().slide * glm::dvec2(-1.0, 1.0);
    }
  }
  add_rate(dice, random);
  random.text += "; a pinch";
  return random;
}

RandomScene random_scene_at_edge(std::uint64_t seed) {
  RandomScene random = random_scene(seed);
  Dice dice(~seed);
  const ShapePart& body = random.scene.bodies[0].parts[0].shape;
  for (RandomWay& way : random.ways) {
    const double angle = dice.between(0.0, 2.0 * std::numbers::pi);
    const glm::dvec2 out(std::cos(angle), std::sin(angle));
    const glm::dvec2 sides = glm::abs(out) / glm::dvec2(body.half_extent.x, body.half_extent.z);
    const double to_edge =
        body.kind == ShapeKind::kBox ? 1.0 / std::max(sides.x, sides.y) : 1.0 / glm::length(sides);
    way.beside = dice.between(0.93, 1.03) * to_edge * out;
  }
  random.text += "; at an edge";
  return random;
}

}  // namespace torsion::engine::test
