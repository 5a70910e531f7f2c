#pragma once

// A tool in a hand: the virtual coupling between a device's handle and a tool.

#include <cstddef>
#include <memory>

#include "torsion/simulation.hpp"
#include "torsion/types.hpp"

namespace torsion {

/// What a device is, as far as stability asks. Zero where it is not known.
struct DeviceTraits {
  double damping = 0.0;            // N s/m: of the handle without motors on
  double turn_damping = 0.0;       // N m s/rad
  double mass = 0.0;               // kg: of handle and mechanism
  double inertia = 0.0;            // kg m^2
  double encoder_step = 0.0;       // m: one count, at the handle
  double encoder_turn_step = 0.0;  // rad
  double period = 1e-3;            // s: between two forces
  double delay = 0.0;              // s: from a position read to its force sent, beyond the period
  double largest_force = 0.0;      // N
  double largest_torque = 0.0;     // N m; zero: the device displays no torque
  double largest_stiffness = 0.0;  // N/m, as its maker says
  double largest_turn_stiffness = 0.0;  // N m/rad
};

/// How a handle holds a tool.
enum class Hold {
  kMassless,  // through a spring; the tool is where spring and contacts balance
  kMass,      // through a spring; the tool has its mass and inertia
  kDirect,    // the tool is where the handle is
};

/// Holds one tool. Chooses the stiffest springs that the device can display whatever the tool
/// touches, and keeps what is felt passive. One thread at a time; allocates nothing after its
/// construction.
class TORSION_API Coupling {
 public:
  /// @pre tool < model.tool_count()
  Coupling(const Model& model, std::size_t tool, const DeviceTraits& traits,
           Hold hold = Hold::kMassless);
  Coupling(const Coupling& other);
  Coupling& operator=(const Coupling& other);
  Coupling(Coupling&&) noexcept;
  Coupling& operator=(Coupling&&) noexcept;
  ~Coupling();

  /// The tool's pose for the next step. Before a simulation's first step the tool is put where the
  /// handle is; later it is drawn there.
  /// @param handle  the pose that the hand asks of the tool's frame; numbers that are no pose count
  ///                as the one before
  Pose next(const Simulation& simulation, const Pose& handle) noexcept;

  /// What the hand is to feel after that step, about the handle's origin: N, N m.
  Wrench felt(const Simulation& simulation) noexcept;

  [[nodiscard]] double stiffness() const noexcept;       // N/m
  [[nodiscard]] double turn_stiffness() const noexcept;  // N m/rad
  /// J: what the passivity controller has taken out so far.
  [[nodiscard]] double dissipated() const noexcept;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace torsion
