// SPDX-License-Identifier: Apache-2.0
#include "pipeline/deblur.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "core/parallel.h"

namespace weft::pipeline {
namespace {

using solver::kSharpenReach;

// Noise over signal that the filters are designed for: along an axis they bring a frequency back by about
// three times at most.
constexpr double kNoise = 0.025;
constexpr int kTileWidth = 128, kTileHeight = 32;

enum Plane : int {
  kNormal = 0,
  kAlbedo = 3,
  kSigmaAlbedo = 6,
  kSigmaNormal = 9,
  kSharpened = 10,
  kModelAlbedo = 10,
  kModelNormal = 13,
  kPlanes = 14
};

template <typename T>
std::array<View<T>, 3> three(Image<T>& image, Plane first, Rect part) {
  return {image.plane(first).crop(part), image.plane(first + 1).crop(part),
          image.plane(first + 2).crop(part)};
}

std::array<View<const float>, 3> constant(const std::array<View<float>, 3>& views) {
  return {views[0], views[1], views[2]};
}

template <typename T>
void copy_rows(View<const T> from, int first, View<T> to, int to_first, int count) {
  for (int y = 0; y < count; ++y) std::copy_n(from.row(first + y), from.width(), to.row(to_first + y));
}

// The image, at least `height` rows high, with the rows that it had.
template <typename T>
void heighten(Image<T>& image, int height) {
  if (image.height() >= height) return;
  Image<T> higher({image.width(), height}, image.planes());
  for (int p = 0; p < image.planes(); ++p)
    copy_rows<T>(image.plane(p), 0, higher.plane(p), 0, image.height());
  image = std::move(higher);
}

}  // namespace

Deblur::Deblur(Size size, const Planes& planes, const PointSpread& spread, int threads, const BandSink& next)
    : size_(size),
      spread_(spread),
      threads_(threads),
      next_(next),
      maps_({size.width, 1}, kPlanes),
      sharpened_({size.width, 1}, kSharpened),
      residual_({size.width, 1}),
      status_({size.width, 1}) {
  if (planes.count == 1) cfa_ = planes.cfa;
  for (std::size_t c = 0; c < 3; ++c) filters_[c] = solver::deblur_filter(spread.sigma_px[c], kNoise);
}

Result<void> Deblur::put(const MapBand& band) {
  append(band);
  const int ready = complete_ == size_.height ? complete_ : complete_ - kSharpenReach;
  if (ready <= handed_on_) return {};
  Result<void> taken = hand_on(ready);
  forget_rows();
  return taken;
}

void Deblur::append(const MapBand& band) {
  has_model_ = !band.model_normal_deg.empty();
  const int needed = std::max(band.rows.y1, band.albedo_rows.y1) - first_row_;
  heighten(maps_, needed);
  heighten(residual_, needed);
  heighten(status_, needed);
  const auto take = [&](View<const float> from, int plane, const Rect& rows) {
    copy_rows<float>(from, 0, maps_.plane(plane), rows.y0 - first_row_, rows.height());
  };
  for (int c = 0; c < 3; ++c) {
    const auto i = static_cast<std::size_t>(c);
    take(band.normal[i], kNormal + c, band.rows);
    take(band.albedo[i], kAlbedo + c, band.albedo_rows);
    take(band.sigma_albedo[i], kSigmaAlbedo + c, band.albedo_rows);
    if (has_model_) take(band.model_albedo[i], kModelAlbedo + c, band.albedo_rows);
  }
  take(band.sigma_normal_deg, kSigmaNormal, band.albedo_rows);
  if (has_model_) take(band.model_normal_deg, kModelNormal, band.albedo_rows);
  copy_rows<float>(band.residual, 0, residual_.plane(), band.rows.y0 - first_row_, band.rows.height());
  copy_rows<std::uint16_t>(band.status, 0, status_.plane(), band.rows.y0 - first_row_, band.rows.height());
  complete_ = std::min(band.rows.y1, band.albedo_rows.y1);
}

Result<void> Deblur::hand_on(int end_row) {
  const Rect area = {0, handed_on_, size_.width, end_row};
  heighten(sharpened_, area.height());
  const Rect held = {0, 0, size_.width, complete_ - first_row_}, all = {0, 0, size_.width, area.height()};
  const solver::SolvedRows rows = {size_,
                                   first_row_,
                                   cfa_,
                                   constant(three(maps_, kNormal, held)),
                                   constant(three(maps_, kAlbedo, held)),
                                   constant(three(maps_, kSigmaAlbedo, held)),
                                   maps_.plane(kSigmaNormal).crop(held),
                                   status_.plane().crop(held)};
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
  const Rect same = {0, area.y0 - first_row_, size_.width, area.y1 - first_row_};
  MapBand sharp = {.rows = area,
                   .normal = constant(out.normal),
                   .residual = residual_.plane().crop(same),
                   .status = status_.plane().crop(same),
                   .albedo_rows = area,
                   .albedo = constant(out.albedo),
                   .sigma_albedo = constant(out.sigma_albedo),
                   .sigma_normal_deg = out.sigma_normal_deg,
                   .model_albedo = {},
                   .model_normal_deg = {}};
  if (has_model_) {
    sharp.model_albedo = constant(three(maps_, kModelAlbedo, same));
    sharp.model_normal_deg = maps_.plane(kModelNormal).crop(same);
  }
  return next_(sharp);
}

void Deblur::forget_rows() {
  const int first_needed = std::max(handed_on_ - kSharpenReach, 0);
  const int gone = first_needed - first_row_, kept = maps_.height() - gone;
  for (int p = 0; p < kPlanes; ++p) copy_rows<float>(maps_.plane(p), gone, maps_.plane(p), 0, kept);
  copy_rows<float>(residual_.plane(), gone, residual_.plane(), 0, kept);
  copy_rows<std::uint16_t>(status_.plane(), gone, status_.plane(), 0, kept);
  first_row_ = first_needed;
}

DeblurFacts Deblur::facts() const {
  return {spread_.sigma_px, shares_ / static_cast<double>(size_.pixels())};
}

}  // namespace weft::pipeline
