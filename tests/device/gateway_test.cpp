// The gateway through real sockets of this machine. Nothing here asserts how long something takes,
// but that a client which says nothing is told that it is silent.

#include "device/gateway/gateway.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <limits>
#include <optional>
#include <random>
#include <thread>

#include <arpa/inet.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace torsion::engine {
namespace {

GatewaySample good_sample() {
  GatewaySample sample;
  sample.session = 7;
  sample.sequence = 1;
  sample.time = 1.5;
  sample.pose = {{0.01, 0.02, -0.03}, glm::normalize(glm::dquat(0.9, 0.1, 0.2, -0.3))};
  sample.velocity = {0.1, 0.0, -0.2};
  sample.turn_rate = {0.0, 1.0, 0.0};
  sample.buttons = 5;
  sample.sensed = kTranslationAxes | kRotationAxes;
  sample.actuated = kTranslationAxes;
  sample.traits.damping = 2.0;
  sample.traits.mass = 0.1;
  sample.traits.period = 1e-3;
  sample.traits.largest_force = 3.3;
  sample.traits.largest_turn_stiffness = 12.0;
  return sample;
}

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

/// What the gateway's thread tells, for the test's.
struct Listener {
  std::atomic<std::uint64_t> calls{0};
  std::atomic<std::uint32_t> epoch{0};
  std::atomic<int> state{0};
  std::atomic<double> x{0.0};
  std::atomic<double> period{0.0};

  static Wrench on_sample(void* context, const DeviceSample& sample) {
    auto& self = *static_cast<Listener*>(context);
    self.epoch = sample.epoch;
    self.state = static_cast<int>(sample.state);
    self.x = sample.pose.position.x;
    self.period = sample.traits.period;
    ++self.calls;
    return {{0.0, -2.0, 0.0}, glm::dvec3(0.0)};  // also where nobody should get it
  }
  static void describe(void* /*context*/, GatewayAnswer& answer) {
    answer.state = GatewayState::kLive;
  }
  GatewaySink sink() { return {{this, on_sample}, describe}; }
};

/// A client on its own socket.
class Client {
 public:
  explicit Client(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    wait_no_longer_than_a_minute();
  }
  Client(const std::string& server, const std::string& own)
      : socket_(::socket(AF_UNIX, SOCK_DGRAM, 0)) {
    const auto address = [](const std::string& path) {
      sockaddr_un made{};
      made.sun_family = AF_UNIX;
      std::strcpy(made.sun_path, path.c_str());
      return made;
    };
    const sockaddr_un mine = address(own);
    const sockaddr_un to = address(server);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&mine), sizeof mine), 0);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    wait_no_longer_than_a_minute();
  }
  ~Client() { ::close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  Client(Client&&) = delete;
  Client& operator=(Client&&) = delete;

  void send_bytes(Bytes bytes) const {
    EXPECT_EQ(::send(socket_, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  }
  void send(std::uint32_t session, std::uint32_t sequence, double x = 0.0) const {
    GatewaySample sample = good_sample();
    sample.session = session;
    sample.sequence = sequence;
    sample.pose.position.x = x;
    send_bytes(encode_gateway_sample(sample));
  }
  [[nodiscard]] std::optional<GatewayAnswer> receive() const {
    std::array<std::uint8_t, 512> bytes{};
    const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), 0);
    return size < 0 ? std::nullopt
                    : decode_gateway_answer(Bytes(bytes).first(static_cast<std::size_t>(size)));
  }
  /// The next answer in this state, past others.
  [[nodiscard]] std::optional<GatewayAnswer> receive(GatewayState state) const {
    for (int i = 0; i < 1000; ++i) {
      const auto answer = receive();
      if (!answer || answer->state == state) {
        return answer;
      }
    }
    return std::nullopt;
  }

 private:
  void wait_no_longer_than_a_minute() const {
    const timeval minute{60, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &minute, sizeof minute);
  }
  int socket_;
};

std::unique_ptr<Gateway> start(Listener& listener, GatewayOptions options) {
  auto gateway = Gateway::start(std::move(options), listener.sink());
  EXPECT_TRUE(gateway.ok()) << gateway.error().text;
  return gateway.ok() ? std::move(gateway).value() : nullptr;
}

GatewayOptions any_port() {
  GatewayOptions options;
  options.port = 0;
  return options;
}

TEST(GatewayTest, ASampleIsAnsweredAndSilenceEndsTheForce) {
  Listener listener;
  const auto gateway = start(listener, any_port());
  ASSERT_TRUE(gateway);
  const Client client(gateway->port());
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
  Listener listener;
  const auto gateway = start(listener, any_port());
  ASSERT_TRUE(gateway);
  const Client client(gateway->port());
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
  Listener listener;
  const auto gateway = start(listener, any_port());
  ASSERT_TRUE(gateway);
  const Client first(gateway->port());
  const Client second(gateway->port());
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
  Listener listener;
  {
    GatewayOptions options;
    options.socket = path;
    const auto gateway = start(listener, options);
    ASSERT_TRUE(gateway);
    EXPECT_EQ(std::filesystem::status(path).permissions() & std::filesystem::perms::mask,
              std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    const Client client(path, std::string(folder) + "/client");
    client.send(7, 1);
    const auto answer = client.receive();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->wrench.force.y, -2.0);
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  std::filesystem::remove_all(folder);
}

TEST(GatewayTest, AnEndTellsTheClientThatThereIsNoForce) {
  Listener listener;
  auto gateway = start(listener, any_port());
  ASSERT_TRUE(gateway);
  const Client client(gateway->port());
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
  Listener listener;
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
