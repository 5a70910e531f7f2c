// The gateway's round trip: from a client's sample going out to its answer having come, by UDP on
// this machine, beside the physics thread at 1 kHz. The tool is held in contact. Wanted: a median
// and 99 % under 0.1 ms, and no step of the physics late because of it. Half a minute in all.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "app/live/device_link.hpp"
#include "app/live/live_loop.hpp"
#include "app/session.hpp"
#include "device/scripted_motion.hpp"
#include "tests/bench/quantile.hpp"
#include "tests/support/paths.hpp"

namespace {

using namespace torsion::engine;  // NOLINT(google-build-using-namespace): one program, one
                                  // namespace

constexpr double kSeconds = 8.0;
constexpr double kWanted = 100.0;  // us

struct RoundTrips {
  std::vector<double> us;
  std::uint64_t lost = 0;
  double force = 0.0;  // N, the last one
};

int connect_to(std::uint16_t port) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  const timeval patience{0, 5000};
  ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return ::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0 ? socket : -1;
}

/// A client of its own: the handle goes into the contact within half a second and rests there.
RoundTrips play(std::uint16_t port, double rate, const MotionScript& script, double pressed) {
  RoundTrips trips;
  const int socket = connect_to(port);
  become_realtime();
  const Pose home = scripted_pose(script, 0.0);
  const auto period = static_cast<Nanoseconds>(1e9 / rate);
  const auto count = static_cast<std::size_t>(kSeconds * rate);
  trips.us.reserve(count);
  GatewaySample sample;
  sample.session = 1;
  sample.sensed = kTranslationAxes | kRotationAxes;
  sample.actuated = sample.sensed;
  sample.traits.damping = 1.0;
  sample.traits.turn_damping = 1e-3;
  sample.traits.mass = 0.15;
  sample.traits.period = 1.0 / rate;
  sample.traits.largest_force = 10.0;
  sample.traits.largest_torque = 0.3;
  const Nanoseconds start = monotonic_now();
  for (std::size_t i = 0; i < count; ++i) {
    wait_until(start + static_cast<Nanoseconds>(i) * period, false);
    const double share = std::min(1.0, 2e-9 * static_cast<double>(monotonic_now() - start));
    const Pose pose = scripted_pose(script, share * pressed);
    sample.pose = {pose.position - home.position, pose.rotation};
    sample.sequence += 1;
    const GatewaySampleBytes bytes = encode_gateway_sample(sample);
    std::array<std::uint8_t, kGatewayAnswerSize> came{};
    const Nanoseconds sent = monotonic_now();
    (void)::send(socket, bytes.data(), bytes.size(), 0);
    std::optional<GatewayAnswer> answer;
    do {
      const ssize_t size = ::recv(socket, came.data(), came.size(), 0);
      answer = size > 0 ? decode_gateway_answer(came) : std::nullopt;
    } while (answer && answer->sequence != sample.sequence);
    const Nanoseconds received = monotonic_now();
    if (answer) {
      trips.us.push_back(1e-3 * static_cast<double>(received - sent));
      trips.force =
          std::hypot(answer->wrench.force.x, answer->wrench.force.y, answer->wrench.force.z);
    } else {
      trips.lost += 1;
    }
  }
  ::close(socket);
  return trips;
}

bool measure(double rate) {
  auto opened = open_session(test::shipped_scene("ball_on_cube_soft"), {}, true);
  if (!opened) {
    std::fprintf(stderr, "%s\n", opened.error().text.c_str());
    return false;
  }
  Session session = std::move(opened).value();
  LiveLoop loop;
  reserve(loop, session, session.simulation);
  const MotionScript& script = session.scene.tools[0].script;
  DeviceLink link(scripted_pose(script, 0.0));
  loop.tools[0].from = PoseFrom::kHandle;
  loop.tools[0].slot = &link.slot();
  std::thread physics(run_live, std::ref(loop));
  while (!loop.ready) {
    std::this_thread::yield();
  }
  GatewayOptions options;
  options.port = 0;
  options.on_start = [] {
    become_realtime();
  };
  auto gateway = Gateway::start(options, {{&link, DeviceLink::on_sample}, DeviceLink::describe});
  if (!gateway) {
    std::fprintf(stderr, "%s\n", gateway.error().text.c_str());
    return false;
  }
  RoundTrips trips;
  std::thread client([&] { trips = play(gateway.value()->port(), rate, script, 0.5); });
  client.join();
  loop.stop = true;
  physics.join();
  loop.frames.refresh();
  const RunStatistics& statistics = loop.frames.front().statistics;
  const double median = quantile(trips.us, 0.5);
  const double most = quantile(trips.us, 0.99);
  std::printf(
      "%4.0f Hz: median %6.1f  99 %% %6.1f  99.9 %% %7.1f  most %8.1f us; %llu of %zu lost; "
      "force %.3f N; steps over 1 ms late: %llu of %llu; %s\n",
      rate, median, most, quantile(trips.us, 0.999), quantile(trips.us, 1.0),
      static_cast<unsigned long long>(trips.lost),
      trips.us.size() + static_cast<std::size_t>(trips.lost), trips.force,
      static_cast<unsigned long long>(statistics.missed_deadlines),
      static_cast<unsigned long long>(statistics.lateness.count()),
      median < kWanted && most < kWanted ? "met" : "missed");
  return true;
}

}  // namespace

int main() {
  return measure(100.0) && measure(1000.0) && measure(4000.0) && measure(8000.0) ? 0 : 1;
}
