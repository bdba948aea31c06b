// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "capture/devices.h"
#include "core/raw_frame.h"
#include "core/result.h"

namespace weft::capture {

/// Whether a photograph that a camera delivers is the one that was just asked for, by what its file says.
class PhotographCheck {
 public:
  /// `clock_uncertainty_s` as the camera's facts have it. `last` is the count of the last frame kept before.
  void begin(double clock_uncertainty_s, std::optional<std::uint32_t> last);
  /// A take that failed may have counted.
  void failed() { ++failed_; }
  /// kProtocol where it is another one: of another time, count or exposure. `now_s` is since 1970.
  Result<void> check(const Photograph& photograph, const ExposureSettings& asked, double now_s);

 private:
  double clock_uncertainty_s_ = 1;
  std::optional<std::uint32_t> last_;
  bool is_same_run_ = false;  ///< the last one was taken by this scan: counts follow without a gap
  std::uint32_t failed_ = 0;
};

/// Whether frames are of one camera with one setting: size, filters, levels, model, serial number.
Result<void> check_alike(const RawFrame& frame, const RawFrame& first_without_counts, Size first_size,
                         const std::string& where);

}  // namespace weft::capture
