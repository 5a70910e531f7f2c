#include "device/protocols/falcon_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

namespace torsion::engine {
namespace {

using std::numbers::pi;

// m
constexpr double kA = 0.060;     // a: motor arm
constexpr double kB = 0.1025;    // b: forearm
constexpr double kC = 0.01443;   // c: from the grip's middle to a forearm's end
constexpr double kD = 0.01125;   // d and e: links between forearm and arm, forearm and grip
constexpr double kF = -0.025;    // f: sideways offset of the forearm
constexpr double kR = 0.0400;    // r: from the middle to a motor's axis
constexpr double kS = -0.02309;  // s: along it

constexpr std::array<double, 3> kPhi = {pi / 2.0 + pi / 12.0, -pi / 6.0 + pi / 12.0,
                                        -5.0 * pi / 6.0 + pi / 12.0};

constexpr double kCountsPerTurn = 4.0 * 320.0;
constexpr double kGear = 0.110 / 0.01425;  // diameters of the motor's drum and of its shaft
constexpr double kZeroAngle = 35.0 * pi / 180.0;
// Per N m. Nominal: libnifalcon's own scale is -10000, but the packets of the maker's kit that it
// keeps (util/translate_packet.py) have 0.36 to 0.44 of that for the same force. The smaller one
// makes no force larger than was asked for.
constexpr double kMotorPerTorque = -4000.0;
constexpr double kExact = 1e-12;  // rad

/// The three angles of one leg: of the motor, of the forearm in the leg's plane, and out of it.
struct LegAngles {
  double arm;
  double forearm;
  double sideways;
};

std::optional<LegAngles> leg_angles(const glm::dvec3& position, std::size_t leg) {
  const double cos_phi = std::cos(kPhi[leg]);
  const double sin_phi = std::sin(kPhi[leg]);
  const double u = cos_phi * position.x + sin_phi * position.y - kR;
  const double v = -sin_phi * position.x + cos_phi * position.y - kS;
  const double cos_sideways = (v + kF) / kB;
  if (!(std::abs(cos_sideways) < 1.0)) {
    return std::nullopt;
  }
  LegAngles angles{};
  angles.sideways = std::acos(cos_sideways);
  // What the forearm and its two links reach in the leg's plane.
  const double reach = 2.0 * kD + kB * std::sin(angles.sideways);
  const double across = u + kC;
  const double along = position.z;
  const double square = across * across + along * along;
  const double cos_knee = (kA * kA + square - reach * reach) / (2.0 * kA * std::sqrt(square));
  if (!(std::abs(cos_knee) < 1.0)) {
    return std::nullopt;
  }
  angles.arm = std::atan2(along, across) - std::acos(cos_knee);  // the knee is outside
  angles.forearm =
      std::atan2(along - kA * std::sin(angles.arm), across - kA * std::cos(angles.arm));
  return angles;
}

/// d(arm angle)/d(position): the leg turns by what the forearm is pushed along itself.
glm::dvec3 leg_gradient(const LegAngles& angles, std::size_t leg) {
  const double n = kA * std::sin(angles.sideways) * std::sin(angles.forearm - angles.arm);
  const double u = std::cos(angles.forearm) * std::sin(angles.sideways);
  const double v = std::cos(angles.sideways);
  const double w = std::sin(angles.forearm) * std::sin(angles.sideways);
  const double cos_phi = std::cos(kPhi[leg]);
  const double sin_phi = std::sin(kPhi[leg]);
  return glm::dvec3(cos_phi * u - sin_phi * v, sin_phi * u + cos_phi * v, w) / n;
}

}  // namespace

glm::dvec3 falcon_joint_angles(const FalconInput& input) {
  glm::dvec3 angles;
  for (glm::length_t leg = 0; leg < 3; ++leg) {
    const auto counts = static_cast<double>(input.encoders[static_cast<std::size_t>(leg)]);
    angles[leg] = counts * (2.0 * pi / kCountsPerTurn / kGear) + kZeroAngle;
  }
  return angles;
}

std::optional<glm::dvec3> falcon_inverse(const glm::dvec3& position) {
  glm::dvec3 angles;
  for (glm::length_t leg = 0; leg < 3; ++leg) {
    const auto found = leg_angles(position, static_cast<std::size_t>(leg));
    if (!found) {
      return std::nullopt;
    }
    angles[leg] = found->arm;
  }
  return angles;
}

glm::dmat3 falcon_jacobian(const glm::dvec3& position) {
  glm::dmat3 rows(0.0);
  for (glm::length_t leg = 0; leg < 3; ++leg) {
    const auto row = static_cast<std::size_t>(leg);
    if (const auto angles = leg_angles(position, row)) {
      rows[leg] = leg_gradient(*angles, row);
    }
  }
  return glm::transpose(rows);
}

std::optional<glm::dvec3> falcon_forward(const glm::dvec3& angles, const glm::dvec3& near) {
  constexpr int kMostSteps = 30;
  constexpr double kLongestIteration = 0.02;  // m: farther, the legs may leave their reach
  glm::dvec3 position = near;
  for (int step = 0; step < kMostSteps; ++step) {
    const auto found = falcon_inverse(position);
    if (!found) {
      return std::nullopt;
    }
    const glm::dvec3 off = angles - *found;
    if (glm::all(glm::lessThan(glm::abs(off), glm::dvec3(kExact)))) {
      return position;
    }
    glm::dvec3 move = glm::inverse(falcon_jacobian(position)) * off;
    const double length = glm::length(move);
    if (!(length < 1.0)) {
      return std::nullopt;  // a singular pose, or NaN
    }
    position += length > kLongestIteration ? move * (kLongestIteration / length) : move;
  }
  return std::nullopt;
}

std::array<std::int16_t, 3> falcon_motors(const glm::dvec3& position, const glm::dvec3& force) {
  std::array<std::int16_t, 3> motors{};
  if (!falcon_inverse(position)) {
    return motors;
  }
  // Power: torque . d(angles) = force . d(position).
  const glm::dvec3 torque = glm::transpose(glm::inverse(falcon_jacobian(position))) * force;
  glm::dvec3 values = kMotorPerTorque * torque;
  const glm::dvec3 sizes = glm::abs(values);
  const double largest = std::max({sizes.x, sizes.y, sizes.z});
  if (!std::isfinite(largest)) {
    return motors;
  }
  if (largest > kFalconLargestMotor) {
    values *= kFalconLargestMotor / largest;
  }
  for (glm::length_t leg = 0; leg < 3; ++leg) {
    motors[static_cast<std::size_t>(leg)] = static_cast<std::int16_t>(std::lround(values[leg]));
  }
  return motors;
}

}  // namespace torsion::engine
