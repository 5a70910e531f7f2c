// What is found of a device that nobody holds, against what it was made of.

#include "systems/hold/identification.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/studies.hpp"

namespace torsion::engine {
namespace {

/// A device of one translation and one turn axis, with stiction: it stands until it is pushed by
/// more than its friction.
struct FreeDevice {
  double mass = 0.15;
  double damping = 1.0;
  double friction = 0.2;
  double weight = 0.0;  // N, along the axis
  double spring = 0.0;  // N/m, of its own
  double count = 0.0;   // m
  double delay = 1e-3;  // s, whole parts of a period
  double x = 0.0;
  double v = 0.0;
  std::deque<double> late;

  [[nodiscard]] double measured() const { return count > 0.0 ? std::round(x / count) * count : x; }

  void move(double force, double period) {
    constexpr int kParts = 50;
    const double dt = period / kParts;
    const auto lag = static_cast<std::size_t>(std::lround(delay / dt));
    for (int i = 0; i < kParts; ++i) {
      late.push_back(force);
      const double now = late.size() > lag ? late[late.size() - 1 - lag] : 0.0;
      const double pushed = now + weight - spring * x - damping * v;
      if (std::abs(v) < 1e-12 && std::abs(pushed) <= friction) {
        v = 0.0;
        continue;
      }
      const double way = v != 0.0 ? v : pushed;
      const double next = v + (pushed - std::copysign(friction, way)) * dt / mass;
      v = v * next < 0.0 ? 0.0 : next;  // it stops before it turns round
      x += v * dt;
    }
    while (late.size() > lag + 2) {
      late.pop_front();
    }
  }
};

/// Along x, or about the turn axis.
AxisDynamics identify(FreeDevice device, double largest, double period, bool turns) {
  Identification identification;
  const std::size_t axis = turns ? 4 : 0;
  begin_identification(identification, static_cast<std::uint8_t>(1U << axis), {largest, largest},
                       glm::dquat(1.0, 0.0, 0.0, 0.0));
  Wrench sent;
  int samples = 0;
  while (!is_done(identification)) {
    Pose measured;
    const double way = device.measured();
    if (turns) {
      measured.rotation = glm::angleAxis(way, glm::dvec3(0.0, 1.0, 0.0));
    } else {
      measured.position.x = way;
    }
    sent = take_identification_sample(identification, measured, sent, period);
    device.move(turns ? sent.torque.y : sent.force.x, period);
    samples += 1;
  }
  EXPECT_NEAR(samples * period, identification_time(identification.axes), 0.2);
  return dynamics_of(identification, axis, device.count);
}

/// What a fit may be off by. A describing function leaves the odd harmonics of friction out: they
/// are some per cent where friction is a sixth of the smaller swinging force, a tenth where it is
/// half of it.
void expect_close(const AxisDynamics& found, const FreeDevice& device, bool much_friction) {
  ASSERT_TRUE(found.found);
  EXPECT_NEAR(found.mass, device.mass, (much_friction ? 0.1 : 0.03) * device.mass);
  EXPECT_NEAR(found.damping, device.damping, much_friction ? 0.1 * device.damping + 0.05 : 0.1);
  EXPECT_NEAR(found.friction, device.friction, 0.05 * device.friction + 0.01);
  EXPECT_GT(found.delay, device.delay - 1e-4);
  EXPECT_LT(found.delay, device.delay + (much_friction ? 1e-3 : 1e-4));
  EXPECT_LT(found.misfit, much_friction ? 0.15 : 0.02);
}

TEST(IdentificationTest, FindsMassDampingFrictionAndDelay) {
  const auto masses = test::kSanitized ? std::vector{0.15} : std::vector{0.05, 0.15, 0.5};
  const auto dampings = test::kSanitized ? std::vector{1.0} : std::vector{0.3, 1.0, 3.0};
  for (const double mass : masses) {
    for (const double damping : dampings) {
      for (const double friction : {0.0, 0.1, 0.3}) {
        for (const double delay : {0.0, 3e-3}) {
          FreeDevice device;
          device.mass = mass;
          device.damping = damping;
          device.friction = friction;
          device.delay = delay;
          SCOPED_TRACE(testing::Message() << mass << " kg, " << damping << " N s/m, " << friction
                                          << " N, " << delay << " s");
          expect_close(identify(device, 1.2, 1e-3, false), device, friction > 0.2);
        }
      }
    }
  }
}

// It hangs from its weight, has a spring of its own, and counts as coarsely as a Falcon.
TEST(IdentificationTest, FindsThemWhateverTheDeviceHangsFrom) {
  for (const double rate : {500.0, 1000.0, 4000.0}) {
    FreeDevice device;
    device.weight = 1.0;
    device.spring = 30.0;
    device.friction = 0.1;
    device.count = 6.4e-5;
    const AxisDynamics found = identify(device, 1.2, 1.0 / rate, false);
    SCOPED_TRACE(rate);
    ASSERT_TRUE(found.found);
    EXPECT_NEAR(found.mass, 0.15, 0.05 * 0.15);
    EXPECT_NEAR(found.damping, 1.0, 0.15);
    EXPECT_NEAR(found.stiffness, 30.0, 5.0);
    EXPECT_NEAR(found.delay, 1e-3, 3e-4);
  }
}

TEST(IdentificationTest, FindsThoseOfAKnob) {
  FreeDevice knob;
  knob.mass = 2e-4;  // kg m^2
  knob.damping = 1e-3;
  knob.friction = 2e-3;
  knob.count = 7.7e-4;  // 8192 a turn
  const AxisDynamics found = identify(knob, 0.03, 1e-3, true);
  ASSERT_TRUE(found.found);
  EXPECT_NEAR(found.mass, 2e-4, 0.05 * 2e-4);
  EXPECT_NEAR(found.damping, 1e-3, 2e-4);
  EXPECT_NEAR(found.friction, 2e-3, 3e-4);
  EXPECT_NEAR(found.delay, 1e-3, 3e-4);
}

TEST(IdentificationTest, FindsNothingOfWhatDoesNotMoveOrDoesNotStay) {
  FreeDevice stuck;
  stuck.friction = 100.0;
  stuck.count = 6.4e-5;
  EXPECT_FALSE(identify(stuck, 1.2, 1e-3, false).found);
  Identification identification;
  begin_identification(identification, 1U, {1.2, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0));
  Pose measured;
  for (int i = 0; i < 1000 && !is_done(identification); ++i) {
    measured.position.x += 1e-3;  // somebody pulls it away
    take_identification_sample(identification, measured, {}, 1e-3);
  }
  EXPECT_TRUE(identification.strayed);
  const Wrench after = take_identification_sample(identification, measured, {}, 1e-3);
  EXPECT_EQ(after.force, glm::dvec3(0.0));
}

}  // namespace
}  // namespace torsion::engine
