// How a body is drawn that turns as a whole by tens of degrees: its sections turn, they do not
// swell.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "systems/scratch.hpp"
#include "systems/surface/surface_field.hpp"
#include "systems/surface/take_snapshot.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"
#include "tests/systems/body/compliance/soft_bodies.hpp"

namespace torsion::engine {
namespace {

using test::Hand;
using test::kSoftShearModulus;
using test::kUp;

constexpr double kColumnRadius = 0.02;  // m: of the column
constexpr double kColumnHeight = 0.12;  // m
constexpr double kContact = 0.008;

constexpr std::uint32_t kRingsOfBody = 40;
constexpr std::uint32_t kAround = 36;
constexpr std::uint32_t kEnd = 27;  // rings from here on are nearer to the load than a diameter

/// A closed round column on y = 0: rings, and the middles of both ends.
DrawMesh column_mesh() {
  DrawMesh mesh;
  const auto add = [&mesh](double r, double y, double angle) {
    mesh.positions.emplace_back(glm::dvec3(r * std::cos(angle), y, r * std::sin(angle)));
    mesh.normals.emplace_back(0.0F, 1.0F, 0.0F);
    mesh.fixed.push_back(y == 0.0);
  };
  for (std::uint32_t ring = 0; ring <= kRingsOfBody; ++ring) {
    for (std::uint32_t k = 0; k < kAround; ++k) {
      add(kColumnRadius, kColumnHeight * ring / kRingsOfBody, 2.0 * std::numbers::pi * k / kAround);
    }
  }
  add(0.0, 0.0, 0.0);
  add(0.0, kColumnHeight, 0.0);
  const std::uint32_t top = kRingsOfBody * kAround;
  const std::uint32_t middles = top + kAround;
  for (std::uint32_t k = 0; k < kAround; ++k) {
    const std::uint32_t next = (k + 1) % kAround;
    for (std::uint32_t ring = 0; ring < kRingsOfBody; ++ring) {
      const std::uint32_t low = ring * kAround;
      const std::uint32_t high = low + kAround;
      mesh.triangles.emplace_back(low + k, high + k, low + next);
      mesh.triangles.emplace_back(low + next, high + k, high + next);
    }
    mesh.triangles.emplace_back(middles, k, next);
    mesh.triangles.emplace_back(middles + 1, top + next, top + k);
  }
  return mesh;
}

SceneDescription column_scene() {
  SceneDescription scene;
  BodyDescription body = test::make_body(
      {test::make_part(ShapeKind::kCylinder, {kColumnRadius, 0.5 * kColumnHeight, kColumnRadius},
                       {0.5 * kColumnHeight * kUp, glm::dquat(1.0, 0.0, 0.0, 0.0)})});
  body.fixed.kind = FixedKind::kFace;
  body.fixed.point = glm::dvec3(0.0);
  body.fixed.normal = kUp;
  body.elasticity.poisson_ratio = 0.5;
  body.elasticity.youngs_modulus = 3.0 * kSoftShearModulus;
  body.models = {ContactModel::kMdr, BodyModel::kCompliance};
  body.draw = column_mesh();
  scene.bodies.push_back(std::move(body));
  scene.tools.push_back(test::make_tool({test::make_part(ShapeKind::kSphere, glm::dvec3(0.02))}));
  return scene;
}

/// A column with one region on its top whose wrench is put on by hand, as drawn.
class LargeTurnTest : public ::testing::Test {
 protected:
  LargeTurnTest() : scene_(column_scene()), hand_(scene_) {
    hand_.step_to({{(kColumnHeight + 0.02) * kUp, glm::dquat(1.0, 0.0, 0.0, 0.0)}});
    hand_.move(-1e-3 * kUp, kUp, 0.0, 10);
    frame_ = prepare_frame(scene_, hand_.world().model, hand_.world().state);
    snapshot_.reserve(hand_.world().model, hand_.world().state);
    positions_.resize(frame_.body_vertices.size());
  }

