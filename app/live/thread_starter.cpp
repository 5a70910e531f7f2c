#include "app/live/thread_starter.hpp"

namespace torsion::engine {

ThreadStarter::ThreadStarter() : thread_(&ThreadStarter::work, this) {}

ThreadStarter::~ThreadStarter() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void ThreadStarter::run(std::function<void()> job) {
  std::unique_lock lock(mutex_);
  job_ = std::move(job);
  changed_.notify_all();
  changed_.wait(lock, [this] { return !job_; });
}

void ThreadStarter::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return over_ || job_; });
    if (over_) {
      return;
    }
    job_();
    job_ = nullptr;
    changed_.notify_all();
  }
}

}  // namespace torsion::engine
