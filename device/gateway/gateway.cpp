#include "device/gateway/gateway.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "device/device_loop.hpp"
#include "device/gateway/authentication.hpp"
#include "device/gateway/datagram_socket.hpp"
#include "device/steady_clock.hpp"

namespace torsion::engine {
namespace {

constexpr std::string_view kWord = "gateway";
constexpr int kMostAtOnce = 64;  // packets that are read before one is answered

using Datagram = std::array<std::uint8_t, kGatewaySampleSize + kGatewayTagSize + 1>;

bool is_loopback(const std::string& address) {
  return address == kLoopback || address == "::1";
}

}  // namespace

Result<GatewayOptions> gateway_of(const std::string& what) {
  const Error wrong{
      fmt::format("--device {}: expected gateway, gateway:PORT with a port from 1 to 65535, or "
                  "gateway:/PATH of a Unix socket",
                  what)};
  GatewayOptions options;
  std::string_view rest(what);
  rest.remove_prefix(std::min(kWord.size(), rest.size()));
  if (rest.empty()) {
    return options;
  }
  if (rest.size() < 2 || rest.front() != ':') {
    return wrong;
  }
  rest.remove_prefix(1);
  if (rest.front() == '/') {
    options.socket = rest;
    return options;
  }
  const auto [end, failed] = std::from_chars(rest.data(), rest.data() + rest.size(), options.port);
  if (failed != std::errc() || end != rest.data() + rest.size() || options.port == 0) {
    return wrong;
  }
  return options;
}

/// All of it is the thread's, but for what is atomic.
struct Gateway::State {
  GatewayOptions options;
  GatewaySink sink;
  Descriptor socket;
  Descriptor stop;
  std::uint16_t port = 0;
  std::thread thread;

  GatewayNonce nonce = draw_nonce();  // another one after each silence, so for each client

  Address client;  // who has the tool
  std::uint32_t session = 0;
  std::uint32_t sequence = 0;
  double deadline = 0.0;  // s: then the client is silent
  // The client's device, as a driver has one: but for requests to a bus.
  DriverReport report;
  UsbIdentity identity;
  DriverOptions driver_options;
  UsbRequests requests;

  std::atomic<std::uint64_t> samples{0};
  std::atomic<std::uint64_t> garbage{0};
  std::atomic<std::uint64_t> stale{0};
  std::atomic<std::uint64_t> refused{0};
  std::atomic<std::uint64_t> silences{0};

