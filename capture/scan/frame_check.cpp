// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/frame_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "capture/raw/decode_raw.h"
#include "core/rig/exposure_words.h"
#include "core/rig/radiometry.h"

namespace weft::capture {
namespace {

constexpr double kLongExposure_us = 1e6;  // beyond, bodies reduce noise

Error another(std::string why, const Photograph& photograph) {
  return {ErrorKind::kProtocol, "the camera delivered another photograph than was asked for",
          photograph.file.filename().string(), std::move(why),
          "leave the camera alone while it scans, and switch it off and on if this comes again"};
}

}  // namespace

Result<void> ImageCount::check(const Photograph& photograph) {
  const std::int64_t failed = std::exchange(failed_, 0);
  const bool is_same_connection = std::exchange(is_same_connection_, true);
  if (!photograph.image_number) return {};
  const std::int64_t number = *photograph.image_number;
  if (last_ && number <= *last_ && (is_same_connection || !photograph.taken_s))
    return another(fmt::format("its number is {}, and {} was there before", number, *last_), photograph);
  const std::optional<std::uint32_t> last = std::exchange(last_, photograph.image_number);
  if (!last || !is_same_connection || number <= 1 + std::int64_t{*last} + failed) return {};
  return another(fmt::format("its number is {} where {} was expected: somebody else released the shutter",
                             number, *last + 1),
                 photograph);
}

Result<void> check_new(const Photograph& photograph, const std::vector<Shot>& kept,
                       const std::string& where) {
  const auto same = std::ranges::find(kept, photograph.sha256, &Shot::sha256);
  if (same == kept.end()) return {};
  return Error{ErrorKind::kProtocol, "the camera delivered one photograph twice", where,
               fmt::format("the file is that of {}, byte for byte", same->file),
               "leave the camera alone while it scans, and switch it off and on if this comes again"};
}

void LongWaits::note(const Photograph& photograph) {
  const auto waits = [](const Photograph& of) { return of.waited_s / of.exposure.exposure_us; };
  if (photograph.exposure.exposure_us <= kLongExposure_us) return;
  if (!quickest_ || waits(photograph) < waits(*quickest_)) quickest_ = photograph;
}

void LongWaits::warn(std::vector<std::string>& warnings) const {
  if (!quickest_ || quickest_->waited_s < 2e-6 * quickest_->exposure.exposure_us) return;
  warnings.push_back(fmt::format(
      "photographs of {} come after {:.1f} s: the camera seems to reduce the noise of long exposures, which "
      "takes their time twice; switch that off, the dark shot does its work",
      exposure_words(quickest_->exposure.exposure_us), quickest_->waited_s));
}

Result<void> check_alike(const RawFrame& frame, const RawFrame& first, Size first_size,
                         const std::string& where) {
  const auto refuse = [&](std::string why) {
    return Error{ErrorKind::kBadData, "frame is not like the first one", where, std::move(why),
                 "use one camera with one setting for the whole scan"};
  };
  if (frame.counts.size() != first_size) {
    return refuse(fmt::format("it has {} x {} pixels, not {} x {}", frame.counts.width(),
                              frame.counts.height(), first_size.width, first_size.height));
  }
  if (frame.cfa != first.cfa) return refuse("its colour filters are laid out differently");
  if (frame.black != first.black || frame.white != first.white)
    return refuse("its black or white level differs");
  if (frame.shot.model != first.shot.model || frame.shot.serial != first.shot.serial) {
    return refuse(fmt::format("it is of a {} with serial number {}, not of a {} with {}", frame.shot.model,
                              frame.shot.serial, first.shot.model, first.shot.serial));
  }
  return {};
}

Result<RawFrame> decode_as_calibrated(const std::filesystem::path& file,
                                      const std::optional<Calibration>& calibration) {
  Result<RawFrame> frame = decode_raw(file);
  if (frame && calibration && calibration->response)
    frame->full = measured_full(*frame, *calibration->response);
  return frame;
}

}  // namespace weft::capture
