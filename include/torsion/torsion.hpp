#pragma once

// All of the library: docs/library.md.

#include "torsion/coupling.hpp"
#include "torsion/scene.hpp"
#include "torsion/simulation.hpp"
#include "torsion/surface.hpp"
#include "torsion/types.hpp"
