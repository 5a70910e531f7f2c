#pragma once

#include <string>
#include <utility>
#include <variant>

namespace torsion::engine {

/// What went wrong, in one sentence that a user can act on: file, place, value, what was expected.
struct Error {
  std::string text;
};

/// A value or the reason why there is none. Used for bad input; programmer errors are asserts.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}  // NOLINT(google-explicit-constructor): return v;
  Result(Error error)                              // NOLINT(google-explicit-constructor): return e;
      : content_(std::move(error)) {}

  [[nodiscard]] bool ok() const { return content_.index() == 0; }
  explicit operator bool() const { return ok(); }

  /// @pre ok()
  [[nodiscard]] T& value() & { return std::get<0>(content_); }
  [[nodiscard]] const T& value() const& { return std::get<0>(content_); }
  [[nodiscard]] T&& value() && { return std::get<0>(std::move(content_)); }

  /// @pre !ok()
  [[nodiscard]] const Error& error() const { return std::get<1>(content_); }

 private:
  std::variant<T, Error> content_;
};

/// The Result of something that yields nothing but may fail.
struct Done {};

}  // namespace torsion::engine
