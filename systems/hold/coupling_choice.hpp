#pragma once

#include "ecs/device_sample.hpp"
#include "systems/hold/virtual_coupling.hpp"

namespace torsion {

/// What set a stiffness.
enum class StiffnessLimit {
  kPassivity,  // b > K (T / 2 + t_d)
  kDevice,     // the maker's largest
  kUnknown,    // neither is known: a cautious one
};

struct CouplingChoice {
  VirtualCoupling coupling;
  StiffnessLimit limit = StiffnessLimit::kUnknown;
  StiffnessLimit turn_limit = StiffnessLimit::kUnknown;
};

/// The stiffest coupling that the device can display whatever it touches. A sampled spring is
/// passive where b > K T / 2 + |B| (Colgate & Schenkel, 1997), with a delay b > K (T / 2 + t_d)
/// (Hulin et al., 2014); nine tenths of that, and no damper, which would only cost stiffness.
CouplingChoice choose_coupling(const DeviceTraits& device);

/// For a person: what set a stiffness.
const char* limit_text(StiffnessLimit limit);

/// The stiffness up to which a pure spring between a device of damping b and a passive simulation
/// is passive, N/m: b >= K T / (2 pi). Source: Llewellyn's criterion for a two-port whose device
/// holds its force, worst at half the sampling rate (Adams & Hannaford, 1999).
double virtual_coupling_bound(double damping, double period);

}  // namespace torsion
