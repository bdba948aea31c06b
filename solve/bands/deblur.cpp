// SPDX-License-Identifier: Apache-2.0
#include "solve/bands/deblur.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/parallel.h"

namespace weft::solve {
namespace {

using solver::kSharpenReach;

// Noise over signal that the filters are designed for: along an axis they bring a frequency back by about
// three times at most.
constexpr double kNoise = 0.025;
constexpr int kTileWidth = 128, kTileHeight = 32;

enum Plane : int { kNormal = 0, kAlbedo = 3, kSigmaAlbedo = 6, kSigmaNormal = 9, kSharpened = 10 };

std::array<View<float>, 3> three(Image<float>& image, Plane first, Rect part) {
  return {image.plane(first).crop(part), image.plane(first + 1).crop(part),
          image.plane(first + 2).crop(part)};
}

}  // namespace

Deblur::Deblur(Size size, const Planes& planes, const PointSpread& spread, int threads, const BandSink& next)
    : size_(size), spread_(spread), threads_(threads), next_(next), held_(size.width) {
  if (planes.count == 1) cfa_ = planes.cfa;
  for (std::size_t c = 0; c < 3; ++c) filters_[c] = solver::deblur_filter(spread.sigma_px[c], kNoise);
}

Result<void> Deblur::put(const MapBand& band) {
  held_.append(band);
  const int ready = held_.end() == size_.height ? size_.height : held_.end() - kSharpenReach;
  if (ready <= handed_on_) return {};
  Result<void> taken = hand_on(ready);
  held_.forget_above(std::max(handed_on_ - kSharpenReach, 0));
  return taken;
}

Result<void> Deblur::hand_on(int end_row) {
  const Rect area = {0, handed_on_, size_.width, end_row};
  if (sharpened_.height() < area.height())
    sharpened_ = Image<float>({size_.width, area.height()}, kSharpened);
  const Rect all = {0, 0, size_.width, area.height()};
  const MapBand held = held_.all();
  const solver::RowsToSharpen rows = {
      size_,      held.rows.y0, cfa_, held.normal, held.albedo, held.sigma_albedo, held.sigma_normal_deg,
      held.status};
  const solver::SharpenedRows out = {area.y0, three(sharpened_, kNormal, all),
                                     three(sharpened_, kAlbedo, all), three(sharpened_, kSigmaAlbedo, all),
                                     sharpened_.plane(kSigmaNormal).crop(all)};
  const int tiles_x = (size_.width + kTileWidth - 1) / kTileWidth;
  const int tiles_y = (area.height() + kTileHeight - 1) / kTileHeight;
  std::vector<double> shares(static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_y));
  parallel_for(shares.size(), threads_, [&](std::size_t i, int) {
    const int x0 = static_cast<int>(i) % tiles_x * kTileWidth;
    const int y0 = area.y0 + static_cast<int>(i) / tiles_x * kTileHeight;
    const Rect tile = {x0, y0, std::min(x0 + kTileWidth, area.x1), std::min(y0 + kTileHeight, area.y1)};
    shares[i] = solver::sharpen(rows, filters_, tile, out);
  });
  shares_ = std::accumulate(shares.begin(), shares.end(), shares_);
  handed_on_ = end_row;
  MapBand sharp = held_.of(area);
  for (std::size_t c = 0; c < 3; ++c) {
    sharp.normal[c] = out.normal[c];
    sharp.albedo[c] = out.albedo[c];
    sharp.sigma_albedo[c] = out.sigma_albedo[c];
  }
  sharp.sigma_normal_deg = out.sigma_normal_deg;
  return next_(sharp);
}

DeblurFacts Deblur::facts() const {
  return {spread_.sigma_px, shares_ / static_cast<double>(size_.pixels())};
}

}  // namespace weft::solve
