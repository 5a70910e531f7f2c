// The gateway through real sockets of this machine. Nothing here asserts how long something takes,
// but that a client which says nothing is told that it is silent.

#include "device/gateway/gateway.hpp"

#include <array>
#include <chrono>
#include <cstring>
#include <limits>
#include <random>
#include <thread>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/device/gateway_client.hpp"

namespace torsion::engine {
namespace {

using test::any_port;
using test::GatewayClient;
using test::GatewayListener;
using test::good_sample;
using test::start;

TEST(GatewayPacketTest, WhatIsEncodedIsDecoded) {
  const GatewaySample sent = good_sample();
  const auto came = decode_gateway_sample(encode_gateway_sample(sent));
  ASSERT_TRUE(came);
  EXPECT_EQ(came->session, 7U);
  EXPECT_EQ(came->time, 1.5);
  EXPECT_EQ(came->pose.position, sent.pose.position);
  EXPECT_LT(glm::length(came->pose.rotation - sent.pose.rotation), 1e-15);
  EXPECT_EQ(came->velocity, sent.velocity);
  EXPECT_EQ(came->turn_rate, sent.turn_rate);
  EXPECT_EQ(came->buttons, 5U);
  EXPECT_EQ(came->sensed, sent.sensed);
  EXPECT_EQ(came->actuated, sent.actuated);
  EXPECT_EQ(came->traits.damping, 2.0);
  EXPECT_EQ(came->traits.largest_turn_stiffness, 12.0);

  GatewayAnswer answer{
      7, 9, 2.5, {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}, sent.pose, GatewayState::kFalling, 0x11};
  const auto told = decode_gateway_answer(encode_gateway_answer(answer));
  ASSERT_TRUE(told);
  EXPECT_EQ(told->sequence, 9U);
  EXPECT_EQ(told->wrench.torque, answer.wrench.torque);
  EXPECT_EQ(told->tool.position, sent.pose.position);
  EXPECT_EQ(told->state, GatewayState::kFalling);
  EXPECT_EQ(told->faults, 0x11U);
}

TEST(GatewayPacketTest, TheBytesAreWhereTheDocumentSays) {
  // As a client in another language writes them: docs/gateway.md.
  const GatewaySampleBytes bytes = encode_gateway_sample(good_sample());
  EXPECT_EQ(std::memcmp(bytes.data(), "TORG\x01\x00\x01\x00\x07\x00\x00\x00\x01\x00\x00\x00", 16),
            0);
  const auto number_at = [&bytes](std::size_t at) {
    double number = 0.0;
    std::memcpy(&number, bytes.data() + at, sizeof number);
    return number;
  };
  EXPECT_EQ(number_at(16), 1.5);
  EXPECT_EQ(number_at(24), 0.01);
  EXPECT_GT(number_at(72), 0.8);  // w is the last of the rotation
  EXPECT_EQ(number_at(80), 0.1);
  EXPECT_EQ(number_at(112), 1.0);
  EXPECT_EQ(bytes[128], 5);
  EXPECT_EQ(bytes[132], 3);
  EXPECT_EQ(bytes[136], 1);
  EXPECT_EQ(number_at(144), 2.0);
  EXPECT_EQ(number_at(192), 1e-3);
  EXPECT_EQ(number_at(232), 12.0);
}

TEST(GatewayPacketTest, NothingElseIsTakenForASample) {
  const GatewaySampleBytes bytes = encode_gateway_sample(good_sample());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_FALSE(decode_gateway_sample(Bytes(bytes).first(length)));
  }
  for (const std::size_t head : {0U, 3U, 4U, 6U}) {
    GatewaySampleBytes wrong = bytes;
    wrong[head] ^= 1U;
    EXPECT_FALSE(decode_gateway_sample(wrong)) << head;
  }
  const auto with = [](auto&& change) {
    GatewaySample sample = good_sample();
    change(sample);
    return decode_gateway_sample(encode_gateway_sample(sample)).has_value();
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(with([](GatewaySample&) {}));
  for (const double bad : {kNan, kInf, -kInf, 1e300}) {
    EXPECT_FALSE(with([bad](GatewaySample& s) { s.pose.position.y = bad; })) << bad;
    EXPECT_FALSE(with([bad](GatewaySample& s) { s.pose.rotation.w = bad; })) << bad;
    EXPECT_FALSE(with([bad](GatewaySample& s) { s.velocity.x = bad; })) << bad;
    EXPECT_FALSE(with([bad](GatewaySample& s) { s.turn_rate.z = bad; })) << bad;
    EXPECT_FALSE(with([bad](GatewaySample& s) { s.traits.mass = bad; })) << bad;
  }
  EXPECT_FALSE(with([](GatewaySample& s) { s.time = kNan; }));
  EXPECT_FALSE(with([](GatewaySample& s) { s.pose.rotation = glm::dquat(0.0, 0.0, 0.0, 0.0); }));
  EXPECT_FALSE(with([](GatewaySample& s) { s.traits.damping = -1.0; }));
  EXPECT_FALSE(with([](GatewaySample& s) { s.traits.period = 0.0; }));
  std::mt19937 random(3);
  for (int i = 0; i < 20000; ++i) {
    GatewaySampleBytes noisy = bytes;
    for (int bits = 0; bits < 4; ++bits) {
      noisy[random() % noisy.size()] ^= static_cast<std::uint8_t>(1U << (random() % 8));
    }
    if (const auto came = decode_gateway_sample(noisy)) {
      EXPECT_NEAR(glm::length(came->pose.rotation), 1.0, 1e-12);
      EXPECT_LE(glm::length(came->pose.position), 20.0);
    }
  }
}

TEST(GatewayTest, ASampleIsAnsweredAndSilenceEndsTheForce) {
  GatewayListener listener;
  const auto gateway = start(listener, any_port());
  ASSERT_TRUE(gateway);
  const GatewayClient client(gateway->port());
  client.send(7, 1, 0.25);
  const auto answer = client.receive();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->session, 7U);
  EXPECT_EQ(answer->sequence, 1U);
  EXPECT_EQ(answer->state, GatewayState::kLive);
  EXPECT_EQ(answer->wrench.force.y, -2.0);
  EXPECT_EQ(listener.x, 0.25);
  // Nothing follows: it is told so, with no force, though the sink wants some.
  const auto silent = client.receive();
  ASSERT_TRUE(silent);
  EXPECT_EQ(silent->state, GatewayState::kSilent);
  EXPECT_EQ(silent->wrench.force, glm::dvec3(0.0));
  EXPECT_NE(listener.state, static_cast<int>(DeviceState::kLive));
  const std::uint32_t epoch = listener.epoch;
  // It goes on: a new beginning, whose rate knows nothing of the silence.
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  client.send(7, 2);
  ASSERT_TRUE(client.receive(GatewayState::kLive));
  EXPECT_EQ(listener.epoch, epoch + 1);
  EXPECT_EQ(listener.period, good_sample().traits.period);
  EXPECT_GE(gateway->counts().silences, 1U);
}

TEST(GatewayTest, OldAndDoubledSamplesAndNoiseAreLeftOut) {
  GatewayListener listener;
  const auto gateway = start(listener, any_port());
  ASSERT_TRUE(gateway);
  const GatewayClient client(gateway->port());
  client.send_bytes(std::array<std::uint8_t, 3>{1, 2, 3});
  client.send_bytes(std::array<std::uint8_t, 400>{});
  // Past the largest number and round; each is sent until it is the one that was answered.
  for (const std::uint32_t sequence : {0xFFFFFFFEU, 0xFFFFFFFFU, 0U, 1U}) {
    client.send(7, sequence, 0.1);
    const auto answer = client.receive(GatewayState::kLive);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->sequence, sequence);
  }
  EXPECT_EQ(gateway->counts().garbage, 2U);
  // A burst that ends with old ones: whatever was read together, none of those is answered.
  for (int i = 0; i < 50; ++i) {
    client.send(7, 100, 0.2);
    client.send(7, 100, 0.3);  // doubled
    client.send(7, 99, 0.4);   // overtaken
  }
  GatewayCounts counts = gateway->counts();
  for (int i = 0; i < 6000 && counts.samples + counts.stale < 154; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    counts = gateway->counts();
  }
  EXPECT_EQ(counts.samples + counts.stale, 154U);
  EXPECT_LE(counts.samples, 4U + 1U + counts.silences);  // after a silence anything is new
}

