#pragma once

// What all headers of the library share. Units are SI; vectors and poses are in the world frame
// unless a comment says otherwise; a frame is right-handed.

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#define TORSION_API __attribute__((visibility("default")))

namespace torsion {

using Vector3 = std::array<double, 3>;     // x, y, z
using Quaternion = std::array<double, 4>;  // w, x, y, z; unit length
/// Rows and columns: x, y, z of force or shift, then of torque or turn.
using Matrix6 = std::array<std::array<double, 6>, 6>;

/// A rigid placement of an inner frame in an outer one.
struct Pose {
  Vector3 position{};                          // m, outer frame
  Quaternion orientation{1.0, 0.0, 0.0, 0.0};  // inner to outer
};

/// A force, and the torque about a point that is said where a wrench is used.
struct Wrench {
  Vector3 force{};   // N
  Vector3 torque{};  // N m
};

/// A surface of triangles, counter-clockwise seen from outside.
struct Mesh {
  std::vector<Vector3> vertices;                        // m
  std::vector<std::array<std::uint32_t, 3>> triangles;  // rows of vertices
};

/// What went wrong, in words that name the place, the value, what was expected and how to mend it.
struct Error {
  std::string message;
};

/// A value, or why there is none. Bad input ends here; a call that breaks a precondition ends in
/// the assertion handler.
template <class T>
class [[nodiscard]] Result {
 public:
  // Implicit, so that a function returns a value or an error as it is.
  // NOLINTNEXTLINE(google-explicit-constructor)
  Result(T value) : content_(std::move(value)) {}
  // NOLINTNEXTLINE(google-explicit-constructor)
  Result(Error error) : content_(std::move(error)) {}

  [[nodiscard]] bool has_value() const noexcept { return content_.index() == 0; }
  explicit operator bool() const noexcept { return has_value(); }

  /// @pre has_value()
  [[nodiscard]] T& value() & { return std::get<0>(content_); }
  [[nodiscard]] const T& value() const& { return std::get<0>(content_); }
  [[nodiscard]] T&& value() && { return std::get<0>(std::move(content_)); }

  /// @pre !has_value()
  [[nodiscard]] const Error& error() const { return std::get<1>(content_); }

 private:
  std::variant<T, Error> content_;
};

/// Is called when a precondition is broken. If it returns, or there is none, the message goes to
/// stderr and the process aborts; it may throw, but not through step(), which is noexcept.
using AssertionHandler = void (*)(const char* condition, const char* file, int line);

/// Sets the handler for the whole process; null: none. @return the one before. Any thread.
TORSION_API AssertionHandler set_assertion_handler(AssertionHandler handler) noexcept;

/// The library's version, "major.minor.patch".
TORSION_API const char* version() noexcept;

}  // namespace torsion
