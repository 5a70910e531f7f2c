#pragma once

#include "systems/contact/step_context.hpp"

namespace torsion {

/// Gives the groups of contact points an identity over time: a group continues the region that it
/// overlaps most. Of several groups over one region the largest keeps it and the others form new
/// ones (a split); several regions over one group end in the oldest (a merge); a region over no
/// group ends. New regions get the next order of formation. What an event would make jump is noted
/// in RegionWrench and fades (region_wrenches).
void group_regions(StepContext& context);

}  // namespace torsion