TEST(GatewayTest, OneClientHasTheToolUntilItIsSilent) {
  GatewayListener listener;
  const auto gateway = start(listener, any_port());
  ASSERT_TRUE(gateway);
  const GatewayClient first(gateway->port());
  const GatewayClient second(gateway->port());
  // While the first talks, the second is refused; on a busy machine the first may fall silent
  // between, and then the second gets the tool: so often that it is seen.
  bool refused = false;
  for (std::uint32_t i = 1; i < 200 && !refused; ++i) {
    first.send(7, i);
    second.send(8, i);
    const auto answer = second.receive();
    ASSERT_TRUE(answer);
    if (answer->state == GatewayState::kRefused) {
      refused = true;
      EXPECT_EQ(answer->wrench.force, glm::dvec3(0.0));
      EXPECT_EQ(answer->session, 8U);
    }
  }
  EXPECT_TRUE(refused);
  bool taken = false;
  for (std::uint32_t i = 1000; i < 1200 && !taken; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    second.send(8, i);
    const auto answer = second.receive();
    ASSERT_TRUE(answer);
    taken = answer->state == GatewayState::kLive;
  }
  EXPECT_TRUE(taken);
}

TEST(GatewayTest, AUnixSocketDoesTheSameAndIsOnlyTheUsers) {
  char folder[] = "/tmp/torsion_gateway_XXXXXX";
  ASSERT_NE(::mkdtemp(folder), nullptr);
  const std::string path = std::string(folder) + "/server";
  GatewayListener listener;
  {
    GatewayOptions options;
    options.socket = path;
    const auto gateway = start(listener, options);
    ASSERT_TRUE(gateway);
    EXPECT_EQ(std::filesystem::status(path).permissions() & std::filesystem::perms::mask,
              std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    const GatewayClient client(path, std::string(folder) + "/client");
    client.send(7, 1);
    const auto answer = client.receive();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->wrench.force.y, -2.0);
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  std::filesystem::remove_all(folder);
}

TEST(GatewayTest, AnEndTellsTheClientThatThereIsNoForce) {
  GatewayListener listener;
  auto gateway = start(listener, any_port());
  ASSERT_TRUE(gateway);
  const GatewayClient client(gateway->port());
  client.send(7, 1);
  ASSERT_TRUE(client.receive(GatewayState::kLive));
  gateway.reset();
  const auto last = client.receive(GatewayState::kSilent);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->wrench.force, glm::dvec3(0.0));
}

