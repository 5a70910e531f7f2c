#pragma once

// The deformed surface of a body, for any renderer.

#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include "torsion/simulation.hpp"
#include "torsion/types.hpp"

namespace torsion {

/// What a step shows to who draws it: a copy of a few kB. Made in the thread that steps, read in
/// any other.
class TORSION_API Snapshot {
 public:
  /// Takes all memory.
  explicit Snapshot(const Simulation& simulation);
  Snapshot(const Snapshot& other);
  Snapshot& operator=(const Snapshot& other);
  Snapshot(Snapshot&&) noexcept;
  Snapshot& operator=(Snapshot&&) noexcept;
  ~Snapshot();

  /// Of the simulation's last step. Allocates nothing. @pre it is of the same model
  void take(const Simulation& simulation) noexcept;

  [[nodiscard]] double time() const noexcept;  // s, of that step
  [[nodiscard]] Pose pose(std::size_t tool) const noexcept;

  struct Data;
  [[nodiscard]] const Data& data() const noexcept { return *data_; }  // not for users

 private:
  std::unique_ptr<Data> data_;
};

/// A mesh on a body that deforms with it.
class TORSION_API Surface {
 public:
  /// @param body  a row of the model's bodies
  /// @param mesh  m, body frame: near the body's surface, as fine as dents are to be seen
  Surface(std::shared_ptr<const Model> model, std::size_t body, const Mesh& mesh);
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;
  ~Surface();

  /// Deforms the mesh as of the snapshot.
  void update(const Snapshot& snapshot);

  // (vertices of the mesh), valid until the next update
  [[nodiscard]] std::span<const std::array<float, 3>> positions() const noexcept;  // m, body frame
  [[nodiscard]] std::span<const std::array<float, 3>> normals() const noexcept;    // unit
  [[nodiscard]] std::span<const float> twist() const noexcept;  // rad: sum about all regions' axes

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace torsion
