// SPDX-License-Identifier: Apache-2.0
#include "pipeline/tile_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "solver/kernels/demosaic.h"

namespace weft::app {

TileReader::TileReader(const Photographs& photographs, const TileOptions& tile, int reach, bool to_rgb)
    : photographs_(&photographs), to_rgb_(to_rgb), reach_(reach) {
  if (!photographs.rgb.empty() && photographs.shifts.empty()) return;
  const Size size = {
      std::min((std::max(tile.width, 1) + kRowGroup - 1) / kRowGroup * kRowGroup, photographs.size.width),
      std::min(std::max(tile.height, 1), photographs.size.height)};
  const int planes = static_cast<int>(photographs.count()) * (to_rgb || !photographs.rgb.empty() ? 3 : 1);
  readings_ = Image<float>(size, planes);
  if (to_rgb && photographs.rgb.empty())
    mosaic_ = Image<float>({size.width + 2 * reach, size.height + 2 * reach});
}

const std::vector<View<const float>>& TileReader::read(Rect tile) {
  views_.clear();
  const Rect local = {0, 0, tile.width(), tile.height()};
  for (std::size_t k = 0; k < photographs_->count(); ++k) {
    if (!photographs_->rgb.empty()) {
      read_photograph(k, tile);
    } else if (to_rgb_) {
      const auto first = static_cast<int>(k) * 3;
      const std::array<View<float>, 3> rgb = {readings_.plane(first).crop(local),
                                              readings_.plane(first + 1).crop(local),
                                              readings_.plane(first + 2).crop(local)};
      read_rgb(k, tile, rgb);
      views_.insert(views_.end(), rgb.begin(), rgb.end());
    } else {
      const View<float> out = readings_.plane(static_cast<int>(k)).crop(local);
      read_mosaic(k, tile, out);
      views_.emplace_back(out);
    }
  }
  return views_;
}

bool TileReader::shifted(std::size_t k) const {
  return !photographs_->shifts.empty() && photographs_->shifts[k] != solver::ClothShift();
}

void TileReader::read_mosaic(std::size_t k, Rect tile, View<float> out) {
  if (!shifted(k)) return photographs_->read(k, tile, out);
  const solver::ClothShift& shift = photographs_->shifts[k];
  const Rect seen = solver::seen_through(shift, tile, photographs_->size, 2);
  if (seen.width() > unmoved_.width() || seen.height() > unmoved_.height()) {
    unmoved_ = Image<float>({seen.width(), seen.height()});
  }
  if (seen.width() > 0 && seen.height() > 0) photographs_->read(k, seen, unmoved_.plane());
  solver::resample(unmoved_.plane(), seen, shift, tile, photographs_->size, 2, out);
}

void TileReader::read_photograph(std::size_t k, Rect tile) {
  const Rect all = {0, 0, photographs_->size.width, photographs_->size.height};
  for (int c = 0; c < 3; ++c) {
    const View<const float> plane = photographs_->rgb[k].plane(c);
    if (!shifted(k)) {
      views_.push_back(plane.crop(tile));
      continue;
    }
    const View<float> out =
        readings_.plane(static_cast<int>(k) * 3 + c).crop({0, 0, tile.width(), tile.height()});
    solver::resample(plane, all, photographs_->shifts[k], tile, photographs_->size, 1, out);
    views_.emplace_back(out);
  }
}

// Demosaics frame k before solving, white-balanced by the flux of its light as the filters expect.
void TileReader::read_rgb(std::size_t k, Rect tile, const std::array<View<float>, 3>& rgb) {
  const Size size = photographs_->size;
  const Rect around = {std::max(tile.x0 - reach_, 0), std::max(tile.y0 - reach_, 0),
                       std::min(tile.x1 + reach_, size.width), std::min(tile.y1 + reach_, size.height)};
  const View<float> mosaic = mosaic_.plane().crop({0, 0, around.width(), around.height()});
  read_mosaic(k, around, mosaic);
  const CfaPattern& cfa = photographs_->radiometry->cfa();
  const std::array<double, 3> flux = flux_of(k);
  for (int y = 0; y < around.height(); ++y) {
    for (int x = 0; x < around.width(); ++x) {
      const auto c = static_cast<std::size_t>(cfa.channel_at(around.x0 + x, around.y0 + y));
      mosaic(x, y) = static_cast<float>(mosaic(x, y) / flux[c]);
    }
  }
  CfaPattern phase;
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 2; ++x) {
      phase.site[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] =
          cfa.site_at(around.x0 + x, around.y0 + y);
    }
  }
  const Rect inner = {tile.x0 - around.x0, tile.y0 - around.y0, tile.x1 - around.x0, tile.y1 - around.y0};
  solver::demosaic(mosaic, phase, inner, rgb);
  // What a saturated site was mixed into is as unusable as the site.
  for (std::size_t c = 0; c < 3; ++c) {
    for (int y = 0; y < tile.height(); ++y) {
      float* row = rgb[c].row(y);
      for (int x = 0; x < tile.width(); ++x) {
        row[x] = std::isfinite(row[x]) ? static_cast<float>(row[x] * flux[c])
                                       : std::numeric_limits<float>::infinity();
      }
    }
  }
}

std::array<double, 3> TileReader::flux_of(std::size_t k) const {
  const Lights& lights = photographs_->field->lights();
  if (const auto* near = std::get_if<NearLights>(&lights)) return near->leds[k].flux_rgb;
  return std::get<DistantLights>(lights).lights[k].irradiance_rgb;
}

}  // namespace weft::app
