#pragma once

// Every component of the simulation: one plain struct is one column of one table (ecs/model.hpp
// and ecs/state.hpp list the tables). Units are SI: m, kg, s, N, N m, rad, Pa. A frame is named
// with every vector:
//
// - world: the scene's frame, +Y up.
// - body: the elastic node's frame without its scale; a body does not move, so this is a fixed
//   shift and turn of world.
// - tool: the tool node's frame without its scale.
// - grid: a region's tangent frame: x along tangent_x, y along tangent_y, z along the outward
//   normal.
//
// "Written by" names the one system of a step (systems/step.cpp) that finds what the column holds;
// "load" means it is constant, "the contact model" the system of the body's contact law. What
// regions have from the last step is besides brought over to this step's regions and grids where
// these begin, part, meet, end or move: by group_regions and region_grids, and of single columns by
// who says so in System::carries. A debug build stops where a system changes any other column.

#include "ecs/components/anchors.hpp"  // IWYU pragma: export
#include "ecs/components/basics.hpp"   // IWYU pragma: export
#include "ecs/components/bodies.hpp"   // IWYU pragma: export
#include "ecs/components/cells.hpp"    // IWYU pragma: export
#include "ecs/components/drawn.hpp"    // IWYU pragma: export
#include "ecs/components/frame.hpp"    // IWYU pragma: export
#include "ecs/components/regions.hpp"  // IWYU pragma: export
#include "ecs/components/shapes.hpp"   // IWYU pragma: export
#include "ecs/components/tools.hpp"    // IWYU pragma: export
