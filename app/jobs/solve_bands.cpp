// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/solve_bands.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>
#include <vector>

#include "core/parallel.h"
#include "solver/kernels/demosaic.h"

namespace weft::app {
namespace {

constexpr int kBandRows = 64;
constexpr int kReach = solver::kDemosaicReach;
// Rows kept from the band above: what demosaicing looks back on, and the rows it could not do for want of a
// look ahead.
constexpr int kKept = 2 * kReach;
static_assert(kBandRows % 2 == 0 && kKept % 2 == 0, "bands begin with the filter phase of the image");

template <typename T>
std::array<View<T>, 3> three(Image<T>& image) {
  return {image.plane(0), image.plane(1), image.plane(2)};
}

template <typename T>
std::array<View<T>, 3> crop(const std::array<View<T>, 3>& views, Rect r) {
  return {views[0].crop(r), views[1].crop(r), views[2].crop(r)};
}

// Maps of one band, reused from band to band.
struct BandMaps {
  Image<float> normal, sigma_normal_deg, residual, albedo, sigma_albedo;
  Image<std::uint16_t> status;

  explicit BandMaps(int width)
      : normal({width, kBandRows}, 3),
        sigma_normal_deg({width, kBandRows + kReach}),
        residual({width, kBandRows}),
        albedo({width, kBandRows + kReach}, 3),
        sigma_albedo({width, kBandRows + kReach}, 3),
        status({width, kBandRows}) {}
};

// The readings of one tile, made by one worker.
class TileReader {
 public:
  // `reach` pixels around a tile are read along with it, for demosaicing.
  TileReader(const Photographs& photographs, const TileOptions& tile, int reach, bool to_rgb)
      : photographs_(&photographs), to_rgb_(to_rgb), reach_(reach) {
    if (!photographs.rgb.empty()) return;
    const Size size = {
        std::min((std::max(tile.width, 1) + kRowGroup - 1) / kRowGroup * kRowGroup, photographs.size.width),
        std::min(std::max(tile.height, 1), photographs.size.height)};
    const int planes = static_cast<int>(photographs.count()) * (to_rgb ? 3 : 1);
    readings_ = Image<float>(size, planes);
    if (to_rgb) mosaic_ = Image<float>({size.width + 2 * reach, size.height + 2 * reach});
  }

  // Views of [k * planes + p] over the tile.
  const std::vector<View<const float>>& read(Rect tile) {
    views_.clear();
    const Rect local = {0, 0, tile.width(), tile.height()};
    for (std::size_t k = 0; k < photographs_->count(); ++k) {
      if (!photographs_->rgb.empty()) {
        for (int c = 0; c < 3; ++c) views_.push_back(photographs_->rgb[k].plane(c).crop(tile));
      } else if (to_rgb_) {
        const auto first = static_cast<int>(k) * 3;
        const std::array<View<float>, 3> rgb = {readings_.plane(first).crop(local),
                                                readings_.plane(first + 1).crop(local),
                                                readings_.plane(first + 2).crop(local)};
        read_rgb(k, tile, rgb);
        views_.insert(views_.end(), rgb.begin(), rgb.end());
      } else {
        const View<float> out = readings_.plane(static_cast<int>(k)).crop(local);
        photographs_->radiometry->read(photographs_->mosaics[k].counts.plane(), tile, out);
        views_.emplace_back(out);
      }
    }
    return views_;
  }

 private:
  // Demosaics frame k before solving, white-balanced by the flux of its light as the filters expect.
  void read_rgb(std::size_t k, Rect tile, const std::array<View<float>, 3>& rgb) {
    const Size size = photographs_->size;
    const Rect around = {std::max(tile.x0 - reach_, 0), std::max(tile.y0 - reach_, 0),
                         std::min(tile.x1 + reach_, size.width), std::min(tile.y1 + reach_, size.height)};
    const View<float> mosaic = mosaic_.plane().crop({0, 0, around.width(), around.height()});
    photographs_->radiometry->read(photographs_->mosaics[k].counts.plane(), around, mosaic);
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

  std::array<double, 3> flux_of(std::size_t k) const {
    const Lights& lights = photographs_->field->lights();
    if (const auto* near = std::get_if<NearLights>(&lights)) return near->leds[k].flux_rgb;
    return std::get<DistantLights>(lights).lights[k].irradiance_rgb;
  }

  const Photographs* photographs_;
  bool to_rgb_;
  int reach_;
  Image<float> readings_, mosaic_;
  std::vector<View<const float>> views_;
};

// What waits for demosaicing, a plane each of rho, its sigma and that of the normal, with the rows kept from
// the band above on top.
class Photosites {
 public:
  explicit Photosites(int width) : planes_({width, kKept + kBandRows}, 3) {}

  View<float> rho() { return band(0); }
  View<float> sigma() { return band(1); }
  View<float> sigma_normal_deg() { return band(2); }

