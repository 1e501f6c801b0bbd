// SPDX-License-Identifier: Apache-2.0
// Who photographs a terrace: somebody who walks through the streets, and a drone.
#pragma once

#include "tools/synth/rings.h"
#include "tools/synth/terrace_plan.h"

namespace slf::synth {

/// The first half of the cameras walk along all streets at the height of eyes and look obliquely at
/// the houses on both sides; the others fly to and fro above the roofs and look down obliquely, all
/// four ways. Every eighth is for `evaluation`; `dense` is the others, `intermediate` every third
/// of those, `sparse` every ninth. `circle` is 0 of who walks, 1 of the drone.
Rings make_terrace_views(const Plan& plan, int cameras, int width, int height);

}  // namespace slf::synth
