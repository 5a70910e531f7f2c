// The C interface under calls that no program should make: handles that are null or freed, rows and
// numbers of any kind, two threads on one object. No crash, no memory error (it runs under
// AddressSanitizer), and a failed call writes nothing.

#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/paths.hpp"
#include "tests/support/studies.hpp"
#include "torsion/torsion.h"

namespace {

using torsion::engine::test::shipped_scene;
using torsion::engine::test::trials_of;

torsion_scene* the_scene() {
  static torsion_scene* const scene = torsion_load_scene(shipped_scene("ball_on_cube").c_str());
  return scene;
}

/// One model for all trials: what is tried is the interface.
torsion_model* the_model() {
  static torsion_model* const model = [] {
    torsion_options options = torsion_default_options();
    options.contact_model = "mdr";
    options.body_model = "none";
    return torsion_build(the_scene(), &options);
  }();
  return model;
}

/// Calls with random arguments, and what they are about.
class RandomCaller {
 public:
  explicit RandomCaller(unsigned seed) : random_(seed) {}

  void call() {
    switch (below(14)) {
      case 0:
        simulations_.push_back(torsion_new_simulation(the_model()));
        break;
      case 1:
        simulations_.push_back(torsion_copy_simulation(simulation()));
        break;
      case 2:
        check(torsion_free_simulation(simulation()));
        break;
      case 3:
      case 4:
        call_step();
        break;
      case 5:
        call_load();
        break;
      case 6:
        call_region();
        break;
      case 7: {
        const torsion_device_traits traits = some_traits();
        couplings_.push_back(torsion_new_coupling(below(8) == 0 ? nullptr : the_model(), row(),
                                                  below(8) == 0 ? nullptr : &traits,
                                                  static_cast<torsion_hold>(below(4))));
        break;
      }
      case 8:
        check(torsion_free_coupling(coupling()));
        break;
      case 9:
      case 10:
        call_coupling();
        break;
      case 11:
        call_scene();
        break;
      case 12: {
        std::array<char, 8> text{};
        torsion_describe_faults(static_cast<std::uint32_t>(random_()),
                                below(4) == 0 ? nullptr : text.data(), below(text.size() + 1));
        EXPECT_EQ(text.back(), '\0');
        break;
      }
      default:
        EXPECT_NE(torsion_last_error(), nullptr);
    }
  }

  ~RandomCaller() {
    for (torsion_simulation* const each : simulations_) {
      torsion_free_simulation(each);
    }
    for (torsion_coupling* const each : couplings_) {
      torsion_free_coupling(each);
    }
  }
  RandomCaller(const RandomCaller&) = delete;
  RandomCaller& operator=(const RandomCaller&) = delete;
  RandomCaller(RandomCaller&&) = delete;
  RandomCaller& operator=(RandomCaller&&) = delete;

  [[nodiscard]] int refused() const { return refused_; }
  [[nodiscard]] int done() const { return done_; }

 private:
  std::size_t below(std::size_t count) { return random_() % count; }
  std::size_t row() { return below(4) == 0 ? below(3) * (SIZE_MAX / 2) : 0; }

  /// Often a place near the cube, sometimes no number at all.
  double number() {
    constexpr double kOdd[] = {0.0,
                               -1.0,
                               1e308,
                               1e-308,
                               std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::quiet_NaN()};
    return below(16) == 0 ? kOdd[below(std::size(kOdd))]
                          : std::uniform_real_distribution<double>(-0.15, 0.15)(random_);
  }

  torsion_pose pose() {
    torsion_pose made{};
    made.position[1] = 0.129;
    made.orientation[0] = 1.0;
    if (below(3) == 0) {
      for (double& each : made.position) {
        each = number();
      }
    }
    if (below(8) == 0) {
      for (double& each : made.orientation) {
        each = number();
      }
    }
    return made;
  }

  torsion_device_traits some_traits() {
    torsion_device_traits traits{};
    traits.size = below(8) == 0 ? below(200) : sizeof traits;
    traits.period = 1e-3;
    for (double* const each : {&traits.damping, &traits.mass, &traits.encoder_step,
                               &traits.largest_force, &traits.largest_stiffness, &traits.delay}) {
      *each = below(3) == 0 ? 0.0 : std::abs(number());
    }
    if (below(8) == 0) {
      traits.period = number();
    }
    return traits;
  }

  torsion_simulation* simulation() {
    return simulations_.empty() || below(8) == 0 ? nullptr
                                                 : simulations_[below(simulations_.size())];
  }
  torsion_coupling* coupling() {
    return couplings_.empty() || below(8) == 0 ? nullptr : couplings_[below(couplings_.size())];
  }

  void check(int result) {
    ++(result < 0 ? refused_ : done_);
    if (result < 0) {
      EXPECT_STRNE(torsion_last_error(), "");
    }
  }

  void call_step() {
    const std::array<torsion_pose, 2> poses = {pose(), pose()};
    check(torsion_step(simulation(), below(16) == 0 ? nullptr : poses.data(),
                       below(8) == 0 ? below(3) : 1));
  }

