#pragma once

#include <string>

namespace torsion::engine {

/// What the system granted a thread that must wake on time.
struct RealtimeMode {
  bool fifo = false;    // SCHED_FIFO: runs as soon as it is due, before every ordinary thread
  bool locked = false;  // its memory stays in RAM
  std::string missing;  // why not both, and what to do; empty when both were granted
};

/// Asks for the calling thread: timer slack 1 ns, SCHED_FIFO (not inherited by threads it makes)
/// and, for the whole process, locked memory. Neither is needed to run, both to be on time. Without
/// SCHED_FIFO it gets short turns of the ordinary scheduler, which begin sooner.
RealtimeMode become_realtime();

/// One line for a person.
std::string describe(const RealtimeMode& mode);

/// Lets the calling thread, and every thread that it makes afterwards, run only when nothing else
/// wants to: for drawing beside a physics thread that got no SCHED_FIFO. Needs no privilege.
void make_way_for_realtime();

}  // namespace torsion::engine
