// SPDX-License-Identifier: Apache-2.0
#include "pipeline/photographs.h"

#include <algorithm>

#include "core/solve_record.h"

namespace weft::app {

void Photographs::read(std::size_t k, Rect tile, View<float> out) const {
  radiometry->read(mosaics[k].counts.plane(), tile, out);
  if (brackets.empty() || brackets[k].empty()) return;
  const Size row = {tile.width(), 1};
  Image<float> others(row, static_cast<int>(brackets[k].size()));
  std::vector<NoiseModel> noise_of = {radiometry->noise()};
  for (const Bracket& bracket : brackets[k]) noise_of.push_back(bracket.radiometry.noise());
  for (int y = tile.y0; y < tile.y1; ++y) {
    const View<float> here = out.crop({0, y - tile.y0, tile.width(), y - tile.y0 + 1});
    std::vector<View<const float>> readings = {here};
    for (std::size_t i = 0; i < brackets[k].size(); ++i) {
      const View<float> other = others.plane(static_cast<int>(i));
      brackets[k][i].radiometry.read(brackets[k][i].frame.counts.plane(), {tile.x0, y, tile.x1, y + 1},
                                     other);
      readings.emplace_back(other);
    }
    merge_exposures(readings, noise_of, here);
  }
}

void mark_replaced(const std::vector<Photosite>& replaced, Rect band, View<std::uint16_t> status) {
  auto site = std::lower_bound(replaced.begin(), replaced.end(), Photosite{band.y0, 0});
  for (; site != replaced.end() && site->y < band.y1; ++site) {
    if (site->x < band.x0 || site->x >= band.x1) continue;
    status(site->x - band.x0, site->y - band.y0) |= kInvalidReading;
  }
}

}  // namespace weft::app
