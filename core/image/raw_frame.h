// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/image/image.h"

namespace weft {

/// Colour of each site of the 2 x 2 filter cell, [y & 1][x & 1] on the active area: 0 red, 1 green on a red
/// row, 2 blue, 3 green on a blue row. The two greens are kept apart until they are shown to agree.
struct CfaPattern {
  std::array<std::array<std::uint8_t, 2>, 2> site = {{{0, 1}, {3, 2}}};

  std::uint8_t site_at(int x, int y) const {
    return site[static_cast<std::size_t>(y & 1)][static_cast<std::size_t>(x & 1)];
  }
  /// 0 red, 1 green, 2 blue.
  int channel_at(int x, int y) const {
    const int s = site_at(x, y);
    return s == 3 ? 1 : s;
  }
  friend bool operator==(const CfaPattern&, const CfaPattern&) = default;
};

/// What the file says about how a photograph was taken; zero or empty where it says nothing.
struct ShotMetadata {
  std::string make;
  std::string model;
  std::string serial;
  double exposure_us = 0;
  double iso = 0;
  double f_number = 0;
  double focal_mm = 0;  ///< of the lens, as it is set: not its equivalent on another format
};

/// A mosaic of sensor counts on the active area (margins removed, filter phase kept, upright).
struct RawFrame {
  Image<std::uint16_t> counts;
  CfaPattern cfa;
  std::array<std::array<float, 2>, 2> black = {};  ///< counts of no light, [y & 1][x & 1]
  float white = 0;                                 ///< counts at which the sensor or converter is full
  ShotMetadata shot;
  /// Counts at which red, green and blue stop, where that was found out; 0: at white.
  std::array<float, 3> full = {};

  /// Counts at which a photosite of this column and row stops.
  float full_at(int x, int y) const {
    const float found = full[static_cast<std::size_t>(cfa.channel_at(x, y))];
    return found > 0 ? found : white;
  }
};

/// A frame of the same body, levels and header, whose counts are all 0.
inline RawFrame blank_like(const RawFrame& frame) {
  return {
      Image<std::uint16_t>(frame.counts.size()), frame.cfa, frame.black, frame.white, frame.shot, frame.full};
}

inline RawFrame copy_of(const RawFrame& frame) {
  RawFrame copy = blank_like(frame);
  for (int y = 0; y < frame.counts.height(); ++y)
    std::copy_n(frame.counts.plane().row(y), frame.counts.width(), copy.counts.plane().row(y));
  return copy;
}

}  // namespace weft
