// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "core/rig/calibration.h"

namespace weft {

// A reading is what a photosite says of light, free of camera settings:
//   r = lin_c((count - dark) / (white - black)) / (exposure_us * 1e-6 * iso / 100)
// with the dark shot subtracted site by site where there is one, else the black level. A reading that cannot
// be used says so by its value: +infinity is saturated, NaN is missing.

/// A sensor is taken to be full from this share of the way from black to white.
inline constexpr double kSaturatedFrom = 0.98;

/// Counts from which a photosite of this column and row is taken to be full.
inline double saturated_from(const RawFrame& frame, int x, int y) {
  const auto black =
      static_cast<double>(frame.black[static_cast<std::size_t>(y & 1)][static_cast<std::size_t>(x & 1)]);
  return black + kSaturatedFrom * (static_cast<double>(frame.full_at(x, y)) - black);
}

/// Where a calibration measured that a camera stops, as of RawFrame::full; 0 of frames of another ISO or with
/// other levels in their files.
std::array<float, 3> measured_full(const RawFrame& frame, const Response& response);

/// Counts of no light, [y & 1][x & 1]: the file's levels, moved to the mean that the response measured where
/// it has one; sites of the filter cell keep their differences.
std::array<std::array<float, 2>, 2> black_counts(const RawFrame& like, const Response& response);

/// Variance of one reading: photon noise grows with the reading, the rest does not.
struct NoiseModel {
  double per_reading = 0;  ///< variance a unit of reading
  double floor = 0;        ///< variance without light
  double shared = 0;       ///< variance of the dark shot's own noise, which all readings of a photosite share

  double variance(double reading) const { return per_reading * (reading > 0 ? reading : 0) + floor; }
};

/// Joins readings of one tile taken at several exposures into `out`, which may be one of them: the mean of
/// those that are neither full nor missing, weighted by the inverse of the variance that each noise model
/// gives their light-weighted mean (not each its own reading: that would favour what came out low). Full
/// where all that are not missing are full; missing where all are.
void merge_exposures(std::span<const View<const float>> readings, std::span<const NoiseModel> noise,
                     View<float> out);

/// Turns the counts of one session into readings, a tile at a time.
class Radiometry {
 public:
  struct Exposure {
    double exposure_us = 0;
    double iso = 100;
  };
  /// `like` is any frame of the session: its levels and filter pattern hold for all. Where it does not say
  /// where it stops the response may. `dark` (may be null)
  /// must outlive this object and match `like` in size. Without it, response.black_counts stands in the place
  /// of the file's mean black level.
  Radiometry(const RawFrame& like, const RawFrame* dark, const Response& response, Exposure exposure);

  /// Readings of `tile` of a frame's counts, into `out` whose (0, 0) is the tile's corner. `tile.x0` must be
  /// even; up to a row group is written past the tile's last column.
  void read(View<const std::uint16_t> counts, Rect tile, View<float> out) const;

  const NoiseModel& noise() const { return noise_; }
  const CfaPattern& cfa() const { return cfa_; }

 private:
  using Cell = std::array<std::array<float, 2>, 2>;  ///< a value for each site of the filter cell
  View<const std::uint16_t> dark_;
  CfaPattern cfa_;
  Cell black_;
  Cell saturated_from_ = {};  ///< counts
  Cell per_count_ = {};       ///< 1 / (white - black)
  Cell linearity_a_ = {};
  Cell linearity_b_ = {};
  float per_second_ = 1;  ///< 1 / (exposure_us * 1e-6 * iso / 100)
  NoiseModel noise_;
};

}  // namespace weft
