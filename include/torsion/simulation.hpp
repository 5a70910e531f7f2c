#pragma once

// A scene at work: Model is what is constant, Simulation what a step changes.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "torsion/scene.hpp"
#include "torsion/types.hpp"

namespace torsion {

/// What may be chosen for a run besides what the scene says.
struct Options {
  double rate = 1000.0;          // Hz: steps a second
  std::string contact_model;     // of all bodies; empty: as the scene says
  std::string body_model;        // likewise
  std::uint32_t grid_side = 0;   // cells along a contact region's grid; 0: as the models need
  std::uint32_t iterations = 2;  // of contact model patch in a step, 1 to 100
  /// Poses that the run will bring as far as they are known, (times) of (tools): the models "auto"
  /// go by them. Empty: the file's animations, and without those, contacts of any shape.
  std::vector<std::vector<Pose>> expected_poses;
  bool use_cache = false;     // distance fields and compliances from the user's cache folder
  std::uint32_t threads = 1;  // that build() may use; 0: as many as there are cores
  /// Called with 0 to 1, never falling, in the thread of build(), while a compliance is computed.
  std::function<void(double)> progress;
};

/// A scene, prepared: shapes, tables and the chosen models. Immutable; any number of simulations in
/// any threads may share it.
class TORSION_API Model {
 public:
  struct Data;
  explicit Model(std::unique_ptr<const Data> data) noexcept;  // for build()
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;
  Model(Model&&) = delete;
  Model& operator=(Model&&) = delete;
  ~Model();

  [[nodiscard]] std::size_t body_count() const noexcept;
  [[nodiscard]] std::size_t tool_count() const noexcept;
  /// The row of that name; none has it: body_count() or tool_count().
  [[nodiscard]] std::size_t body(std::string_view name) const noexcept;
  [[nodiscard]] std::size_t tool(std::string_view name) const noexcept;
  [[nodiscard]] double step_time() const noexcept;  // s
  /// The models that run for a body, and why, in words.
  [[nodiscard]] std::string contact_model(std::size_t body) const;
  [[nodiscard]] std::string body_model(std::size_t body) const;
  [[nodiscard]] std::string why(std::size_t body) const;
  /// The scene that the model was built from.
  [[nodiscard]] const Scene& scene() const noexcept;

  [[nodiscard]] const Data& data() const noexcept { return *data_; }  // not for users

