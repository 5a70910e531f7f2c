#pragma once

// A socket through which another program, of this machine or of one that has the gateway's secret,
// holds the tool with a device of its own.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "device/drivers/driver.hpp"
#include "device/protocols/gateway.hpp"
#include "ecs/result.hpp"

namespace torsion::engine {

inline constexpr std::uint16_t kGatewayPort = 7747;
inline constexpr std::string_view kLoopback = "127.0.0.1";  // no other machine reaches it

/// Bytes of a secret: 128 bits are not guessed; what is longer is no file that was made for it.
inline constexpr std::size_t kShortestSecret = 16;
inline constexpr std::size_t kLongestSecret = 255;

/// s: a client that says nothing for as long is gone, and its force with it. One that says it sends
/// less often than that is waited for two and a half of its periods.
inline constexpr double kGatewaySilence = 5e-3;

struct GatewayOptions {
  std::string address = std::string(kLoopback);  // of this machine, where UDP is taken
  std::uint16_t port = kGatewayPort;             // 0: any free one
  std::filesystem::path socket;  // not empty: a Unix datagram socket in place of UDP
  /// Not empty: packets are followed by a tag that only who has this can make.
  std::vector<std::uint8_t> secret;
  std::function<void()> on_start;  // in the gateway's thread, before it does anything; may be empty
};

/// "gateway", "gateway:PORT" or "gateway:/PATH". Error: it is none of these.
Result<GatewayOptions> gateway_of(const std::string& what);

/// Who wants the samples, and says what the client is told of them. In the gateway's thread.
struct GatewaySink {
  SampleSink samples;
  /// Adds the tool's pose, the state and the physics' faults after the last sample.
  void (*describe)(void* context, GatewayAnswer& answer) = nullptr;
};

struct GatewayCounts {
  std::uint64_t samples = 0;
  std::uint64_t garbage = 0;   // packets that were none, or of who has not the secret
  std::uint64_t stale = 0;     // older than one before, doubled, or overtaken before it was read
  std::uint64_t refused = 0;   // of another client while one has the tool
  std::uint64_t silences = 0;  // times that a client fell silent
};

class Gateway {
 public:
  /// Starts the thread. Error: the address is in use, or the socket cannot be made there; other
  /// machines reach it and there is no secret.
  static Result<std::unique_ptr<Gateway>> start(GatewayOptions options, GatewaySink sink);

  /// Tells the client that there is no force any more, and ends the thread.
  ~Gateway();
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;
  Gateway(Gateway&&) = delete;
  Gateway& operator=(Gateway&&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] GatewayCounts counts() const;

 private:
  struct State;
  explicit Gateway(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace torsion::engine
