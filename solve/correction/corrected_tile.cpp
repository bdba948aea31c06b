// SPDX-License-Identifier: Apache-2.0
#include "solve/correction/corrected_tile.h"

#include <algorithm>
#include <span>

#include "solve/correction/light_correction.h"

namespace weft::solve {

void CorrectedTile::apply(const LightCorrection& correction, solver::TileInput& input) {
  const Size size = {input.tile.width(), input.tile.height()};
  const std::size_t of_frames = input.readings.size(), all = of_frames + input.parallel.size();
  if (readings_.width() < size.width || readings_.height() < size.height)
    readings_ = Image<float>(size, static_cast<int>(all));
  std::vector<View<float>> views;
  for (std::size_t i = 0; i < all; ++i) {
    const View<const float>& from = i < of_frames ? input.readings[i] : input.parallel[i - of_frames];
    views.push_back(readings_.plane(static_cast<int>(i)).crop({0, 0, size.width, size.height}));
    for (int y = 0; y < size.height; ++y) std::copy_n(from.row(y), size.width, views[i].row(y));
  }
  correction.apply(input.tile, std::span(views).first(of_frames));
  if (all > of_frames) correction.apply(input.tile, std::span(views).subspan(of_frames));
  views_.assign(views.begin(), views.end());
  input.readings = std::span(views_).first(of_frames);
  input.parallel = std::span(views_).subspan(of_frames);
}

}  // namespace weft::solve
