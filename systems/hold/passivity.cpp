#include "systems/hold/passivity.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace torsion::engine {
namespace {

constexpr double kSlowest = 1e-9;  // m or rad a sample: slower, damping would divide by nothing
// Used where a device's own are not known: a small handle alone, 50 g with a radius of 20 mm. The
// mechanism and the fingers only add to it, and with more mass a late damper may do more.
constexpr double kLightMass = 0.05;     // kg
constexpr double kLightInertia = 1e-5;  // kg m^2

/// @param held  force on the hand over the past interval
/// @param way   of the handle over it
/// @return the force to display over the next one
glm::dvec3 keep_channel_passive(EnergyBooks& books, const glm::dvec3& held, const glm::dvec3& way,
                                const glm::dvec3& wanted, double largest_damping,
                                double largest_stored, double period) {
  // The force on the hand does the work held . way on it.
  books.stored = std::min(books.stored - glm::dot(held, way), largest_stored);
  const double square = glm::dot(way, way);
  if (books.stored >= 0.0 || square < kSlowest * kSlowest) {
    return wanted;
  }
  // A damper of b takes b v^2 T = b way^2 / T over the next interval, should the hand go on.
  const double damping = std::min(-books.stored * period / square, largest_damping);
  books.dissipated += damping * square / period;
  return wanted - damping * way / period;
}

}  // namespace

PassivityLimits choose_passivity(const DeviceTraits& device) {
  constexpr double kShareOfForce = 0.02;
  const double lag = device.period + 2.0 * device.delay;
  const auto damping = [&](double inertia, double largest, double count) {
    const double most = 0.5 * inertia / lag;
    return count > 0.0 ? std::min(most, kShareOfForce * largest * device.period / count) : most;
  };
  PassivityLimits limits;
  limits.largest_damping = damping(device.mass > 0.0 ? device.mass : kLightMass,
                                   device.largest_force, device.encoder_step);
  limits.largest_turn_damping = damping(device.inertia > 0.0 ? device.inertia : kLightInertia,
                                        device.largest_torque, device.encoder_turn_step);
  limits.delay = static_cast<std::uint32_t>(
      std::clamp(std::round(device.delay / device.period), 0.0, 1.0 * kLongestDelay));
  return limits;
}

Wrench keep_passive(PassivityState& state, const PassivityLimits& limits, const Wrench& wanted,
                    const glm::dvec3& shift, const glm::dvec3& turn, double period) {
  const auto count = static_cast<std::uint32_t>(state.sent.size());
  const Wrench& held =
      state.sent[(state.samples + count - 1 - std::min(limits.delay, kLongestDelay)) % count];
  const Wrench next{
      keep_channel_passive(state.translation, held.force, shift, wanted.force,
                           limits.largest_damping, limits.largest_stored, period),
      keep_channel_passive(state.rotation, held.torque, turn, wanted.torque,
                           limits.largest_turn_damping, limits.largest_stored, period)};
  state.sent[state.samples % count] = next;
  state.samples = (state.samples + 1) % count;
  return next;
}

void note_sent(PassivityState& state, const Wrench& sent) {
  const auto count = static_cast<std::uint32_t>(state.sent.size());
  state.sent[(state.samples + count - 1) % count] = sent;
}

}  // namespace torsion::engine
