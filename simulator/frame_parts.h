// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "simulator/camera/dng_writer.h"
#include "simulator/effects/passes.h"
#include "simulator/simulation_plan.h"

// What sessions and single photographs are simulated with. Internal to simulator.

namespace weft::simulator {

inline constexpr int kTruthPlanes = 7;  ///< normal, albedo, height
inline constexpr std::uint64_t kMegabyte = 1'000'000;

/// A simulation that ends for want of memory: kTryAgain.
Error no_memory(const std::string& why);
/// no_memory() where the system has less than that free.
Result<void> check_memory(std::uint64_t bytes);

/// What a raw file says beside its counts.
RawFrame frame_head(const SimulationPlan& plan, double exposure_us);
DngTags tags_of(const Scene& scene);

/// The counts of a tile, into a picture whose first row is row y0 of the frame.
void copy_counts(const PassTile& tile, int y0, View<std::uint16_t> counts);

}  // namespace weft::simulator
