#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

namespace torsion {

/// What a handle of the C interface points to. Its memory stays until the program ends, so that a
/// handle which was freed is known as such, and no call goes where nothing is.
template <class T>
struct Handle {
  std::atomic<bool> in_use{false};  // by a call
  std::atomic<bool> alive{false};
  std::optional<T> value;
};

/// All handles of one kind. Freed ones are used again when there are kMostFreed others: until then
/// a call with one fails.
template <class H>
class HandlePool {
 public:
  template <class T>
  H* make(T&& value) {
    const std::lock_guard lock(mutex_);
    H* handle = nullptr;
    if (freed_.size() > kMostFreed) {
      handle = freed_.front();
      freed_.pop_front();
    } else {
      handles_.push_back(std::make_unique<H>());
      handle = handles_.back().get();
    }
    handle->value.emplace(std::forward<T>(value));
    handle->alive.store(true, std::memory_order_release);
    return handle;
  }

  /// @pre the caller has in_use
  void free(H* handle) {
    handle->alive.store(false, std::memory_order_release);
    handle->value.reset();
    const std::lock_guard lock(mutex_);
    freed_.push_back(handle);
  }

 private:
  static constexpr std::size_t kMostFreed = 4096;
  std::mutex mutex_;
  std::deque<std::unique_ptr<H>> handles_;
  std::deque<H*> freed_;
};

enum class HandleState { kUsable, kNull, kFreed, kBusy };

/// A handle for the length of one call.
template <class H>
class HandleUse {
 public:
  explicit HandleUse(const H* handle) : handle_(const_cast<H*>(handle)) {
    if (handle_ == nullptr) {
      state_ = HandleState::kNull;
    } else if (handle_->in_use.exchange(true, std::memory_order_acquire)) {
      state_ = HandleState::kBusy;
    } else {
      held_ = true;
      state_ = handle_->alive.load(std::memory_order_acquire) ? HandleState::kUsable
                                                              : HandleState::kFreed;
    }
  }
  ~HandleUse() {
    if (held_) {
      handle_->in_use.store(false, std::memory_order_release);
    }
  }
  HandleUse(const HandleUse&) = delete;
  HandleUse& operator=(const HandleUse&) = delete;
  HandleUse(HandleUse&&) = delete;
  HandleUse& operator=(HandleUse&&) = delete;

  [[nodiscard]] HandleState state() const { return state_; }
  /// @pre state() is kUsable
  [[nodiscard]] auto& operator*() const { return *handle_->value; }
  [[nodiscard]] auto* operator->() const { return &*handle_->value; }
  [[nodiscard]] H* get() const { return handle_; }

 private:
  H* handle_;
  HandleState state_ = HandleState::kNull;
  bool held_ = false;
};

}  // namespace torsion
