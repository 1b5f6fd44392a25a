#pragma once

#include <string>

#include "recording.h"
#include "samples.h"

namespace fiimap::bench {

// What holds where an experiment does not vary it.
constexpr double kResolution = 0.1;  // m
constexpr int kReach = 2;            // voxels
constexpr unsigned kSeed = 20230312;

// Each experiment runs its methods in turns over the frames of a recording, in one thread, and
// notes the thread's CPU time frame by frame.

/// Whole pipelines, ours and the baselines, at 0.2, 0.1 and 0.05 m, inflation of 2 voxels.
void measurePipelines(const Recording& recording, Samples* samples);

/// One of these pipelines without measuring: for callgrind.
void runPipelineOnce(const Recording& recording, const std::string& method, double resolution);

/// Inflation alone at 0.1 m for a reach of 1 to 10 voxels, with the change score of every frame.
void measureInflation(const Recording& recording, Samples* samples);

/// How our pipeline's cost grows with resolution, window, range and inflation.
void measureGrowth(const Recording& recording, Samples* samples);

/// Frames that change everything: teleport, reset, slide on each axis, 30 % of the surface.
void measureWorstCases(const Recording& recording, Samples* samples);

/// Snapshots and queries near the vehicle.
void measureReading(const Recording& recording, Samples* samples);

}  // namespace fiimap::bench
