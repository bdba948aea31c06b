// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capture/devices.h"
#include "core/base/result.h"
#include "core/image/raw_frame.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"

namespace weft::capture {

/// Whether photographs follow one another by the camera's own count. (Time, exposure and size are the
/// camera link's to check.)
class ImageCount {
 public:
  /// After each connection: a body may have been used meanwhile, or have begun to count anew.
  void connected() { is_same_connection_ = false; }
  /// The count of the last frame that an earlier run has kept.
  void follow(std::optional<std::uint32_t> last) { last_ = last; }
  /// A take that failed may have counted.
  void failed() { ++failed_; }
  /// kProtocol where the count is not the next one. After a connection a lower count is believed if the
  /// photograph's time was, and a higher one always is.
  Result<void> check(const Photograph& photograph);

 private:
  std::optional<std::uint32_t> last_;
  bool is_same_connection_ = false;
  std::uint32_t failed_ = 0;
};

/// Whether none of the shots that are kept has this file, byte for byte: kProtocol names the one that has.
Result<void> check_new(const Photograph& photograph, const std::vector<Shot>& kept, const std::string& where);

/// Whether a camera takes a dark photograph after each long one, as noise reduction has it: all of them come
/// after twice their exposure.
class LongWaits {
 public:
  void note(const Photograph& photograph);
  /// Adds a sentence where it does.
  void warn(std::vector<std::string>& warnings) const;

 private:
  std::optional<Photograph> quickest_;  ///< by its exposure
};

/// Whether frames are of one camera with one setting: size, filters, levels, model, serial number.
Result<void> check_alike(const RawFrame& frame, const RawFrame& first_without_counts, Size first_size,
                         const std::string& where);

/// A frame that knows where the camera stops, as far as a calibration measured it. Errors as decode_raw().
Result<RawFrame> decode_as_calibrated(const std::filesystem::path& file,
                                      const std::optional<Calibration>& calibration);

}  // namespace weft::capture
