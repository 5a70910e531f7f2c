#pragma once

// Packets between Torsion and a program that drives a device which Torsion cannot: numbers with the
// least significant byte first, float64 as IEEE 754. docs/gateway.md has the table.

#include <array>
#include <cstdint>
#include <optional>

#include "device/protocols/bytes.hpp"
#include "ecs/device_sample.hpp"

namespace torsion::engine {

inline constexpr std::uint32_t kGatewayMagic = 0x47524F54;  // "TORG"
inline constexpr std::uint16_t kGatewayVersion = 1;
inline constexpr std::size_t kGatewaySampleSize = 240;
inline constexpr std::size_t kGatewayAnswerSize = 136;
inline constexpr std::size_t kGatewayChallengeSize = 32;

/// What the client says of its device at one moment.
struct GatewaySample {
  std::uint32_t session = 0;   // any number, another one for each run of the client
  std::uint32_t sequence = 0;  // one more each time, round past the largest
  double time = 0.0;           // s, of the client's clock
  Pose pose;                   // of the handle from the centre of its workspace, world axes
  glm::dvec3 velocity{0.0};    // m/s
  glm::dvec3 turn_rate{0.0};   // rad/s
  std::uint32_t buttons = 0;
  std::uint8_t sensed = kNoAxes;
  std::uint8_t actuated = kNoAxes;
  DeviceTraits traits;
};

/// What becomes of a sample, as the client is told.
enum class GatewayState : std::uint32_t {
  kWaiting = 0,  // no force until the handle is brought to the tool
  kRising = 1,
  kLive = 2,
  kFalling = 3,   // the physics is silent, or has a fault
  kSilent = 4,    // nothing came from the client for too long
  kRefused = 5,   // another client has the tool
  kChecking = 6,  // a small force to see whether it goes where it is pushed
  kOff = 7,       // it went the other way: no force until the client begins anew
};

struct GatewayAnswer {
  std::uint32_t session = 0;
  std::uint32_t sequence = 0;  // of the sample that it answers
  double time = 0.0;           // s, of Torsion's clock
  Wrench wrench;               // to display on the hand, about the handle, world axes
  Pose tool;                   // world
  GatewayState state = GatewayState::kWaiting;
  std::uint32_t faults = 0;  // of the physics, bits
};

/// A number that is used once.
using GatewayNonce = std::array<std::uint8_t, 16>;

/// What a client is told that does not know the nonce yet. It sends its sample again, with that.
struct GatewayChallenge {
  std::uint32_t session = 0;
  std::uint32_t sequence = 0;  // of the sample that it answers
  GatewayNonce nonce{};
};

using GatewaySampleBytes = std::array<std::uint8_t, kGatewaySampleSize>;
using GatewayAnswerBytes = std::array<std::uint8_t, kGatewayAnswerSize>;
using GatewayChallengeBytes = std::array<std::uint8_t, kGatewayChallengeSize>;

GatewaySampleBytes encode_gateway_sample(const GatewaySample& sample);

/// @return nothing for what is no sample of this version: another length, magic or kind, a number
/// that is not finite or out of any device's range, a rotation that is none. The rotation returned
/// is of unit length.
std::optional<GatewaySample> decode_gateway_sample(Bytes bytes);

GatewayAnswerBytes encode_gateway_answer(const GatewayAnswer& answer);

/// @return nothing for what is no answer of this version
std::optional<GatewayAnswer> decode_gateway_answer(Bytes bytes);

GatewayChallengeBytes encode_gateway_challenge(const GatewayChallenge& challenge);

/// @return nothing for what is no challenge of this version
std::optional<GatewayChallenge> decode_gateway_challenge(Bytes bytes);

}  // namespace torsion::engine
