// SPDX-License-Identifier: Apache-2.0
#include "capture/raw/bayer.h"

#include <cstddef>

namespace weft::capture {

std::optional<CfaPattern> bayer_cell(const std::array<std::array<int, 2>, 2>& colors) {
  const CfaPattern red_first;
  for (const int red_y : {0, 1})
    for (const int red_x : {0, 1}) {
      CfaPattern cell;
      bool same = true;
      for (const std::size_t y : {0u, 1u})
        for (const std::size_t x : {0u, 1u}) {
          const int from_red_x = static_cast<int>(x) + red_x, from_red_y = static_cast<int>(y) + red_y;
          cell.site[y][x] = red_first.site_at(from_red_x, from_red_y);
          same = same && colors[y][x] == red_first.channel_at(from_red_x, from_red_y);
        }
      if (same) return cell;
    }
  return {};
}

Error not_bayer(const std::string& where) {
  return {ErrorKind::kBadData, "not a Bayer mosaic", where,
          "its filter cell is not one red, two green on a diagonal and one blue",
          "use a camera with a Bayer sensor"};
}

}  // namespace weft::capture
