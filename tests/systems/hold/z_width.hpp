#pragma once

// The Z-width of a device (Colgate & Brown, 1994): the stiffest virtual wall that it shows without
// shaking, with as much virtual damping.

#include <array>

namespace torsion::engine::test {

/// A mass with its own damping, in turning likewise with N m/rad and so on.
struct WallDevice {
  const char* name;
  double mass;            // kg
  double damping;         // b, N s/m
  double period;          // T, s
  double delay;           // t_d, s: beyond the hold
  double grip_mass;       // kg: of the fingers on it
  double grip_damping;    // N s/m: of a hand that holds it
  double grip_stiffness;  // N/m
};

/// Whether small motions about a steady contact with a wall f = -K x - B v, measured and held at T,
/// die away.
/// @param is_held  by a hand, or pushed by one that neither weighs nor damps
bool is_stable(const WallDevice& device, double stiffness, double damping, bool is_held);

/// The largest K that is stable, and all below it; 0 where even the softest shakes.
double largest_stable_stiffness(const WallDevice& device, double damping, bool is_held);

/// Colgate's: the largest K with b > K (T / 2 + t_d) + |B|; 0 where there is none.
double passive_stiffness(const WallDevice& device, double damping);

/// What the docs draw: an arm as a Falcon's or a Touch's at its own rate, late, and at that of a
/// fast gateway; a knob; a wheel. Their masses and dampings are assumed.
inline constexpr std::array<WallDevice, 5> kWallDevices = {{
    {"arm, 1 kHz", 0.15, 1.0, 1e-3, 0.0, 0.05, 5.0, 200.0},
    {"arm, 1 kHz, 1 ms late", 0.15, 1.0, 1e-3, 1e-3, 0.05, 5.0, 200.0},
    {"arm, 4 kHz", 0.15, 1.0, 0.25e-3, 0.0, 0.05, 5.0, 200.0},
    {"knob, 1 kHz, 1 ms late", 3e-4, 2e-3, 1e-3, 1e-3, 2e-4, 5e-3, 0.5},
    {"wheel, 500 Hz, 2 ms late", 0.02, 0.05, 2e-3, 2e-3, 0.01, 0.2, 10.0},
}};

}  // namespace torsion::engine::test
