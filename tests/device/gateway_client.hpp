#pragma once

// What the tests of the gateway speak to it with, and who listens behind it.

#include <atomic>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "device/gateway/gateway.hpp"

namespace torsion::engine::test {

inline GatewaySample good_sample() {
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

/// What the gateway's thread tells, for the test's.
struct GatewayListener {
  std::atomic<std::uint64_t> calls{0};
  std::atomic<std::uint32_t> epoch{0};
  std::atomic<int> state{0};
  std::atomic<DeviceTrouble> trouble{DeviceTrouble::kNone};
  std::atomic<double> x{0.0};
  std::atomic<double> period{0.0};

  static Wrench on_sample(void* context, const DeviceSample& sample) {
    auto& self = *static_cast<GatewayListener*>(context);
    self.epoch = sample.epoch;
    self.state = static_cast<int>(sample.state);
    self.trouble = sample.trouble;
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
class GatewayClient {
 public:
  explicit GatewayClient(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    wait_no_longer_than_a_minute();
  }
  GatewayClient(const std::string& server, const std::string& own)
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
  ~GatewayClient() { ::close(socket_); }
  GatewayClient(const GatewayClient&) = delete;
  GatewayClient& operator=(const GatewayClient&) = delete;
  GatewayClient(GatewayClient&&) = delete;
  GatewayClient& operator=(GatewayClient&&) = delete;

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
  /// Empty where nothing came for a minute.
  [[nodiscard]] std::vector<std::uint8_t> receive_bytes() const {
    std::vector<std::uint8_t> bytes(512);
    const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), 0);
    bytes.resize(size < 0 ? 0 : static_cast<std::size_t>(size));
    return bytes;
  }
  [[nodiscard]] std::optional<GatewayAnswer> receive() const {
    return decode_gateway_answer(receive_bytes());
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

inline std::unique_ptr<Gateway> start(GatewayListener& listener, GatewayOptions options) {
  auto gateway = Gateway::start(std::move(options), listener.sink());
  EXPECT_TRUE(gateway.ok()) << gateway.error().text;
  return gateway.ok() ? std::move(gateway).value() : nullptr;
}

inline GatewayOptions any_port() {
  GatewayOptions options;
  options.port = 0;
  return options;
}

}  // namespace torsion::engine::test
