// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "capture/camera/photograph_facts.h"
#include "capture/devices.h"
#include "core/base/result.h"

namespace weft::capture {

/// The camera's clock, read as if it showed UTC, minus this machine's.
struct CameraClock {
  double offset_s = 0;
  double uncertainty_s = 0;
};

/// What a photograph must agree with to be the one that was asked for.
struct AskedFor {
  ExposureSettings exposure;
  std::uint64_t bytes = 0;  ///< that have arrived
  double triggered_s = 0;   ///< since 1970
  double arrived_s = 0;
  std::optional<CameraClock> clock;
  std::optional<std::uint32_t> last_image_number;  ///< of the photograph before
};

/// When it was taken, in seconds since 1970 of this machine's clock.
std::optional<double> taken_s(const PhotographFacts& facts, const std::optional<CameraClock>& clock);

/// Whether a photograph is the one: what it says of itself is held against what was asked for; what it does
/// not say is no evidence. kProtocol: an older photograph, one that is not whole or cannot be read; kBadData:
/// not raw, or not taken as set.
Result<void> check_photograph(const PhotographFacts& facts, const AskedFor& asked);

}  // namespace weft::capture
