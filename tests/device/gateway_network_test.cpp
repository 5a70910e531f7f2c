// A gateway that other machines reach: who has its secret holds the tool, and nobody else, whatever
// he has listened to. Nothing here asserts how long something takes.

#include <algorithm>
#include <chrono>
#include <string_view>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "device/gateway/authentication.hpp"
#include "tests/device/gateway_client.hpp"

namespace torsion::engine {
namespace {

using test::any_port;
using test::GatewayClient;
using test::GatewayListener;
using test::good_sample;
using test::start;
using Packet = std::vector<std::uint8_t>;

const Packet kSecret(20, 0x5A);

GatewayOptions on_the_network() {
  GatewayOptions options = any_port();
  options.address = "0.0.0.0";
  options.secret = kSecret;
  return options;
}

Packet tagged(Bytes packet, const GatewayNonce& nonce, Bytes secret = kSecret) {
  Packet bytes(packet.begin(), packet.end());
  const GatewayTag tag = authentication_tag(secret, nonce, packet);
  bytes.insert(bytes.end(), tag.begin(), tag.end());
  return bytes;
}

Packet sample_of(std::uint32_t session, std::uint32_t sequence, const GatewayNonce& nonce) {
  GatewaySample sample = good_sample();
  sample.session = session;
  sample.sequence = sequence;
  return tagged(encode_gateway_sample(sample), nonce);
}

Bytes without_tag(Bytes bytes) {
  return bytes.first(bytes.size() - std::min(bytes.size(), kGatewayTagSize));
}

/// As a client begins: the number that its tags have to be over.
GatewayNonce ask_nonce(const GatewayClient& client, std::uint32_t session, std::uint32_t sequence) {
  client.send_bytes(sample_of(session, sequence, kNoNonce));
  for (int i = 0; i < 100; ++i) {
    const Packet came = client.receive_bytes();
    const auto challenge = decode_gateway_challenge(without_tag(came));
    if (!challenge) {
      continue;  // a silence of before
    }
    EXPECT_TRUE(is_authentic(kSecret, challenge->nonce, came));
    EXPECT_EQ(challenge->session, session);
    EXPECT_EQ(challenge->sequence, sequence);
    return challenge->nonce;
  }
  ADD_FAILURE() << "no challenge came";
  return kNoNonce;
}

void wait_for_garbage(const Gateway& gateway, std::uint64_t count) {
  for (int i = 0; i < 6000 && gateway.counts().garbage < count; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(gateway.counts().garbage, count);
}

TEST(GatewayAuthenticationTest, TheTagIsTheHmacOfRfc4231) {
  // Its test case 6: the first 16 bytes of the message stand for the nonce.
  const Packet key(131, 0xAA);
  const std::string_view message = "Test Using Larger Than Block-Size Key - Hash Key First";
  GatewayNonce nonce{};
  std::copy_n(message.begin(), nonce.size(), nonce.begin());
  const Packet rest(message.begin() + nonce.size(), message.end());
  const GatewayTag expected = {0x60, 0xE4, 0x31, 0x59, 0x1E, 0xE0, 0xB6, 0x7F,
                               0x0D, 0x8A, 0x26, 0xAA, 0xCB, 0xF5, 0xB7, 0x7F};
  EXPECT_EQ(authentication_tag(key, nonce, rest), expected);
}

TEST(GatewayAuthenticationTest, AnyOtherBitIsNotAuthentic) {
  const Packet good = sample_of(7, 1, kNoNonce);
  ASSERT_TRUE(is_authentic(kSecret, kNoNonce, good));
  for (std::size_t i = 0; i < 8 * good.size(); ++i) {
    Packet other = good;
    other[i / 8] ^= static_cast<std::uint8_t>(1U << (i % 8));
    EXPECT_FALSE(is_authentic(kSecret, kNoNonce, other)) << i;
  }
  EXPECT_FALSE(is_authentic(kSecret, draw_nonce(), good));
  EXPECT_FALSE(is_authentic(Packet(20, 0x5B), kNoNonce, good));
  EXPECT_FALSE(is_authentic(kSecret, kNoNonce, Bytes(good).first(15)));
  EXPECT_NE(draw_nonce(), draw_nonce());
}

TEST(GatewayAuthenticationTest, TheChallengeIsAsTheDocumentSays) {
  GatewayNonce nonce{};
  nonce[0] = 0x11;
  nonce[15] = 0x99;
  const GatewayChallengeBytes bytes = encode_gateway_challenge({7, 9, nonce});
  const Packet head = {'T', 'O', 'R', 'G', 1, 0, 3, 0, 7, 0, 0, 0, 9, 0, 0, 0, 0x11};
  EXPECT_TRUE(std::equal(head.begin(), head.end(), bytes.begin()));
  EXPECT_EQ(bytes[31], 0x99);
  EXPECT_EQ(decode_gateway_challenge(bytes)->nonce, nonce);
  EXPECT_FALSE(decode_gateway_challenge(Bytes(bytes).first(31)));
}

TEST(GatewayNetworkTest, WhoHasTheSecretHoldsTheTool) {
  GatewayListener listener;
  const auto gateway = start(listener, on_the_network());
  ASSERT_TRUE(gateway);
  const GatewayClient client(gateway->port());
  const GatewayNonce nonce = ask_nonce(client, 7, 1);
  EXPECT_EQ(gateway->counts().samples, 0U);  // what was tagged over no nonce held nothing
  client.send_bytes(sample_of(7, 1, nonce));
  const Packet came = client.receive_bytes();
  EXPECT_TRUE(is_authentic(kSecret, nonce, came));
  const auto answer = decode_gateway_answer(without_tag(came));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->sequence, 1U);
  EXPECT_EQ(answer->wrench.force.y, -2.0);
  EXPECT_EQ(gateway->counts().garbage, 0U);
}

TEST(GatewayNetworkTest, NobodyElseDoesOrGetsAWord) {
  GatewayListener listener;
  const auto gateway = start(listener, on_the_network());
  ASSERT_TRUE(gateway);
  const GatewayClient stranger(gateway->port());
  const GatewaySampleBytes plain = encode_gateway_sample(good_sample());
  stranger.send_bytes(plain);
  wait_for_garbage(*gateway, 1);
  EXPECT_EQ(listener.trouble, DeviceTrouble::kWrongSecret);
  stranger.send_bytes(tagged(plain, kNoNonce, Packet(20, 0x5B)));
  wait_for_garbage(*gateway, 2);
  Packet changed = sample_of(7, 1, kNoNonce);
  changed[24] ^= 1U;
  stranger.send_bytes(changed);
  wait_for_garbage(*gateway, 3);
  EXPECT_EQ(gateway->counts().samples, 0U);
  // The first packet that it ever gets is for the first that is right.
  stranger.send_bytes(sample_of(9, 77, kNoNonce));
  const auto first = decode_gateway_challenge(without_tag(stranger.receive_bytes()));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->sequence, 77U);
}

TEST(GatewayNetworkTest, WhatWasRecordedIsWorthNothingAfterASilence) {
  GatewayListener listener;
  const auto gateway = start(listener, on_the_network());
  ASSERT_TRUE(gateway);
  const GatewayClient client(gateway->port());
  const GatewayNonce nonce = ask_nonce(client, 7, 1);
  const Packet recorded = sample_of(7, 1, nonce);
  client.send_bytes(recorded);
  while (gateway->counts().silences == 0) {  // nothing follows
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  client.send_bytes(recorded);
  wait_for_garbage(*gateway, 1);
  EXPECT_EQ(gateway->counts().samples, 1U);
  EXPECT_NE(listener.state, static_cast<int>(DeviceState::kLive));
  const GatewayNonce another = ask_nonce(client, 7, 2);
  EXPECT_NE(another, nonce);
  client.send_bytes(sample_of(7, 2, another));
  while (gateway->counts().samples < 2) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

TEST(GatewayNetworkTest, ATagWithoutASecretToCheckItIsSaid) {
  GatewayListener listener;
  const auto gateway = start(listener, any_port());
  ASSERT_TRUE(gateway);
  const GatewayClient client(gateway->port());
  client.send_bytes(sample_of(7, 1, kNoNonce));
  wait_for_garbage(*gateway, 1);
  EXPECT_EQ(listener.trouble, DeviceTrouble::kWrongSecret);
  client.send(7, 2);
  EXPECT_TRUE(client.receive(GatewayState::kLive));
  EXPECT_EQ(listener.trouble, DeviceTrouble::kNone);
}

TEST(GatewayNetworkTest, NoOtherMachineWithoutASecret) {
  GatewayListener listener;
  for (const char* const address : {"0.0.0.0", "::", "192.0.2.1", "127.0.0.1:80", "localhost"}) {
    GatewayOptions options = any_port();
    options.address = address;
    options.secret = Packet(kShortestSecret - 1, 1);
    const auto gateway = Gateway::start(options, listener.sink());
    ASSERT_FALSE(gateway.ok()) << address;
    EXPECT_NE(gateway.error().text.find("only with a secret"), std::string::npos) << address;
  }
  for (const auto& [address, word] : {std::pair{"localhost", "in numbers"},
                                      {"1.2.3", "address"},
                                      {"192.0.2.1", "assign"}}) {  // none of ours: RFC 5737
    GatewayOptions options = on_the_network();
    options.address = address;
    const auto gateway = Gateway::start(options, listener.sink());
    ASSERT_FALSE(gateway.ok()) << address;
    EXPECT_NE(gateway.error().text.find(word), std::string::npos) << gateway.error().text;
  }
}

}  // namespace
}  // namespace torsion::engine
