// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/tile_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "solver/kernels/demosaic.h"

namespace weft::solve {

using solver::kDemosaicReach;  // what is read around a tile

TileReader::TileReader(const Photographs& photographs, const TileOptions& tile, ReadAs as)
    : photographs_(&photographs),
      taken_(photographs.planes()),
      planes_(as == ReadAs::kRgb ? Planes{} : taken_) {
  if (taken_.count == 3) return;  // they are shown where they are
  const Size size = {
      std::min((std::max(tile.width, 1) + kRowGroup - 1) / kRowGroup * kRowGroup, photographs.size.width),
      std::min(std::max(tile.height, 1), photographs.size.height)};
  const int states = photographs.parallel ? 2 : 1;
  readings_ = Image<float>(size, states * static_cast<int>(photographs.count()) * planes_.count);
  if (planes_.count != taken_.count)
    mosaic_ = Image<float>({size.width + 2 * kDemosaicReach, size.height + 2 * kDemosaicReach});
}

solver::TileInput TileReader::read(Rect tile) {
  views_.clear();
  read_frames(photographs_->frames, 0, tile);
  const std::size_t of_frames = views_.size();
  if (photographs_->parallel) read_frames(*photographs_->parallel, of_frames, tile);
  return {tile,
          planes_.count,
          planes_.cfa,
          std::span(views_).first(of_frames),
          &*photographs_->field,
          planes_.count == 1 ? photographs_->noise() : std::nullopt,
          photographs_->plane_weights,
          photographs_->lobe_share,
          std::span(views_).subspan(of_frames)};
}

// Adds the views of all frames; `first_plane` of `readings_` is that of the first.
void TileReader::read_frames(const Frames& frames, std::size_t first_plane, Rect tile) {
  std::vector<View<float>> out(static_cast<std::size_t>(planes_.count));
  for (std::size_t k = 0; k < photographs_->count(); ++k) {
    for (int p = 0; p < planes_.count && !readings_.empty(); ++p) {
      const int plane = static_cast<int>(first_plane + k * out.size()) + p;
      out[static_cast<std::size_t>(p)] = readings_.plane(plane).crop({0, 0, tile.width(), tile.height()});
    }
    if (planes_.count != taken_.count) {
      read_rgb(frames, k, tile, out);
      views_.insert(views_.end(), out.begin(), out.end());
    } else {
      const std::vector<View<const float>> taken = readings_of(frames, k, tile, out[0]);
      views_.insert(views_.end(), taken.begin(), taken.end());
    }
  }
}

// Demosaics frame k before solving, white-balanced by the flux of its light as the filters expect.
void TileReader::read_rgb(const Frames& frames, std::size_t k, Rect tile, std::span<const View<float>> rgb) {
  const Size size = photographs_->size;
  const Rect around = {std::max(tile.x0 - kDemosaicReach, 0), std::max(tile.y0 - kDemosaicReach, 0),
                       std::min(tile.x1 + kDemosaicReach, size.width),
                       std::min(tile.y1 + kDemosaicReach, size.height)};
  const View<float> mosaic = mosaic_.plane().crop({0, 0, around.width(), around.height()});
  readings_of(frames, k, around, mosaic);
  const CfaPattern& cfa = taken_.cfa;
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
  solver::demosaic(mosaic, phase, inner, {rgb[0], rgb[1], rgb[2]});
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

}  // namespace weft::solve
