// The normal force of contact model mdr over a thin body on a fixed face, against the exact
// solution for a sphere on a bonded layer.

#include <cmath>

#include <gtest/gtest.h>

#include "systems/mdr/round_contact.hpp"
#include "tests/reference/exact/hertz.hpp"
#include "tests/reference/exact/layers.hpp"
#include "tests/support/contact_scenes.hpp"
#include "tests/support/directions.hpp"

namespace torsion::engine {
namespace {

using test::Hand;
using test::kUp;

/// The radius that a half-space's contact has, over the layer's thickness, and how far the series
/// of Dimitriadis et al. (2002) is from the exact solution there, incompressible: 0.02, 0.2, 1.1
/// and 7.7 %, to the last digit given. The less a layer keeps its volume, the less it stiffens.
struct Validity {
  double chi;
  double bound;
};

constexpr Validity kValid[] = {{0.0454, 0.00025}, {0.1, 0.0025}, {0.2, 0.0115}, {0.5, 0.0775}};
constexpr double kRatios[] = {0.3, 0.45, 0.49, 0.5};

/// Force on a bonded layer over that on a half-space, exactly; in units of the half-space's radius
/// of contact, of a sphere far larger than that.
double exact_share(double chi, double poisson) {
  constexpr double kSphere = 1e4;
  const reference::Layer layer{reference::LayerBase::kBonded, 1.0 / chi, poisson, 1.0};
  return reference::layer_sphere_at_depth(layer, kSphere, 1.0 / kSphere).hertz_ratio;
}

TEST(MdrLayerForceTest, TheSeriesIsAsGoodAsItsSourceSays) {
  for (const double poisson : kRatios) {
    for (const Validity& valid : kValid) {
      const double exact = exact_share(valid.chi, poisson);
      EXPECT_NEAR(layer_force_share(valid.chi, poisson) / exact, 1.0, valid.bound)
          << poisson << " " << valid.chi;
      // It is a correction: what is left is a small part of what it takes away.
      EXPECT_LT(valid.bound, 0.15 * (exact - 1.0)) << poisson << " " << valid.chi;
    }
  }
}

TEST(MdrLayerForceTest, ABallOnASlabPressesAsOnTheLayer) {
  constexpr double kBall = 0.2;        // m: much larger than its contact, a / R = 0.1 at most
  constexpr double kThickness = 0.04;  // m; the slab is ten times as wide
  constexpr double kYoung = 3e5;       // Pa
  for (const double poisson : kRatios) {
    SceneDescription scene;
    BodyDescription body = test::make_body(
        {test::make_part(ShapeKind::kBox, {0.2, 0.5 * kThickness, 0.2},
                         {{0.0, 0.5 * kThickness, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)})});
    body.fixed.kind = FixedKind::kFace;
    body.fixed.point = glm::dvec3(0.0);
    body.fixed.normal = kUp;
    body.elasticity.poisson_ratio = poisson;
    body.elasticity.youngs_modulus = kYoung;
    body.models.contact = ContactModel::kMdr;
    body.models.body = BodyModel::kNone;
    scene.bodies.push_back(std::move(body));
    scene.tools.push_back(
        test::make_tool({test::make_part(ShapeKind::kSphere, glm::dvec3(kBall))}));
    Hand hand(scene);
    const glm::dvec3 touching(0.0, kThickness + kBall, 0.0);
    hand.step_to({{touching + 1e-6 * kUp, glm::dquat(1.0, 0.0, 0.0, 0.0)}});
    for (const Validity& valid : kValid) {
      const double depth = std::pow(valid.chi * kThickness, 2) / kBall;
      hand.move(touching - depth * kUp - hand.poses[0].position, kUp, 0.0, 50);
      const reference::SneddonSphere sphere =
          reference::sneddon_sphere_at_depth(kBall, kYoung / (1.0 - poisson * poisson), depth);
      // A sphere is no paraboloid: up to 0.1 % of force, and of the radius that the share is taken
      // at half of that.
      EXPECT_NEAR(hand.wrench().force.y / (sphere.force * exact_share(valid.chi, poisson)), 1.0,
                  valid.bound + 0.002)
          << poisson << " " << valid.chi;
    }
  }
}

}  // namespace
}  // namespace torsion::engine
