#pragma once

#include "worlds/world.h"

namespace fiimap {

/// A room of the size of the recorded one, with a cow, a lady and what stands about in a
/// laboratory, in the frame of the recording (z up). Its walls are where the published clouds end;
/// the rest is free invention that leaves the recorded way free. The floor is at -0.35 m, because
/// the recorded camera goes down to -0.26 m.
sim::World makeCowRoom();

}  // namespace fiimap