  [[nodiscard]] bool live() const { return report.sample.state == DeviceState::kLive; }
  [[nodiscard]] DriverCall call(double now) {
    return {now, identity, driver_options, report, requests, sink.samples};
  }
  void run();
  void take_packets();
  std::optional<GatewaySample> read(Bytes came, const Address& from);
  void challenge(const GatewaySample& who, const Address& from) const;
  void wrong_secret();
  void begin(const GatewaySample& came);
  bool belongs(const GatewaySample& came, const Address& from);
  void take(const GatewaySample& came);
  void fall_silent();
  void send(const Address& to, const GatewayAnswer& answer) const;
  void send_bytes(const Address& to, Bytes packet) const;
  [[nodiscard]] bool wait() const;
};

/// With its tag, where there is a secret.
void Gateway::State::send_bytes(const Address& to, Bytes packet) const {
  std::array<std::uint8_t, kGatewayAnswerSize + kGatewayTagSize> bytes{};
  auto* end = std::ranges::copy(packet, bytes.begin()).out;
  if (!options.secret.empty()) {
    end = std::ranges::copy(authentication_tag(options.secret, nonce, packet), end).out;
  }
  // A client that is gone, or whose queue is full, hears nothing, and lets go by itself.
  (void)::sendto(socket.number(), bytes.data(), static_cast<std::size_t>(end - bytes.begin()),
                 MSG_DONTWAIT | MSG_NOSIGNAL, to.get(), to.length);
}

void Gateway::State::send(const Address& to, const GatewayAnswer& answer) const {
  send_bytes(to, encode_gateway_answer(answer));
}

/// Tells a client that has the secret what number it shall make its tags over. It is shorter than
/// what was sent: nobody is flooded by it whose address a stranger gave as his own.
void Gateway::State::challenge(const GatewaySample& who, const Address& from) const {
  send_bytes(from, encode_gateway_challenge({who.session, who.sequence, nonce}));
}

/// Who has the tool has the secret: a stranger does not disturb it.
void Gateway::State::wrong_secret() {
  if (!live()) {
    DriverCall now = call(steady_now());
    set_state(now, DeviceState::kStarting, DeviceTrouble::kWrongSecret);
  }
}

/// The sample in a packet that may hold the tool; nothing, and it is counted or answered, of
/// another.
std::optional<GatewaySample> Gateway::State::read(Bytes came, const Address& from) {
  const bool has_tag = came.size() == kGatewaySampleSize + kGatewayTagSize;
  const bool wants_tag = !options.secret.empty();
  const auto sample = decode_gateway_sample(came.first(std::min(came.size(), kGatewaySampleSize)));
  if (!sample || (!has_tag && came.size() != kGatewaySampleSize)) {
    garbage.fetch_add(1, std::memory_order_relaxed);
    return std::nullopt;
  }
  if (has_tag == wants_tag && (!wants_tag || is_authentic(options.secret, nonce, came))) {
    return sample;
  }
  if (has_tag && wants_tag && is_authentic(options.secret, kNoNonce, came)) {
    challenge(*sample, from);
    return std::nullopt;
  }
  wrong_secret();
  garbage.fetch_add(1, std::memory_order_relaxed);
  return std::nullopt;
}

/// A client has the tool from here on.
void Gateway::State::begin(const GatewaySample& came) {
  report.sample.plugged += came.session != session || report.sample.plugged == 0 ? 1U : 0U;
  session = came.session;
  const double now = steady_now();
  report.sample.rate = 0.0;
  report.sample.time = now - came.traits.period;  // the silence before is no interval
  DriverCall at = call(now);
  set_state(at, DeviceState::kLive);
}

/// Whether a sample is the newest of the client that has the tool; one may have it that nobody has.
bool Gateway::State::belongs(const GatewaySample& came, const Address& from) {
  if (!live()) {
    begin(came);
    sequence = came.sequence;
    client = from;
    return true;
  }
  if (came.session != session) {
    refused.fetch_add(1, std::memory_order_relaxed);
    GatewayAnswer no;
    no.session = came.session;
    no.sequence = came.sequence;
    no.time = steady_now();
    no.state = GatewayState::kRefused;
    send(from, no);
    return false;
  }
  if (static_cast<std::int32_t>(came.sequence - sequence) <= 0) {
    stale.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  sequence = came.sequence;
  client = from;
  return true;
}

/// Answers the newest of what has come.
void Gateway::State::take_packets() {
  std::optional<GatewaySample> newest;
  for (int i = 0; i < kMostAtOnce; ++i) {
    Datagram bytes{};
    Address from;
    from.length = sizeof from.storage;
    const ssize_t size =
        ::recvfrom(socket.number(), bytes.data(), bytes.size(), MSG_DONTWAIT,
                   reinterpret_cast<sockaddr*>(&from.storage), &from.length);  // NOLINT
    if (size < 0) {
      break;
    }
    const auto came = read(Bytes(bytes).first(static_cast<std::size_t>(size)), from);
    if (came && belongs(*came, from)) {
      stale.fetch_add(newest ? 1U : 0U, std::memory_order_relaxed);
      newest = came;
    }
  }
  if (newest) {
    take(*newest);
  } else if (!live() && report.sample.garbage != garbage.load(std::memory_order_relaxed)) {
    report.sample.garbage = garbage.load(std::memory_order_relaxed);
    (void)sink.samples.on_sample(sink.samples.context, report.sample);
  }
}

void Gateway::State::take(const GatewaySample& came) {
  constexpr double kPatience = 2.5;   // periods
  constexpr double kLongest = 25e-3;  // s
  DriverCall now = call(steady_now());
  DeviceSample& sample = report.sample;
  sample.sensed = came.sensed;
  sample.actuated = came.actuated;
  sample.traits = came.traits;
  sample.garbage = garbage.load(std::memory_order_relaxed);
  sample.traits.period = period_of(came.traits.period, sample.rate);
  deadline = now.now + std::clamp(kPatience * came.traits.period, kGatewaySilence, kLongest);
  GatewayAnswer answer;
  answer.wrench = publish_pose(now, came.pose, came.buttons);
  sink.describe(sink.samples.context, answer);
  answer.session = session;
  answer.sequence = came.sequence;
  answer.time = steady_now();
  send(client, answer);
  samples.fetch_add(1, std::memory_order_relaxed);
}

void Gateway::State::fall_silent() {
  DriverCall now = call(steady_now());
  set_state(now, DeviceState::kStarting, DeviceTrouble::kNoClient);
  GatewayAnswer answer;
  sink.describe(sink.samples.context, answer);
  answer.session = session;
  answer.sequence = sequence;
  answer.time = now.now;
  answer.state = GatewayState::kSilent;
  send(client, answer);
  nonce = draw_nonce();  // after a silence any number is new: not so of what was recorded before
  silences.fetch_add(1, std::memory_order_relaxed);
}

/// Until a packet or the deadline. @return false when it is to end
bool Gateway::State::wait() const {
  std::array<pollfd, 2> waited = {{{socket.number(), POLLIN, 0}, {stop.number(), POLLIN, 0}}};
  timespec left{};
  if (live()) {
    const double seconds = std::max(deadline - steady_now(), 0.0);
    left.tv_nsec = static_cast<long>(1e9 * std::min(seconds, 0.5));
  }
  (void)::ppoll(waited.data(), waited.size(), live() ? &left : nullptr, nullptr);
  return (waited[1].revents & POLLIN) == 0;
}

void Gateway::State::run() {
  if (options.on_start) {
    options.on_start();
  }
  DriverCall first = call(steady_now());
  set_state(first, DeviceState::kStarting, DeviceTrouble::kNoClient);
  while (wait()) {
    take_packets();
    if (live() && steady_now() >= deadline) {
      fall_silent();
    }
  }
  if (live()) {
    fall_silent();
  }
}

Gateway::Gateway(std::unique_ptr<State> state) : state_(std::move(state)) {}

Result<std::unique_ptr<Gateway>> Gateway::start(GatewayOptions options, GatewaySink sink) {
  if (options.socket.empty() && !is_loopback(options.address) &&
      options.secret.size() < kShortestSecret) {
    return Error{
        fmt::format("--gateway-address {}: other machines may hold the tool only with a "
                    "secret; give --gateway-secret FILE, too",
                    options.address)};
  }
  Result<Descriptor> socket =
      options.socket.empty() ? open_udp(options.address, options.port) : open_unix(options.socket);
  if (!socket) {
    return socket.error();
  }
  auto state = std::make_unique<State>();
  state->options = std::move(options);
  state->sink = sink;
  state->socket = std::move(socket).value();
  state->stop = Descriptor(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (state->stop.number() < 0) {
    return unusable_socket("gateway");
  }
  state->port = port_of(state->socket);
  State& running = *state;
  running.thread = std::thread([&running] { running.run(); });
  return std::unique_ptr<Gateway>(new Gateway(std::move(state)));
}

Gateway::~Gateway() {
  const std::uint64_t one = 1;
  (void)!::write(state_->stop.number(), &one, sizeof one);
  state_->thread.join();
  if (!state_->options.socket.empty()) {
    std::error_code gone;
    std::filesystem::remove(state_->options.socket, gone);
  }
}

std::uint16_t Gateway::port() const {
  return state_->port;
}

GatewayCounts Gateway::counts() const {
  const auto of = [](const std::atomic<std::uint64_t>& count) {
    return count.load(std::memory_order_relaxed);
  };
  return {of(state_->samples), of(state_->garbage), of(state_->stale), of(state_->refused),
          of(state_->silences)};
}

}  // namespace torsion::engine