  /// A force [N] and a couple [N m] about the column's axis, on the material.
  void draw(const glm::dvec3& force, double couple) {
    World& world = hand_.simulation().world;
    ASSERT_EQ(world.state.regions.size(), 1U);
    RegionFrame& grid = world.state.regions.at<RegionFrame>(0);
    grid.origin = kColumnHeight * kUp;
    grid.normal = kUp;
    grid.tangent_x = {1.0, 0.0, 0.0};
    grid.tangent_y = {0.0, 0.0, -1.0};
    world.state.regions.at<Overlap>(0) = Overlap{};  // nothing is dented
    world.state.regions.at<Contact>(0) = {grid.origin, grid.origin, 0.0, kContact, 0.0};
    world.state.regions.at<RegionNormal>(0).force = -force.y;
    RegionFriction& friction = world.state.regions.at<RegionFriction>(0);
    friction.force = {-force.x, force.z};
    friction.couple = -couple;
    capture(world.model, world.state, snapshot_);
    RegionField& field = snapshot_.region_fields.at<RegionField>(0);
    field.radius = kContact;  // a bonded disc: Reissner and Sagoci, 1944
    field.turn[kFieldDiscs - 1] =
        couple / (16.0 / 3.0 * kSoftShearModulus * std::pow(kContact, 3.0));
    anchor_motions(world.model, world.state, snapshot_);
    surface_field(world.model, snapshot_, frame_);
    deform_vertices(frame_, 0, positions_);
  }

  [[nodiscard]] glm::dvec3 rest(std::uint32_t vertex) const {
    return glm::dvec3(frame_.body_vertices.at<VertexRest>(vertex).position);
  }
  [[nodiscard]] glm::dvec3 moved(std::uint32_t vertex) const {
    return glm::dvec3(positions_[vertex]);
  }
  [[nodiscard]] std::uint32_t vertices() const { return frame_.body_vertices.size(); }

  /// Middle of the drawn section of a ring.
  [[nodiscard]] glm::dvec3 middle_of(std::uint32_t ring) const {
    glm::dvec3 sum(0.0);
    for (std::uint32_t k = 0; k < kAround; ++k) {
      sum += moved(ring * kAround + k);
    }
    return sum / static_cast<double>(kAround);
  }

  /// Largest difference of a ring's distances from its middle from the column's radius, over that.
  [[nodiscard]] double swelling_of(std::uint32_t ring) const {
    const glm::dvec3 middle = middle_of(ring);
    double most = 0.0;
    for (std::uint32_t k = 0; k < kAround; ++k) {
      most = std::max(
          most, std::abs(glm::distance(moved(ring * kAround + k), middle) / kColumnRadius - 1.0));
    }
    return most;
  }

  /// Source: the divergence theorem over the triangles.
  [[nodiscard]] double volume() const {
    double sum = 0.0;
    for (const Triangle& triangle : frame_.body_triangles.column<Triangle>()) {
      const glm::uvec3& v = triangle.vertices;
      sum += glm::dot(moved(v.x), glm::cross(moved(v.y), moved(v.z))) / 6.0;
    }
    return sum;
  }

