// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "core/base/vec.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "solver/method.h"

namespace weft::bench {

/// Maps in memory for one run of a method over a whole picture.
struct SolvedMaps {
  Image<float> normal, albedo, sigma_albedo, sigma_normal_deg, residual;
  Image<std::uint16_t> status;
  double left_out_rel = std::numeric_limits<double>::quiet_NaN();  ///< median error of left-out light
  double lobe_seconds = 0;                                         ///< that looking for a lobe took
  int planes = 1;  ///< of `albedo`: 1 where each photosite was solved alone, else R, G, B

  explicit SolvedMaps(Size size)
      : normal(size, 3),
        albedo(size, 3),
        sigma_albedo(size, 3),
        sigma_normal_deg(size),
        residual(size),
        status(size) {}

  solver::TileOutput output(Rect tile) {
    const auto three = [&](Image<float>& i) {
      return std::array{i.plane(0).crop(tile), i.plane(1).crop(tile), i.plane(2).crop(tile)};
    };
    return {three(normal),
            three(albedo),
            sigma_normal_deg.plane().crop(tile),
            three(sigma_albedo),
            residual.plane().crop(tile),
            status.plane().crop(tile)};
  }
  Vec3 normal_at(int x, int y) const { return {normal(x, y, 0), normal(x, y, 1), normal(x, y, 2)}; }
  /// Albedo in the colour that the photosite measured.
  float albedo_at(int x, int y, const CfaPattern& cfa) const {
    return albedo(x, y, planes == 1 ? 0 : cfa.channel_at(x, y));
  }
};

}  // namespace weft::bench
