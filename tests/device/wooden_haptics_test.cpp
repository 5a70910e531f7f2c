#include "device/protocols/wooden_haptics.hpp"

#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

TEST(WoodenHapticsTest, ReadsSixEncodersAndTheButton) {
  std::array<std::uint8_t, 64> packet{};  // raw HID pads
  for (std::size_t i = 0; i < 6; ++i) {
    put_int16(packet, 2 * i, static_cast<std::int16_t>(1000 * (static_cast<int>(i) - 3)));
  }
  put_int16(packet, 12, 1);
  const auto input = decode_wooden(packet);
  ASSERT_TRUE(input);
  EXPECT_EQ(input->encoders, (std::array<std::int16_t, 6>{-3000, -2000, -1000, 0, 1000, 2000}));
  EXPECT_EQ(input->info, 1);
  EXPECT_FALSE(decode_wooden(Bytes(packet).first(13)));
}

TEST(WoodenHapticsTest, SendsCurrentsWithinTheStagesLimit) {
  const auto packet = encode_wooden_currents({5000, -5000, 300});
  EXPECT_EQ(int16_at(packet, 0), 2000);
  EXPECT_EQ(int16_at(packet, 2), -2000);
  EXPECT_EQ(int16_at(packet, 4), 300);
  EXPECT_EQ(int16_at(packet, 6), 0);
}

TEST(WoodenHapticsTest, SetsEncodersWithTheWristWhereCurrentsWouldBe) {
  const auto packet = encode_wooden_calibration({1, 2, 3, 4, 5, 6});
  EXPECT_EQ(int16_at(packet, 6), 1);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(int16_at(packet, 2 * i), static_cast<std::int16_t>(4 + i));
    EXPECT_EQ(int16_at(packet, 8 + 2 * i), static_cast<std::int16_t>(1 + i));
  }
}

TEST(WoodenHapticsTest, AtHomeItsArmsAreSquare) {
  const WoodenGeometry geometry = wooden_haptics_2015();
  // Upright b, level c: the wrist is length_c out and length_a + length_b up.
  const glm::dvec3 position =
      wooden_position(geometry, wooden_body_angles(geometry, {geometry.home, 0})) + geometry.origin;
  EXPECT_LT(glm::distance(position, glm::dvec3(0.245, 0.0, 0.285)), 1e-15);
}

TEST(WoodenHapticsTest, JacobianIsTheDerivative) {
  const WoodenGeometry geometry = wooden_haptics_2015();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-1.5, 1.5);
  constexpr double kStep = 1e-6;  // rad
  for (int i = 0; i < 100; ++i) {
    const double a = angle(random);
    const double b = angle(random);
    const glm::dvec3 at(a, b, angle(random));
    const glm::dmat3 jacobian = wooden_jacobian(geometry, at);
    for (glm::length_t joint = 0; joint < 3; ++joint) {
      glm::dvec3 step(0.0);
      step[joint] = kStep;
      const glm::dvec3 difference =
          (wooden_position(geometry, at + step) - wooden_position(geometry, at - step)) /
          (2.0 * kStep);
      EXPECT_LT(glm::distance(jacobian[joint], difference), 1e-9);
    }
  }
}

TEST(WoodenHapticsTest, MotorsDoTheForcesWork) {
  const WoodenGeometry geometry = wooden_haptics_2015();
  WoodenInput input;
  input.encoders = {300, 2500, 6000, 0, 0, 0};
  WoodenInput moved = input;
  moved.encoders = {301, 2502, 5997, 0, 0, 0};
  const glm::dvec3 force(1.0, -2.0, 0.7);  // N
  const glm::dvec3 angles = wooden_body_angles(geometry, input);
  const glm::dvec3 way = wooden_position(geometry, wooden_body_angles(geometry, moved)) -
                         wooden_position(geometry, angles);
  const auto currents = wooden_currents(geometry, angles, force);
  const glm::dvec3 motor_turns =
      glm::dvec3(1.0, 2.0, -3.0) * (2.0 * std::numbers::pi / geometry.counts_per_turn);
  double work = 0.0;
  for (glm::length_t motor = 0; motor < 3; ++motor) {
    work += 1e-3 * currents[static_cast<std::size_t>(motor)] * geometry.torque_constant[motor] *
            motor_turns[motor];
  }
  // Currents are whole milliamperes; the way is short, but not infinitely.
  EXPECT_NEAR(work, glm::dot(force, way), 3e-3 * glm::length(force) * glm::length(way));
}

TEST(WoodenHapticsTest, KeepsTheDirectionOfForcesThatAreTooLarge) {
  const WoodenGeometry geometry = wooden_haptics_2015();
  const glm::dvec3 angles(0.2, 0.3, 1.4);
  const auto small = wooden_currents(geometry, angles, {1.0, 2.0, 3.0});
  const auto large = wooden_currents(geometry, angles, {1e3, 2e3, 3e3});
  int most = 0;
  for (std::size_t motor = 0; motor < 3; ++motor) {
    most = std::max(most, std::abs(int{large[motor]}));
    EXPECT_NEAR(static_cast<double>(large[motor]) * small[0],
                static_cast<double>(large[0]) * small[motor], 3000.0);
  }
  EXPECT_EQ(most, kWoodenLargestCurrent);
  EXPECT_EQ(wooden_currents(geometry, angles, glm::dvec3(std::numeric_limits<double>::infinity())),
            (std::array<std::int16_t, 3>{}));
}

}  // namespace
}  // namespace torsion::engine
