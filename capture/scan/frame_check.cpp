// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/frame_check.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace weft::capture {
namespace {

constexpr double kAlike = 0.02;  // a third of a stop is 0.26

bool differs(double said, double asked) {
  return said > 0 && std::abs(said / asked - 1) > kAlike;
}

Error another(std::string why, const Photograph& photograph) {
  return {ErrorKind::kProtocol, "the camera delivered another photograph than was asked for",
          photograph.file.filename().string(), std::move(why),
          "leave the camera alone while it scans, and switch it off and on if this comes again"};
}

}  // namespace

void PhotographCheck::begin(double clock_uncertainty_s, std::optional<std::uint32_t> last) {
  clock_uncertainty_s_ = clock_uncertainty_s;
  if (last) last_ = last;
}

Result<void> PhotographCheck::check(const Photograph& photograph, const ExposureSettings& asked,
                                    double now_s) {
  const std::uint32_t failed = std::exchange(failed_, 0);
  const bool is_same_run = std::exchange(is_same_run_, true);
  const auto last = last_;
  if (photograph.image_number) last_ = photograph.image_number;
  if (photograph.image_number && last) {
    const std::int64_t ahead = std::int64_t{*photograph.image_number} - *last;
    if (ahead <= 0) {
      last_ = last;
      return another(
          fmt::format("its number is {}, and {} was there before", *photograph.image_number, *last),
          photograph);
    }
    if (is_same_run && ahead > 1 + std::int64_t{failed}) {
      return another(fmt::format("its number is {} where {} was expected: somebody else released the shutter",
                                 *photograph.image_number, *last + 1),
                     photograph);
    }
  }
  if (photograph.taken_s) {
    const double early_s = photograph.triggered_s - *photograph.taken_s, late_s = *photograph.taken_s - now_s;
    if (early_s > clock_uncertainty_s_ || late_s > clock_uncertainty_s_) {
      return another(
          fmt::format("it was taken {:.2f} s {}, and clocks agree to {:.2f} s", std::max(early_s, late_s),
                      early_s > late_s ? "before it was asked for" : "after now", clock_uncertainty_s_),
          photograph);
    }
  }
  const ExposureSettings& said = photograph.exposure;
  if (differs(said.exposure_us, asked.exposure_us) || differs(said.iso, asked.iso) ||
      differs(said.f_number, asked.f_number)) {
    return another(
        fmt::format("it was taken at {:.6g} us, ISO {:.6g}, f/{:.3g}, not {:.6g} us, ISO {:.6g}, f/{:.3g}",
                    said.exposure_us, said.iso, said.f_number, asked.exposure_us, asked.iso, asked.f_number),
        photograph);
  }
  return {};
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

}  // namespace weft::capture