 private:
  std::unique_ptr<const Data> data_;
};

/// Prepares a scene. Takes from milliseconds to, for the compliance of a body that no cache has, a
/// minute. Any thread.
TORSION_API Result<std::shared_ptr<const Model>> build(const Scene& scene,
                                                       const Options& options = {});

/// What can go wrong in a step, as bits of Simulation::faults(). While a fault lasts the wrenches
/// fade to zero.
namespace fault {
inline constexpr std::uint32_t kPoseNotFinite = 1;
inline constexpr std::uint32_t kPoseJumped = 2;  // faster than 20 m/s or 500 rad/s
inline constexpr std::uint32_t kTooDeep = 4;
inline constexpr std::uint32_t kRegionsFull = 8;
inline constexpr std::uint32_t kResultNotFinite = 16;
inline constexpr std::uint32_t kForceTooLarge = 32;
}  // namespace fault

/// The faults in words, one a line; empty if there are none.
TORSION_API std::string describe_faults(std::uint32_t faults);

/// A contact of a tool with a body.
struct Region {
  std::uint64_t id = 0;  // in the order of formation, never used twice
  std::size_t body = 0;
  std::size_t tool = 0;
  Vector3 point{};             // m: the centre of pressure, on the tool's surface
  Vector3 normal{};            // unit, out of the body
  double area = 0.0;           // m^2, of the contact
  double radius = 0.0;         // m: of a disc of that area
  double depth = 0.0;          // m: of the tool under the body's rest surface
  double normal_force = 0.0;   // N
  double mean_pressure = 0.0;  // Pa: normal force over area
  Vector3 friction{};          // N, on the tool
  double couple = 0.0;        // N m, on the tool about `normal` through `point`: the contact torque
  double turn = 0.0;          // rad: of the tool about the normal since the region formed
  double stick_share = 0.0;   // of the area that sticks, 0 to 1
  double stick_radius = 0.0;  // m
  Wrench output;  // N and N m about the tool's mass centre: as output, with the fades of
                  // events and faults
};

/// A cell of a region that carries pressure.
struct Cell {
  Vector3 point{};        // m, on the tool's surface
  double area = 0.0;      // m^2: the part that pressure and traction act on
  double pressure = 0.0;  // Pa
  Vector3 traction{};     // Pa, on the tool, tangential
  bool sticks = false;
};

/// A tool's load in parts, as the contact models compute it: without the fades of Region::output.
struct LoadParts {
  Vector3 normal_force{};  // N, summed over the regions
  Vector3 friction{};      // N, likewise
  Vector3 couple{};        // N m: the sum of the contact couples, which no r x F contains
  Vector3 lever_torque{};  // N m: the sum of r x F about the stated point
};

/// What a step changes. A copy goes on by itself: neither disturbs the other. One thread at a time
/// may use a simulation; different simulations, of one model too, may run in different threads.
class TORSION_API Simulation {
 public:
  /// Takes all memory that steps need.
  explicit Simulation(std::shared_ptr<const Model> model);
  Simulation(const Simulation& other);
  Simulation& operator=(const Simulation& other);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// One step of Model::step_time(). Allocates nothing. The same poses give the same bits.
  /// @param poses  (tools) of the tools' frames at time()
  void step(std::span<const Pose> poses) noexcept;

  /// Goes back to before the first step.
  void reset();

  [[nodiscard]] const Model& model() const noexcept { return *model_; }
  [[nodiscard]] const std::shared_ptr<const Model>& shared_model() const noexcept { return model_; }
  [[nodiscard]] std::uint64_t step_count() const noexcept;
  /// s: the time whose poses the next step takes.
  [[nodiscard]] double time() const noexcept;
  [[nodiscard]] std::uint32_t faults() const noexcept;       // of the last step
  [[nodiscard]] std::uint32_t faults_ever() const noexcept;  // of all steps

  // Of the last step. @pre tool < Model::tool_count()
  [[nodiscard]] Pose pose(std::size_t tool) const noexcept;
  /// The bodies' wrench on the tool about the origin of the tool's frame, or about `point` [m].
  [[nodiscard]] Wrench wrench(std::size_t tool) const noexcept;
  [[nodiscard]] Wrench wrench(std::size_t tool, const Vector3& point) const noexcept;
  [[nodiscard]] LoadParts load_parts(std::size_t tool, const Vector3& point) const noexcept;
  /// How the contacts resist small shifts [m] and turns [rad] of the tool about its mass centre, as
  /// if they stuck: wrench = -stiffness * motion. N/m, N, N m.
  [[nodiscard]] Matrix6 stiffness(std::size_t tool) const noexcept;
  /// J: done on the tool by whoever holds it, since the first step.
  [[nodiscard]] double work(std::size_t tool) const noexcept;

  [[nodiscard]] std::size_t region_count() const noexcept;
  /// @pre region < region_count()
  [[nodiscard]] Region region(std::size_t region) const noexcept;
  [[nodiscard]] std::vector<Region> regions() const;
  /// The cells of a region that carry pressure; none for models without cells of their own.
  /// @pre region < region_count()
  [[nodiscard]] std::vector<Cell> cells(std::size_t region) const;

  /// A hash of everything that a later step depends on.
  [[nodiscard]] std::uint64_t hash() const noexcept;

  struct Data;
  [[nodiscard]] const Data& data() const noexcept { return *data_; }  // not for users

 private:
  std::shared_ptr<const Model> model_;
  std::unique_ptr<Data> data_;
};

}  // namespace torsion
