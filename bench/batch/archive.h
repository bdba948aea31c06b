// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"
#include "simulator/scene/scene.h"

namespace weft::bench {

/// Simulates a few sessions of the scene at this size into `folder`, and fills it with others that share
/// their photographs and calibration by links: SESSION-0000.weft and so on. Errors of simulating.
Result<void> make_archive(const std::filesystem::path& folder, const std::filesystem::path& scene,
                          double megapixels, int sessions, int of_their_own);

/// Sets a frame of five to four.
void set_size(simulator::CameraSettings& camera, double megapixels);

/// Simulates one without its truth. Errors of simulating.
Result<void> simulate_own(const std::filesystem::path& folder, const simulator::Scene& scene);

/// The folder of one of them.
std::filesystem::path session_in(const std::filesystem::path& folder, int number);

}  // namespace weft::bench
