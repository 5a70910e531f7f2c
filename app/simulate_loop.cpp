#include "app/simulate_loop.hpp"

#include <atomic>
#include <chrono>
#include <ctime>
#include <thread>

#include <sys/prctl.h>

#include "ecs/ring.hpp"

namespace torsion {
namespace {

using SteadyClock = std::chrono::steady_clock;

double microseconds_since(SteadyClock::time_point start) {
  return std::chrono::duration<double, std::micro>(SteadyClock::now() - start).count();
}

/// Steps once and says how long it took, us.
double timed_step(Session& session) {
  const auto start = SteadyClock::now();
  step_scripted(session);
  return microseconds_since(start);
}

void fill_rows(const Session& session, double step_us, std::vector<TraceRow>& rows) {
  for (std::uint32_t tool = 0; tool < rows.size(); ++tool) {
    rows[tool] = trace_row(session.simulation.world, tool, step_us);
  }
}

/// Takes rows out of the ring and writes them until the run is over and the ring empty.
class RowWriter {
 public:
  RowWriter(std::size_t tools, TraceWriter* trace) : rows_(tools), trace_(trace) {
    ring_.reserve(kRingSeconds * 1000 * tools);
    thread_ = std::thread([this] { drain(); });
  }
  ~RowWriter() { finish(); }
  RowWriter(const RowWriter&) = delete;
  RowWriter& operator=(const RowWriter&) = delete;
  RowWriter(RowWriter&&) = delete;
  RowWriter& operator=(RowWriter&&) = delete;

  /// False when the disk is so slow that the ring is full: the row is lost.
  bool push(const TraceRow& row) { return ring_.push(row); }

  void finish() {
    over_.store(true, std::memory_order_release);
    if (thread_.joinable()) {
      thread_.join();
    }
  }

 private:
  static constexpr std::size_t kRingSeconds = 30;

  void drain() {
    std::size_t filled = 0;
    while (true) {
      const bool over = over_.load(std::memory_order_acquire);
      while (const auto row = ring_.pop()) {
        rows_[filled++] = *row;
        if (filled == rows_.size()) {
          trace_->append(rows_);
          filled = 0;
        }
      }
      if (over) {
        return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  Ring<TraceRow> ring_;
  std::vector<TraceRow> rows_;
  TraceWriter* trace_;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

timespec at(std::int64_t nanoseconds) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  return {nanoseconds / kSecond, nanoseconds % kSecond};
}

std::int64_t monotonic_now() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void sleep_until(std::int64_t nanoseconds) {
  const timespec until = at(nanoseconds);
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) != 0) {
  }
}

}  // namespace

RunStatistics run_fast(Session& session, std::uint64_t steps, TraceWriter* trace,
                       Progress& progress) {
  RunStatistics statistics;
  std::vector<TraceRow> rows(session.scene.tools.size());
  const auto start = SteadyClock::now();
  for (std::uint64_t i = 0; i < steps; ++i) {
    const double step_us = timed_step(session);
    statistics.add_step(session.simulation.world, step_us);
    if (trace != nullptr) {
      fill_rows(session, step_us, rows);
      trace->append(rows);
    }
    if (i % 256 == 0) {
      progress.show(static_cast<double>(i) / static_cast<double>(steps));
    }
  }
  statistics.wall_time = 1e-6 * microseconds_since(start);
  return statistics;
}

RunStatistics run_realtime(Session& session, std::uint64_t steps, TraceWriter* trace,
                           Progress& progress) {
  RunStatistics statistics;
  std::vector<TraceRow> rows(session.scene.tools.size());
  std::optional<RowWriter> writer;
  if (trace != nullptr) {
    writer.emplace(rows.size(), trace);
  }
  // Linux wakes a thread up to 50 us late, to save power, unless told otherwise.
  ::prctl(PR_SET_TIMERSLACK, 1UL);
  const double dt = session.simulation.world.clock.at<Clock>(0).dt;
  const std::int64_t first = monotonic_now() + 1'000'000;
  const auto start = SteadyClock::now();
  for (std::uint64_t i = 0; i < steps; ++i) {
    const std::int64_t due = first + static_cast<std::int64_t>(1e9 * dt * static_cast<double>(i));
    sleep_until(due);
    const double late_us = 1e-3 * static_cast<double>(monotonic_now() - due);
    statistics.lateness.add(late_us);
    statistics.missed_deadlines += late_us > 1e6 * dt ? 1U : 0U;
    const double step_us = timed_step(session);
    statistics.add_step(session.simulation.world, step_us);
    if (writer) {
      fill_rows(session, step_us, rows);
      for (const TraceRow& row : rows) {
        statistics.lost_rows += writer->push(row) ? 0U : 1U;
      }
    }
    if (i % 256 == 0) {
      progress.show(static_cast<double>(i) / static_cast<double>(steps));
    }
  }
  statistics.wall_time = 1e-6 * microseconds_since(start);
  return statistics;
}

}  // namespace torsion