  void call_load() {
    torsion_simulation* const at = simulation();
    const std::size_t tool = row();
    torsion_wrench wrench{};
    wrench.force[0] = 7.0;
    const int result = torsion_tool_wrench(at, tool, below(8) == 0 ? nullptr : &wrench);
    check(result);
    if (result < 0) {
      EXPECT_EQ(wrench.force[0], 7.0);
    } else {
      for (const double force : wrench.force) {
        EXPECT_TRUE(std::isfinite(force));
      }
    }
    torsion_load_parts parts;
    const std::array<double, 3> point = {number(), number(), number()};
    check(torsion_tool_load_parts(at, tool, below(8) == 0 ? nullptr : point.data(), &parts));
    std::array<double, 36> stiffness{};
    check(torsion_tool_stiffness(at, tool, stiffness.data()));
    double seconds = 0.0;
    check(torsion_time(at, &seconds));
  }

  void call_region() {
    torsion_simulation* const at = simulation();
    std::size_t count = 0;
    check(torsion_region_count(at, &count));
    torsion_region region;
    check(torsion_get_region(at, below(3) == 0 ? row() : below(count + 1), &region));
  }

  void call_coupling() {
    torsion_coupling* const held = coupling();
    torsion_simulation* const at = simulation();
    const torsion_pose handle = pose();
    torsion_pose next{};
    check(torsion_coupling_next(held, at, below(16) == 0 ? nullptr : &handle, &next));
    check(torsion_step(at, &next, 1));
    torsion_wrench felt{};
    if (torsion_coupling_felt(held, at, &felt) == 0) {
      for (const double force : felt.force) {
        EXPECT_TRUE(std::isfinite(force));
      }
    }
  }

  void call_scene() {
    double seconds = 0.0;
    torsion_pose animated;
    check(torsion_scene_duration(below(4) == 0 ? nullptr : the_scene(), &seconds));
    check(torsion_animated_pose(the_scene(), row(), number(), &animated));
    check(torsion_set_number(the_scene(), below(2) == 0 ? "nobody" : nullptr, "density", number()));
    std::size_t count = 0;
    check(torsion_find_tool(the_model(), below(2) == 0 ? "nobody" : nullptr, &count));
    EXPECT_EQ(torsion_load_scene(below(2) == 0 ? nullptr : "/dev/null"), nullptr);
    torsion_options options = torsion_default_options();
    options.size = below(40);
    EXPECT_EQ(torsion_build(the_scene(), &options), nullptr);
    EXPECT_EQ(torsion_build(nullptr, nullptr), nullptr);
  }

  std::mt19937_64 random_;
  std::vector<torsion_simulation*> simulations_;  // freed ones, too
  std::vector<torsion_coupling*> couplings_;      // likewise
  int refused_ = 0;
  int done_ = 0;
};

TEST(CInterfaceTest, RandomCallsEndInValues) {
  ASSERT_NE(the_model(), nullptr) << torsion_last_error();
  int refused = 0;
  int done = 0;
  for (int seed = 0; seed < trials_of(100); ++seed) {
    SCOPED_TRACE(seed);
    RandomCaller caller(static_cast<unsigned>(seed));
    for (int call = 0; call < 300; ++call) {
      caller.call();
    }
    refused += caller.refused();
    done += caller.done();
  }
  EXPECT_GT(refused, 500);
  EXPECT_GT(done, 500);
}

TEST(CInterfaceTest, TwoThreadsOnOneSimulationAreToldSo) {
  ASSERT_NE(the_model(), nullptr) << torsion_last_error();
  torsion_simulation* const simulation = torsion_new_simulation(the_model());
  std::atomic<int> ready{0};
  std::array<int, 2> stepped{};
  std::array<int, 2> refused{};
  const auto work = [&](std::size_t me) {
    torsion_pose pose{};
    pose.position[1] = 0.129;
    pose.orientation[0] = 1.0;
    ++ready;
    while (ready < 2) {
    }
    for (int k = 0; k < 20000; ++k) {
      if (torsion_step(simulation, &pose, 1) >= 0) {
        ++stepped[me];
      } else {
        ++refused[me];
        EXPECT_NE(std::strstr(torsion_last_error(), "another thread"), nullptr);
      }
    }
  };
  std::thread other(work, 1);
  work(0);
  other.join();
  double seconds = 0.0;
  EXPECT_EQ(torsion_time(simulation, &seconds), 0);
  // Every call either was a whole step or none.
  EXPECT_EQ(std::llround(seconds * 1000.0), stepped[0] + stepped[1]);
  EXPECT_EQ(stepped[0] + stepped[1] + refused[0] + refused[1], 40000);
  torsion_free_simulation(simulation);
}

TEST(CInterfaceTest, ThreadsMayUseOneModelAndFreeItMeanwhile) {
  torsion_options options = torsion_default_options();
  options.contact_model = "mdr";
  options.body_model = "none";
  torsion_model* const model = torsion_build(the_scene(), &options);
  ASSERT_NE(model, nullptr) << torsion_last_error();
  std::atomic<int> made{0};
  const auto work = [&] {
    while (torsion_simulation* const simulation = torsion_new_simulation(model)) {
      ++made;
      torsion_free_simulation(simulation);
    }
    EXPECT_NE(std::strstr(torsion_last_error(), "freed"), nullptr);
  };
  std::thread one(work);
  std::thread other(work);
  while (made < 4) {
    std::this_thread::yield();
  }
  while (torsion_free_model(model) != 0) {  // where a thread copies its pointer at that moment
  }
  one.join();
  other.join();
  EXPECT_GE(made, 4);
}

}  // namespace
