#include "device/protocols/gateway.hpp"

#include <bit>
#include <cmath>
#include <cstring>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace torsion::engine {
namespace {

static_assert(std::endian::native == std::endian::little, "packets are copied as they are");

constexpr std::uint16_t kSampleKind = 1;
constexpr std::uint16_t kAnswerKind = 2;
constexpr std::uint16_t kChallengeKind = 3;

/// Puts values one after another.
class Writer {
 public:
  explicit Writer(std::span<std::uint8_t> bytes) : bytes_(bytes) {}

  template <class T>
  void put(const T& value) {
    std::memcpy(bytes_.data() + at_, &value, sizeof value);
    at_ += sizeof value;
  }
  void put_vector(const glm::dvec3& v) {
    put(v.x);
    put(v.y);
    put(v.z);
  }
  void put_pose(const Pose& pose) {
    put_vector(pose.position);
    for (const double part : {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w}) {
      put(part);
    }
  }

 private:
  std::span<std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

/// Takes values one after another. @pre there are as many bytes
class Reader {
 public:
  explicit Reader(Bytes bytes) : bytes_(bytes) {}

  template <class T>
  T take() {
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  glm::dvec3 take_vector() {
    const auto x = take<double>();
    const auto y = take<double>();
    const auto z = take<double>();
    return {x, y, z};
  }
  Pose take_pose() {
    Pose pose;
    pose.position = take_vector();
    const glm::dvec3 axis = take_vector();
    pose.rotation = glm::dquat(take<double>(), axis.x, axis.y, axis.z);
    return pose;
  }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
};

void put_head(Writer& writer, std::uint16_t kind, std::uint32_t session, std::uint32_t sequence) {
  writer.put(kGatewayMagic);
  writer.put(kGatewayVersion);
  writer.put(kind);
  writer.put(session);
  writer.put(sequence);
}

bool has_head(Reader& reader, std::uint16_t kind) {
  const bool magic = reader.take<std::uint32_t>() == kGatewayMagic;
  const bool version = reader.take<std::uint16_t>() == kGatewayVersion;
  return reader.take<std::uint16_t>() == kind && magic && version;
}

/// The traits in the order of the packet.
template <class Traits, class F>
void for_each_trait(Traits& traits, F&& f) {
  f(traits.damping);
  f(traits.turn_damping);
  f(traits.mass);
  f(traits.inertia);
  f(traits.encoder_step);
  f(traits.encoder_turn_step);
  f(traits.period);
  f(traits.delay);
  f(traits.largest_force);
  f(traits.largest_torque);
  f(traits.largest_stiffness);
  f(traits.largest_turn_stiffness);
}

bool is_small(const glm::dvec3& v, double largest) {
  return std::abs(v.x) <= largest && std::abs(v.y) <= largest && std::abs(v.z) <= largest;
}

/// Whether every number is one that a device may have: also false for what is not a number.
bool is_sound(const GatewaySample& sample) {
  constexpr double kFarthest = 10.0;  // m
  constexpr double kFastest = 100.0;  // m/s
  constexpr double kTurning = 1e3;    // rad/s
  constexpr double kLargestTrait = 1e6;
  constexpr double kUnit = 1e-3;
  bool traits = true;
  for_each_trait(sample.traits,
                 [&](double trait) { traits = traits && trait >= 0.0 && trait <= kLargestTrait; });
  return traits && std::isfinite(sample.time) && is_small(sample.pose.position, kFarthest) &&
         is_small(sample.velocity, kFastest) && is_small(sample.turn_rate, kTurning) &&
         std::abs(glm::length(sample.pose.rotation) - 1.0) <= kUnit && sample.traits.period > 0.0;
}

}  // namespace

GatewaySampleBytes encode_gateway_sample(const GatewaySample& sample) {
  GatewaySampleBytes bytes{};
  Writer writer(bytes);
  put_head(writer, kSampleKind, sample.session, sample.sequence);
  writer.put(sample.time);
  writer.put_pose(sample.pose);
  writer.put_vector(sample.velocity);
  writer.put_vector(sample.turn_rate);
  writer.put(sample.buttons);
  writer.put(std::uint32_t{sample.sensed});
  writer.put(std::uint32_t{sample.actuated});
  writer.put(std::uint32_t{0});  // so that what follows begins at a multiple of 8
  for_each_trait(sample.traits, [&](double trait) { writer.put(trait); });
  return bytes;
}

std::optional<GatewaySample> decode_gateway_sample(Bytes bytes) {
  if (bytes.size() != kGatewaySampleSize) {
    return std::nullopt;
  }
  Reader reader(bytes);
  if (!has_head(reader, kSampleKind)) {
    return std::nullopt;
  }
  GatewaySample sample;
  sample.session = reader.take<std::uint32_t>();
  sample.sequence = reader.take<std::uint32_t>();
  sample.time = reader.take<double>();
  sample.pose = reader.take_pose();
  sample.velocity = reader.take_vector();
  sample.turn_rate = reader.take_vector();
  sample.buttons = reader.take<std::uint32_t>();
  constexpr std::uint32_t kAxes = kTranslationAxes | kRotationAxes | kTurnAxis;
  sample.sensed = static_cast<std::uint8_t>(reader.take<std::uint32_t>() & kAxes);
  sample.actuated = static_cast<std::uint8_t>(reader.take<std::uint32_t>() & kAxes);
  reader.take<std::uint32_t>();
  for_each_trait(sample.traits, [&](double& trait) { trait = reader.take<double>(); });
  if (!is_sound(sample)) {
    return std::nullopt;
  }
  sample.pose.rotation = glm::normalize(sample.pose.rotation);
  return sample;
}

GatewayAnswerBytes encode_gateway_answer(const GatewayAnswer& answer) {
  GatewayAnswerBytes bytes{};
  Writer writer(bytes);
  put_head(writer, kAnswerKind, answer.session, answer.sequence);
  writer.put(static_cast<std::uint32_t>(answer.state));
  writer.put(answer.faults);
  writer.put(answer.time);
  writer.put_vector(answer.wrench.force);
  writer.put_vector(answer.wrench.torque);
  writer.put_pose(answer.tool);
  return bytes;
}

std::optional<GatewayAnswer> decode_gateway_answer(Bytes bytes) {
  if (bytes.size() != kGatewayAnswerSize) {
    return std::nullopt;
  }
  Reader reader(bytes);
  if (!has_head(reader, kAnswerKind)) {
    return std::nullopt;
  }
  GatewayAnswer answer;
  answer.session = reader.take<std::uint32_t>();
  answer.sequence = reader.take<std::uint32_t>();
  const auto state = reader.take<std::uint32_t>();
  if (state > static_cast<std::uint32_t>(GatewayState::kOff)) {
    return std::nullopt;
  }
  answer.state = static_cast<GatewayState>(state);
  answer.faults = reader.take<std::uint32_t>();
  answer.time = reader.take<double>();
  answer.wrench.force = reader.take_vector();
  answer.wrench.torque = reader.take_vector();
  answer.tool = reader.take_pose();
  return answer;
}

GatewayChallengeBytes encode_gateway_challenge(const GatewayChallenge& challenge) {
  GatewayChallengeBytes bytes{};
  Writer writer(bytes);
  put_head(writer, kChallengeKind, challenge.session, challenge.sequence);
  writer.put(challenge.nonce);
  return bytes;
}

std::optional<GatewayChallenge> decode_gateway_challenge(Bytes bytes) {
  if (bytes.size() != kGatewayChallengeSize) {
    return std::nullopt;
  }
  Reader reader(bytes);
  if (!has_head(reader, kChallengeKind)) {
    return std::nullopt;
  }
  GatewayChallenge challenge;
  challenge.session = reader.take<std::uint32_t>();
  challenge.sequence = reader.take<std::uint32_t>();
  challenge.nonce = reader.take<GatewayNonce>();
  return challenge;
}

}  // namespace torsion::engine
