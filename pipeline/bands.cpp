// SPDX-License-Identifier: Apache-2.0
#include "pipeline/bands.h"

#include <algorithm>
#include <future>
#include <vector>

#include "core/parallel.h"
#include "pipeline/light_correction.h"
#include "pipeline/tile_reader.h"
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

// A copy of a tile's readings, corrected; one a worker.
class CorrectedTile {
 public:
  const std::vector<View<const float>>& apply(const LightCorrection& correction, Rect tile,
                                              const std::vector<View<const float>>& readings) {
    const Size size = {tile.width(), tile.height()};
    if (readings_.width() < size.width || readings_.height() < size.height) {
      readings_ = Image<float>(size, static_cast<int>(readings.size()));
    }
    std::vector<View<float>> views;
    for (std::size_t i = 0; i < readings.size(); ++i) {
      views.push_back(readings_.plane(static_cast<int>(i)).crop({0, 0, size.width, size.height}));
      for (int y = 0; y < size.height; ++y) std::copy_n(readings[i].row(y), size.width, views[i].row(y));
    }
    correction.apply(tile, views);
    views_.assign(views.begin(), views.end());
    return views_;
  }

 private:
  Image<float> readings_;
  std::vector<View<const float>> views_;
};

}  // namespace

Result<double> solve_bands(const Photographs& photographs, const solver::Method& method,
                           const TileOptions& tile, const JobContext& context, const BandSink& sink,
                           const BandOptions& band_options) {
  LightCorrection* const correction = band_options.correction;
  const Size size = photographs.size;
  const bool mosaics = photographs.rgb.empty();
  const bool to_rgb = mosaics && method.wants_rgb();
  const bool demosaic_after = mosaics && !to_rgb;
  const int threads = resolved_threads(context.threads);

  std::vector<TileReader> readers;
  for (int i = 0; i < threads; ++i) readers.emplace_back(photographs, tile, to_rgb ? kReach : 0, to_rgb);
  std::vector<solver::SolveTally> tallies(static_cast<std::size_t>(threads));
  std::vector<CorrectedTile> corrected(correction == nullptr ? 0 : static_cast<std::size_t>(threads));
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
    if (correction != nullptr) {
      if (Result<void> ok = correction->prepare(band); !ok) return std::move(ok).error();
    }
    BandMaps& out = maps[static_cast<std::size_t>(turn)];
    const Result<void> solved = for_each_tile(band, options, context.stop, [&](Rect t, int worker) {
      const Rect local = {t.x0, t.y0 - band.y0, t.x1, t.y1 - band.y0};
      const std::vector<View<const float>>& as_read = readers[static_cast<std::size_t>(worker)].read(t);
      const std::vector<View<const float>>& readings =
          correction == nullptr ? as_read
                                : corrected[static_cast<std::size_t>(worker)].apply(*correction, t, as_read);
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
      output.tally = &tallies[static_cast<std::size_t>(worker)];
      method.solve(input, output);
    });
    mark_replaced(photographs.replaced, band, out.status.plane());
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
  for (const solver::SolveTally& tally : tallies) {
    if (band_options.tally != nullptr) *band_options.tally += tally;
  }
  return waited;
}

}  // namespace weft::app