TEST(GatewayTest, AddressesThatAreNoneAreSaid) {
  EXPECT_EQ(gateway_of("gateway").value().port, kGatewayPort);
  EXPECT_EQ(gateway_of("gateway:9000").value().port, 9000);
  EXPECT_EQ(gateway_of("gateway:/run/t.sock").value().socket, "/run/t.sock");
  for (const char* wrong : {"gateway:", "gateway:0", "gateway:65536", "gateway:x", "gateway:9 ",
                            "gatewayx", "gateway9000", "gateway:-1"}) {
    const auto options = gateway_of(wrong);
    ASSERT_FALSE(options.ok()) << wrong;
    EXPECT_NE(options.error().text.find("expected gateway"), std::string::npos);
  }
  GatewayListener listener;
  const auto gateway = start(listener, any_port());
  ASSERT_TRUE(gateway);
  GatewayOptions same;
  same.port = gateway->port();
  const auto again = Gateway::start(same, listener.sink());
  ASSERT_FALSE(again.ok());
  EXPECT_NE(again.error().text.find("in use"), std::string::npos) << again.error().text;
  GatewayOptions nowhere;
  nowhere.socket = "/nowhere/at/all";
  EXPECT_FALSE(Gateway::start(nowhere, listener.sink()).ok());
  nowhere.socket = "/" + std::string(200, 'x');
  const auto too_long = Gateway::start(nowhere, listener.sink());
  ASSERT_FALSE(too_long.ok());
  EXPECT_NE(too_long.error().text.find("longer than"), std::string::npos);
}

}  // namespace
}  // namespace torsion::engine