  SceneDescription scene_;
  Hand hand_;
  FrameWorld frame_;
  Snapshot snapshot_;
  std::vector<glm::vec4> positions_;
};

/// Saint-Venant's couple for a turn of the top of a round bar, J = pi a^4 / 2.
double couple_for(double turn) {
  const double polar = 0.5 * std::numbers::pi * std::pow(kColumnRadius, 4.0);
  return turn * kSoftShearModulus * polar / kColumnHeight;
}

constexpr double kQuarter = 0.5 * std::numbers::pi;

// Finite elements and interpolation are off by some percent of the turn at anchors, so that what
// they say about displacements and about turns differs by up to e = 0.05 of 90 degrees = 0.08 rad;
// around the loaded end's edge by 5 % of the column's turn and of the disc's, which is 1.7 rad: e =
// 0.16. That remains as a shift along tangents, which takes a point e^2 / 2 off the circle: 0.3 %
// and 1.3 %. Displacements linear in the angle would be off by sqrt(1 + (pi/2)^2) - 1 = 86 %.
TEST_F(LargeTurnTest, SectionsOfAColumnTurnedBy90DegreesKeepTheirRadius) {
  draw(glm::dvec3(0.0), couple_for(kQuarter));
  for (std::uint32_t ring = 0; ring <= kRingsOfBody; ++ring) {
    EXPECT_LT(swelling_of(ring), ring < kEnd ? 0.003 : 0.015) << "ring " << ring;
    EXPECT_LT(glm::distance(middle_of(ring), kColumnHeight * ring / kRingsOfBody * kUp),
              0.01 * kColumnRadius);
  }
  const double column = 0.5 * kAround * std::sin(2.0 * std::numbers::pi / kAround) * kColumnRadius *
                        kColumnRadius * kColumnHeight;  // a prism with kAround sides
  // Sections turn against each other, so the flat triangles between them cut off some of the
  // column: a chord between two rings, pi / 2 / kRingsOfBody apart at most, is nearer to the axis
  // by (pi / 80)^2 / 2 = 0.08 %.
  EXPECT_NEAR(volume() / column, 1.0, 0.015);
}

TEST_F(LargeTurnTest, SectionsTurnAsFarAsSaintVenantSays) {
  draw(glm::dvec3(0.0), couple_for(kQuarter));
  // Away from the ends, where the couple and the clamp are felt.
  for (std::uint32_t ring = 8; ring <= 28; ++ring) {
    const double y = kColumnHeight * ring / kRingsOfBody;
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const glm::dvec3 from = rest(ring * kAround + k);
      const glm::dvec3 to = moved(ring * kAround + k);
      const double turned =
          std::atan2(from.z * to.x - from.x * to.z, from.x * to.x + from.z * to.z);
      EXPECT_NEAR(turned, kQuarter * y / kColumnHeight, 0.06 * kQuarter) << "y = " << y;
    }
  }
}

// The arc over its tangent, and the arc back to the circle: to second order turn^2 / 2 times the
// distance from the axis. Positions are floats of 0.12 m, 1.5e-8.
TEST_F(LargeTurnTest, SmallTurnsAreTheLinearField) {
  constexpr double kSmall = 2e-3;
  const glm::dvec3 force(0.004, -0.01, 0.002);
  draw(force * kSmall, couple_for(kSmall));
  std::vector<glm::dvec3> slope;  // m per rad
  for (std::uint32_t v = 0; v < vertices(); ++v) {
    slope.push_back((moved(v) - rest(v)) / kSmall);
  }
  for (const double turn : {5e-3, 0.02, 0.08}) {
    draw(force * turn, couple_for(turn));
    for (std::uint32_t v = 0; v < vertices(); ++v) {
      const glm::dvec3 linear = slope[v] * turn;
      // Under the contact the half-space turns by more than the column.
      const double angle = std::abs(static_cast<double>(frame_.twist.at<TwistAngle>(v).angle));
      const double bound = 0.5 * angle * angle * kColumnRadius * 1.1 + 4e-8 * turn / kSmall;
      EXPECT_NEAR(glm::distance(moved(v) - rest(v), linear), 0.0, bound) << turn;
    }
  }
}

// A column that is pressed, dragged and turned: its sections' middles and the contact go where the
// force takes them whatever the turn is, and each section turns about its own middle.
TEST_F(LargeTurnTest, ATurnDoesNotTurnWhatAForceDoes) {
  const glm::dvec3 force(0.2, -0.2, 0.0);
  draw(force, 0.0);
  std::vector<glm::dvec3> untwisted;
  std::vector<double> swollen;
  for (std::uint32_t ring = 0; ring < kEnd; ++ring) {
    untwisted.push_back(middle_of(ring));
    swollen.push_back(swelling_of(ring));
  }
  const std::uint32_t contact = vertices() - 1;
  const glm::dvec3 gone = moved(contact) - rest(contact);
  EXPECT_GT(gone.x, 0.1 * kColumnRadius);
  // What finite elements say a couple does to the middle of its region is small and not nothing.
  draw(glm::dvec3(0.0), couple_for(kQuarter));
  const glm::dvec3 by_couple = moved(contact) - rest(contact);
  draw(force, couple_for(kQuarter));
  EXPECT_NEAR(glm::distance(moved(contact) - rest(contact), gone + by_couple), 0.0,
              1e-4 * glm::length(gone));
  for (std::uint32_t ring = 0; ring < kEnd; ++ring) {
    // The interpolation's middle of a section is some percent off the mean of its rim.
    EXPECT_NEAR(glm::distance(middle_of(ring), untwisted[ring]), 0.0, 0.05 * gone.x) << ring;
    EXPECT_NEAR(swelling_of(ring), swollen[ring], 0.003) << ring;
  }
}

// The same through the physics: a flat end that sticks to the column presses it and turns it by 90
// degrees. Where it sticks the surface turns with it, half-space and body together; interpolation
// says the body's part there to the 5 % that finite elements have between couples and turns.
// Sections swell as a bar under that force does, nu F / (E A) = 1.3 %, and no more.
TEST(TurnedByAToolTest, SurfaceTurnsWithTheToolAndTheColumnSwellsOnlyByTheForce) {
  SceneDescription scene = column_scene();
  scene.tools[0] =
      test::make_tool({test::make_part(ShapeKind::kCylinder, {kContact, 0.02, kContact})});
  scene.bodies[0].friction = {5.0, 5.0};
  scene.bodies[0].models.contact = ContactModel::kPatch;
  Hand hand(scene);
  hand.step_to({{(kColumnHeight + 0.02) * kUp, glm::dquat(1.0, 0.0, 0.0, 0.0)}});
  hand.move(-4e-3 * kUp, kUp, 0.0, 100);
  hand.move(glm::dvec3(0.0), kUp, kQuarter, 1600);
  hand.move(glm::dvec3(0.0), kUp, 0.0, 16);
  FrameWorld frame = prepare_frame(scene, hand.world().model, hand.world().state);
  Snapshot snapshot;
  snapshot.reserve(hand.world().model, hand.world().state);
  take_snapshot(hand.simulation(), snapshot);
  surface_field(hand.world().model, snapshot, frame);
  std::vector<glm::vec4> positions(frame.body_vertices.size());
  deform_vertices(frame, 0, positions);
  EXPECT_NEAR(static_cast<double>(positions.back().w), kQuarter, 0.05 * kQuarter);
  EXPECT_GT(hand.world().state.regions.at<RegionSupport>(0).rotation.y, 0.3);
  const double area = std::numbers::pi * kColumnRadius * kColumnRadius;
  const double swollen = 0.5 * hand.wrench().force.y / (3.0 * kSoftShearModulus * area);
  for (std::uint32_t ring = 8; ring < kEnd; ++ring) {
    glm::dvec3 middle(0.0);
    for (std::uint32_t k = 0; k < kAround; ++k) {
      middle += glm::dvec3(positions[ring * kAround + k]) / static_cast<double>(kAround);
    }
    double radius = 0.0;
    for (std::uint32_t k = 0; k < kAround; ++k) {
      radius += glm::distance(glm::dvec3(positions[ring * kAround + k]), middle) / kAround;
    }
    EXPECT_NEAR(radius / kColumnRadius - 1.0, swollen, 0.003) << "ring " << ring;
  }
}

}  // namespace
}  // namespace torsion::engine
