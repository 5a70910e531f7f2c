// Each column of the state has one writer, and no system changes another one's.

#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "ecs/hash.hpp"
#include "systems/contact/law.hpp"
#include "systems/scratch.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/studies.hpp"

namespace torsion::engine {
namespace {

constexpr glm::dvec3 kUp(0.0, 1.0, 0.0);

std::string names_of(ColumnSet set) {
  std::string names;
  for (std::size_t column = 0; column < kStateColumns; ++column) {
    names += set.has(column) ? std::string(kColumnNames[column]) + " " : "";
  }
  return names;
}

/// The contact model whose law has that system; kAuto: none.
ContactModel contact_model_of(std::string_view system) {
  for (const ContactLaw* const law : contact_laws()) {
    for (const auto& systems : {law->place, law->solve}) {
      for (const System<StepContext>& each : systems) {
        if (each.name == system) {
          return law->model;
        }
      }
    }
  }
  return ContactModel::kAuto;
}

TEST(ColumnWritersTest, EveryColumnHasOneWriter) {
  const std::vector<System<StepContext>> systems = step_systems();
  for (std::size_t column = 0; column < kStateColumns; ++column) {
    SCOPED_TRACE(kColumnNames[column]);
    std::size_t writers = 0;
    std::set<ContactModel> models;
    for (const System<StepContext>& system : systems) {
      if (system.writes.has(column)) {
        ++writers;
        models.insert(contact_model_of(system.name));
      }
    }
    // A region has one contact model: columns that all of them write have one writer there.
    EXPECT_GE(writers, 1U);
    EXPECT_TRUE(writers == 1 ||
                (models.size() == writers && !models.contains(ContactModel::kAuto)));
  }
}

/// A tool of two balls, so that contacts join and part, over a body of that shape.
SceneDescription two_balls_over(ShapeKind kind, const glm::dvec3& half_extent,
                                const BodyModels& models) {
  SceneDescription scene = test::ball_on_cube();
  scene.bodies[0] = test::make_body({test::make_part(kind, half_extent)});
  scene.bodies[0].elasticity = {1e5, 0.45, 1000.0};
  scene.bodies[0].friction = {0.5, 0.4};
  scene.bodies[0].models = models;
  scene.bodies[0].models.region_threshold = 0.004;
  if (kind == ShapeKind::kBox && half_extent.y < half_extent.x / 2.0) {
    // A layer that moves.
    MotionLink link;
    link.animated_translation = {
        Interpolation::kLinear, {0.0, 1.0}, {glm::dvec4(0.0), {1e-4, 0.0, 0.0, 0.0}}};
    scene.bodies[0].script = {{link}, 1.0};
  }
  scene.tools[0] = test::make_tool(
      {test::make_part(ShapeKind::kSphere, glm::dvec3(0.02), {{0.011, 0.0, 0.0}}),
       test::make_part(ShapeKind::kSphere, glm::dvec3(0.02), {{-0.011, 0.0, 0.0}})});
  return scene;
}

/// What systems have changed.
struct Changes {
  std::vector<ColumnSet> of_system = std::vector<ColumnSet>(step_systems().size());
};

void step_and_note(test::Hand& hand, Changes& changes) {
  World& world = hand.simulation().world;
  Scratch& scratch = *hand.simulation().scratch;
  StepContext context = scratch.context(world.model, world.state, hand.poses);
  ColumnHashes before = hash_columns(world.state);
  std::size_t number = 0;
  for (const auto& row : scratch.schedule.rows()) {
    if (row.on) {
      row.system.run(context);
      const ColumnHashes after = hash_columns(world.state);
      const ColumnSet changed = differing(before, after);
      const ColumnSet undeclared = changed - row.system.declared();
      EXPECT_TRUE(undeclared.empty()) << row.system.name << " changes " << names_of(undeclared);
      changes.of_system[number] = changes.of_system[number] | changed;
      before = after;
    }
    ++number;
  }
  Clock& clock = world.state.clock;
  clock.time = static_cast<double>(clock.step) * world.model.dt;
  clock.step += 1;
}

/// Down until the two contacts are one, round, up until they are two, aside over the body's edge,
/// and off.
void press_turn_and_leave(test::Hand& hand, double top, Changes& changes) {
  struct Leg {
    glm::dvec3 shift;
    double turn;
    int steps;
  };
  constexpr Leg kLegs[] = {{{0.0, -4e-3, 0.0}, 0.0, 60},     {{1e-3, -1e-3, 0.0}, 0.3, 60},
                           {{0.0, 3.3e-3, 0.0}, 0.0, 60},    {{0.0, -3.3e-3, 0.0}, 0.0, 60},
                           {{0.05, 2.5e-3, 0.01}, 0.2, 120}, {{0.0, 2e-3, 0.0}, 0.0, 20}};
  hand.poses = {{{0.0, top + 0.0205, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)}};
  for (const Leg& leg : kLegs) {
    const Pose start = hand.poses[0];
    for (int i = 1; i <= leg.steps; ++i) {
      const double share = static_cast<double>(i) / leg.steps;
      hand.poses[0] = {start.position + share * leg.shift,
                       glm::angleAxis(share * leg.turn, kUp) * start.rotation};
      step_and_note(hand, changes);
    }
  }
}

TEST(ColumnWritersTest, NoSystemChangesWhatItDoesNotDeclareAndAllThatItDeclaresItWrites) {
  const std::pair<ShapeKind, glm::dvec3> bodies[] = {
      {ShapeKind::kBox, {0.04, 0.05, 0.05}},        // a block
      {ShapeKind::kBox, {0.06, 0.006, 0.06}},       // a layer
      {ShapeKind::kEllipsoid, {0.05, 0.05, 0.08}},  // bent all over
  };
  Changes changes;
  for (const ContactLaw* const law : contact_laws()) {
    for (const BodyModel model : {BodyModel::kNone, BodyModel::kSkeleton, BodyModel::kCompliance}) {
      for (const auto& [kind, half_extent] : bodies) {
        // The body's shape matters to body model compliance most, and to the model with cells.
        if (test::is_left_out(
                half_extent == bodies[0].second ||
                (model == BodyModel::kCompliance && law->model == ContactModel::kPatch))) {
          continue;
        }
        SCOPED_TRACE(testing::Message() << static_cast<int>(law->model) << " "
                                        << static_cast<int>(model) << " " << half_extent.y);
        test::Hand hand(two_balls_over(kind, half_extent, {law->model, model}));
        press_turn_and_leave(hand, half_extent.y, changes);
        EXPECT_GE(hand.clock().regions_formed, 3U);  // also where two had become one
        if (testing::Test::HasFailure()) {
          return;
        }
      }
    }
  }
  const std::vector<System<StepContext>> systems = step_systems();
  for (std::size_t number = 0; number < systems.size(); ++number) {
    const ColumnSet never = systems[number].writes - changes.of_system[number];
    EXPECT_TRUE(never.empty()) << systems[number].name << " never writes " << names_of(never);
  }
}

}  // namespace
}  // namespace torsion::engine
