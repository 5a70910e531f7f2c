#include "app/live/realtime_mode.hpp"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace torsion::engine {
namespace {

// Above ordinary threads, below the kernel's own (interrupts of a PREEMPT_RT kernel have 50).
constexpr int kPriority = 49;
constexpr unsigned kCapabilityIpcLock = 14;  // CAP_IPC_LOCK of linux/capability.h

bool has_capability(unsigned number) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("CapEff:", 0) == 0) {
      std::istringstream digits(line.substr(7));
      unsigned long long bits = 0;
      digits >> std::hex >> bits;
      return ((bits >> number) & 1U) != 0;
    }
  }
  return false;
}

/// With a limit on locked memory and MCL_FUTURE, making a thread fails: its stack counts.
bool may_lock_everything() {
  rlimit limit{};
  return has_capability(kCapabilityIpcLock) ||
         (::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY);
}

/// struct sched_attr of the kernel in its first size, whose header does not go with the C
/// library's.
struct SchedulerAttributes {
  std::uint32_t size = sizeof(SchedulerAttributes);
  std::uint32_t policy = 0;
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;
  std::uint64_t runtime = 0;   // ns: of an ordinary thread its turn
  std::uint64_t deadline = 0;  // ns
  std::uint64_t period = 0;    // ns
};
static_assert(sizeof(SchedulerAttributes) == 48);

/// Asks the ordinary scheduler for short turns of the calling thread, which it therefore lets begin
/// sooner: a thread that wakes with an earlier end of its turn than the one that runs takes its
/// place at once (EEVDF, Stoica and Abdel-Wahab 1995, as Linux has had it since 6.12; kernels
/// before take no notice). Needs no privilege.
void ask_for_short_turns() {
  constexpr std::uint64_t kShortestTurn = 100'000;  // ns: the shortest that the kernel takes
  SchedulerAttributes wanted;
  if (::syscall(SYS_sched_getattr, 0, &wanted, sizeof wanted, 0U) == 0) {
    wanted.runtime = kShortestTurn;
    ::syscall(SYS_sched_setattr, 0, &wanted, 0U);
  }
}

void add_reason(RealtimeMode& mode, const std::string& reason) {
  mode.missing += (mode.missing.empty() ? "" : "; ") + reason;
}

}  // namespace

RealtimeMode become_realtime() {
  RealtimeMode mode;
  // Linux wakes a thread up to 50 us late, to save power, unless told otherwise.
  ::prctl(PR_SET_TIMERSLACK, 1UL);
  sched_param parameters{};
  parameters.sched_priority = kPriority;
  const int failed =
      ::pthread_setschedparam(::pthread_self(), SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters);
  mode.fifo = failed == 0;
  if (!mode.fifo) {
    ask_for_short_turns();
    add_reason(mode, "no SCHED_FIFO (limit rtprio of " + std::to_string(kPriority) +
                         " or CAP_SYS_NICE wanted)");
  }
  if (!may_lock_everything()) {
    add_reason(mode, "memory not locked (limit memlock unlimited or CAP_IPC_LOCK wanted)");
  } else if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    add_reason(mode, "memory not locked (error " + std::to_string(errno) + ")");
  } else {
    mode.locked = true;
  }
  return mode;
}

std::string describe(const RealtimeMode& mode) {
  const std::string granted = mode.fifo ? (mode.locked ? "SCHED_FIFO, memory locked" : "SCHED_FIFO")
                                        : (mode.locked ? "memory locked" : "ordinary scheduling");
  return mode.missing.empty() ? granted : granted + ": " + mode.missing;
}

void make_way_for_realtime() {
  const sched_param parameters{};
  ::pthread_setschedparam(::pthread_self(), SCHED_IDLE, &parameters);
}

}  // namespace torsion::engine