  // Demosaics all rows of the image that `band` makes possible into `maps`; returns them.
  Rect demosaic(Rect band, int image_height, const CfaPattern& cfa, int threads, BandMaps& maps) {
    const bool first = band.y0 == 0, last = band.y1 == image_height;
    const int top = first ? kKept : 0;  // of the buffer: the image begins here
    const int bottom = kKept + band.height();
    const Rect rows = {0, first ? 0 : band.y0 - kReach, band.x1,
                       last ? band.y1 : std::max(band.y1 - kReach, 0)};
    const Rect seen = {0, top, band.x1, bottom};
    const View<const float> rho = planes_.plane(0).crop(seen), sigma = planes_.plane(1).crop(seen),
                            angle = planes_.plane(2).crop(seen);
    const int image_row_of_view = band.y0 - kKept + top;
    constexpr int kStrip = 16;
    const auto strips = static_cast<std::size_t>((rows.height() + kStrip - 1) / kStrip);
    parallel_for(strips, threads, [&](std::size_t i, int) {
      const int y0 = rows.y0 + static_cast<int>(i) * kStrip, y1 = std::min(y0 + kStrip, rows.y1);
      const Rect area = {0, y0 - image_row_of_view, band.x1, y1 - image_row_of_view};
      const Rect out = {0, y0 - rows.y0, band.x1, y1 - rows.y0};
      solver::demosaic(rho, cfa, area, crop(three(maps.albedo), out));
      solver::demosaic_sigma(sigma, cfa, area, crop(three(maps.sigma_albedo), out));
      for (int y = 0; y < area.height(); ++y) {
        std::copy_n(angle.row(area.y0 + y), band.x1, maps.sigma_normal_deg.plane().row(out.y0 + y));
      }
    });
    keep_last_rows(band.height());
    return rows;
  }

 private:
  View<float> band(int plane) {
    return planes_.plane(plane).crop({0, kKept, planes_.width(), kKept + kBandRows});
  }

  void keep_last_rows(int height) {
    for (int p = 0; p < planes_.planes(); ++p) {
      for (int y = 0; y < kKept; ++y) {
        std::copy_n(planes_.plane(p).row(height + y), planes_.width(), planes_.plane(p).row(y));
      }
    }
  }

  Image<float> planes_;
};

}  // namespace

Result<double> solve_bands(const Photographs& photographs, const solver::Method& method,
                           const TileOptions& tile, const JobContext& context, const BandSink& sink) {
  const Size size = photographs.size;
  const bool mosaics = photographs.rgb.empty();
  const bool to_rgb = mosaics && method.wants_rgb();
  const bool demosaic_after = mosaics && !to_rgb;
  const int threads = resolved_threads(context.threads);

  std::vector<TileReader> readers;
  for (int i = 0; i < threads; ++i) readers.emplace_back(photographs, tile, to_rgb ? kReach : 0, to_rgb);
  std::array<BandMaps, 2> maps = {BandMaps(size.width), BandMaps(size.width)};
  Photosites photosites(demosaic_after ? size.width : 0);
  TileOptions options = tile;
  options.threads = threads;

  std::future<Result<void>> written;
  double waited = 0;
  const auto wait_for_sink = [&]() -> Result<void> {
    if (!written.valid()) return {};
    Stopwatch watch;
    Result<void> result = written.get();
    waited += watch.lap();
    return result;
  };

  for (int y0 = 0, turn = 0; y0 < size.height; y0 += kBandRows, turn ^= 1) {
    const Rect band = {0, y0, size.width, std::min(y0 + kBandRows, size.height)};
    BandMaps& out = maps[static_cast<std::size_t>(turn)];
    const Result<void> solved = for_each_tile(band, options, context.stop, [&](Rect t, int worker) {
      const Rect local = {t.x0, t.y0 - band.y0, t.x1, t.y1 - band.y0};
      const std::vector<View<const float>>& readings = readers[static_cast<std::size_t>(worker)].read(t);
      const solver::TileInput input = {
          t,        demosaic_after ? 1 : 3, mosaics ? photographs.radiometry->cfa() : CfaPattern{},
          readings, &*photographs.field,    demosaic_after ? photographs.noise : std::nullopt};
      solver::TileOutput output;
      output.normal = crop(three(out.normal), local);
      output.residual = out.residual.plane().crop(local);
      output.status = out.status.plane().crop(local);
      if (demosaic_after) {
        output.albedo[0] = photosites.rho().crop(local);
        output.sigma_albedo[0] = photosites.sigma().crop(local);
        output.sigma_normal_deg = photosites.sigma_normal_deg().crop(local);
      } else {
        output.sigma_normal_deg = out.sigma_normal_deg.plane().crop(local);
        output.albedo = crop(three(out.albedo), local);
        output.sigma_albedo = crop(three(out.sigma_albedo), local);
      }
      method.solve(input, output);
    });
    Rect albedo_rows = band;
    if (demosaic_after && solved) {
      albedo_rows = photosites.demosaic(band, size.height, photographs.radiometry->cfa(), threads, out);
    }
    if (Result<void> ok = wait_for_sink(); !ok) return std::move(ok).error();
    if (!solved) return solved.error();

    const Rect rows = {0, 0, size.width, band.height()}, lagging = {0, 0, size.width, albedo_rows.height()};
    const auto constant = [](const std::array<View<float>, 3>& v) {
      return std::array<View<const float>, 3>{v[0], v[1], v[2]};
    };
    const MapBand finished = {band,
                              constant(crop(three(out.normal), rows)),
                              out.residual.plane().crop(rows),
                              out.status.plane().crop(rows),
                              albedo_rows,
                              constant(crop(three(out.albedo), lagging)),
                              constant(crop(three(out.sigma_albedo), lagging)),
                              out.sigma_normal_deg.plane().crop(lagging)};
    written = std::async(std::launch::async, [finished, &sink] { return sink(finished); });
    context.progress("solve", static_cast<double>(band.y1) / size.height);
  }
  if (Result<void> ok = wait_for_sink(); !ok) return std::move(ok).error();
  return waited;
}

}  // namespace weft::app
