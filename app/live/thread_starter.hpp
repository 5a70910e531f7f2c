#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace torsion::engine {

/// A thread that starts other threads. They inherit its scheduling: made before the calling thread
/// makes way for realtime, it goes on to start threads that need not.
class ThreadStarter {
 public:
  ThreadStarter();
  ~ThreadStarter();
  ThreadStarter(const ThreadStarter&) = delete;
  ThreadStarter& operator=(const ThreadStarter&) = delete;
  ThreadStarter(ThreadStarter&&) = delete;
  ThreadStarter& operator=(ThreadStarter&&) = delete;

  /// Runs `job` in that thread and waits until it is done.
  void run(std::function<void()> job);

 private:
  void work();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> job_;  // empty: none
  bool over_ = false;
  std::thread thread_;  // last: it uses what is before it
};

}  // namespace torsion::engine
