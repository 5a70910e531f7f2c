#pragma once

#include <atomic>
#include <thread>

#include "app/live/live_loop.hpp"
#include "app/live/recording.hpp"

namespace torsion::engine::test {

/// The ball of the paper's first experiment just over the cube, contact model mdr, no body model.
Session ball_session();

/// The options it is prepared with.
PrepareOptions ball_options();

/// Where the ball's frame is when it touches the cube, m.
inline constexpr double kTouching = 0.15;

/// A live loop in a thread of its own, without privileges; stops and joins at its end.
class LiveThread {
 public:
  explicit LiveThread(LiveLoop& loop) : loop_(&loop), thread_(run_live, std::ref(loop)) {}
  ~LiveThread() {
    loop_->stop = true;
    thread_.join();
  }
  LiveThread(const LiveThread&) = delete;
  LiveThread& operator=(const LiveThread&) = delete;
  LiveThread(LiveThread&&) = delete;
  LiveThread& operator=(LiveThread&&) = delete;

 private:
  LiveLoop* loop_;
  std::thread thread_;
};

}  // namespace torsion::engine::test
