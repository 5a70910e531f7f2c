#include "ecs/schedule.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.hpp"

namespace torsion::engine {
namespace {

struct Log {
  std::string calls;
  bool has_springs = false;
};

const std::vector<System<Log>> kSystems = {
    {"push", "pushes", "always", nullptr,
     [](Log& log) {
       log.calls += 'p';
     }},
    {"spring", "springs", "a spring", [](const Log& log) { return log.has_springs; },
     [](Log& log) {
       log.calls += 's';
     }},
    {"measure", "measures", "always", nullptr,
     [](Log& log) {
       log.calls += 'm';
     }},
};

TEST(ScheduleTest, SystemsRunInOrder) {
  Log log{"", true};
  Schedule<Log> schedule(kSystems, log);
  for (int step = 0; step < 2; ++step) {
    schedule.run(log);
    log.calls += ' ';
  }
  EXPECT_EQ(log.calls, "psm psm ");
}

TEST(ScheduleTest, WhatNothingNeedsNeverRuns) {
  Log log;
  Schedule<Log> schedule(kSystems, log);
  log.has_springs = true;  // too late: decided once, at load
  schedule.run(log);
  EXPECT_EQ(log.calls, "pm");
  EXPECT_FALSE(schedule.is_on("spring"));
  EXPECT_TRUE(schedule.is_on("push"));
  EXPECT_FALSE(schedule.is_on("no such system"));
}

TEST(ScheduleTest, TimesEachSystem) {
  Log log;
  const std::vector<System<Log>> sleeper = {{"sleep", "", "", nullptr, [](Log&) {
                                               std::this_thread::sleep_for(
                                                   std::chrono::milliseconds(2));
                                             }}};
  Schedule<Log> schedule(sleeper, log);
  schedule.run(log);
  schedule.run(log);
  const auto& timing = schedule.rows()[0].timing;
  EXPECT_EQ(timing.runs, 2U);
  EXPECT_GE(timing.total_s, 0.004);  // a sleep never ends early
  EXPECT_GE(timing.longest_s, 0.002);
  EXPECT_LE(timing.longest_s, timing.total_s);
}

TEST(ScheduleTest, RunAllocatesNothing) {
  Log log;
  log.calls.reserve(1000);
  Schedule<Log> schedule(kSystems, log);
  const test::AllocationGuard guard;
  for (int step = 0; step < 100; ++step) {
    schedule.run(log);
  }
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(std::ranges::count(log.calls, 'm'), 100);
}

}  // namespace
}  // namespace torsion::engine
