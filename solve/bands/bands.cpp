// SPDX-License-Identifier: Apache-2.0
#include "solve/bands/bands.h"

#include <algorithm>
#include <future>
#include <optional>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "solve/correction/corrected_tile.h"
#include "solve/correction/light_correction.h"
#include "solve/photographs/frame_sigma.h"
#include "solve/photographs/tile_reader.h"
#include "solver/kernels/demosaic.h"

namespace weft::solve {
namespace {

using solver::kDemosaicReach;

constexpr int kBandRows = 64;
// Rows kept from the band above: what demosaicing looks back on, and the rows it could not do for want of a
// look ahead.
constexpr int kKept = 2 * kDemosaicReach;
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
  Image<float> normal, sigma_normal_deg, residual, albedo, sigma_albedo, model_albedo, model_normal_deg;
  Image<std::uint16_t> status;

  explicit BandMaps(int width)
      : normal({width, kBandRows}, 3),
        sigma_normal_deg({width, kBandRows + kDemosaicReach}),
        residual({width, kBandRows}),
        albedo({width, kBandRows + kDemosaicReach}, 3),
        sigma_albedo({width, kBandRows + kDemosaicReach}, 3),
        model_albedo({width, kBandRows + kDemosaicReach}, 3),
        model_normal_deg({width, kBandRows + kDemosaicReach}),
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
    const Rect rows = {0, first ? 0 : band.y0 - kDemosaicReach, band.x1,
                       last ? band.y1 : std::max(band.y1 - kDemosaicReach, 0)};
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
      solver::demosaic(rho, sigma, cfa, area, crop(three(maps.albedo), out),
                       crop(three(maps.sigma_albedo), out));
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

std::array<View<const float>, 3> constant(const std::array<View<float>, 3>& views) {
  return {views[0], views[1], views[2]};
}

// Solves one band after the other.
class BandSolver {
 public:
  BandSolver(const Photographs& photographs, const solver::Method& method, const TileOptions& tile,
             const JobContext& context, const BandOptions& options)
      : photographs_(photographs),
        method_(method),
        tile_(tile),
        stop_(context.stop),
        correction_(options.correction),
        tallies_(static_cast<std::size_t>(resolved_threads(context.threads))),
        corrected_(tallies_.size()) {
    tile_.threads = static_cast<int>(tallies_.size());
    for (int i = 0; i < tile_.threads; ++i) {
      readers_.emplace_back(photographs, tile, method.wants_rgb() ? ReadAs::kRgb : ReadAs::kTaken);
    }
    if (readers_.front().planes().count == 1) photosites_.emplace(photographs.size.width);
    if (options.model)
      model_.emplace(photographs, kBandRows, *options.model, options.robust, tile_.threads,
                     options.blocks != nullptr);
  }

  Result<MapBand> solve(Rect band, BandMaps& maps) {
    if (correction_ != nullptr) {
      if (Result<void> ok = correction_->prepare(band); !ok) return std::move(ok).error();
    }
    const Result<void> solved = for_each_tile(band, tile_, stop_, [&](Rect tile, int worker) {
      const auto w = static_cast<std::size_t>(worker);
      solver::TileInput input = readers_[w].read(tile);
      if (correction_ != nullptr) corrected_[w].apply(*correction_, input);
      solver::TileOutput output = output_of({tile.x0, tile.y0 - band.y0, tile.x1, tile.y1 - band.y0}, maps);
      output.tally = &tallies_[w];
      method_.solve(input, output);
    });
    if (!solved) return solved.error();
    if (const Mosaics* mosaics = photographs_.mosaics())
      mark_replaced(mosaics->replaced, band, maps.status.plane());
    if (model_) gather_model(band, maps);
    const Rect albedo_rows = photosites_
                                 ? photosites_->demosaic(band, photographs_.size.height,
                                                         readers_.front().planes().cfa, tile_.threads, maps)
                                 : band;
    const Rect rows = {0, 0, band.x1, band.height()}, lagging = {0, 0, band.x1, albedo_rows.height()};
    MapBand out = {.rows = band,
                   .normal = constant(crop(three(maps.normal), rows)),
                   .residual = maps.residual.plane().crop(rows),
                   .status = maps.status.plane().crop(rows),
                   .albedo_rows = albedo_rows,
                   .albedo = constant(crop(three(maps.albedo), lagging)),
                   .sigma_albedo = constant(crop(three(maps.sigma_albedo), lagging)),
                   .sigma_normal_deg = maps.sigma_normal_deg.plane().crop(lagging),
                   .model_albedo = {},
                   .model_normal_deg = {}};
    if (model_) add_model(lagging, maps, out);
    return out;
  }

  std::vector<solver::BlockFacts> blocks() const {
    return model_ ? model_->facts() : std::vector<solver::BlockFacts>();
  }
  solver::SolveTally tally() const {
    solver::SolveTally sum;
    for (const solver::SolveTally& each : tallies_) sum += each;
    return sum;
  }

 private:
  void gather_model(Rect band, BandMaps& maps) {
    const Rect rows = {0, 0, band.x1, band.height()};
    const View<const float> albedo = photosites_ ? photosites_->rho() : maps.albedo.plane(1);
    model_->gather(band, {constant(crop(three(maps.normal), rows)), maps.residual.plane().crop(rows),
                          maps.status.plane().crop(rows), albedo,
                          photosites_ ? photosites_->sigma_normal_deg() : maps.sigma_normal_deg.plane()});
  }

  void add_model(Rect lagging, BandMaps& maps, MapBand& out) {
    const View<float> angle = maps.model_normal_deg.plane().crop(lagging);
    const std::array<View<float>, 3> albedo = crop(three(maps.model_albedo), lagging);
    model_->fill(out.albedo_rows, out.albedo, angle, albedo);
    out.model_normal_deg = angle;
    out.model_albedo = constant(albedo);
  }

  // Where a tile goes, by its place in the band.
  solver::TileOutput output_of(Rect local, BandMaps& maps) {
    solver::TileOutput output;
    output.normal = crop(three(maps.normal), local);
    output.residual = maps.residual.plane().crop(local);
    output.status = maps.status.plane().crop(local);
    if (photosites_) {
      output.albedo[0] = photosites_->rho().crop(local);
      output.sigma_albedo[0] = photosites_->sigma().crop(local);
      output.sigma_normal_deg = photosites_->sigma_normal_deg().crop(local);
    } else {
      output.albedo = crop(three(maps.albedo), local);
      output.sigma_albedo = crop(three(maps.sigma_albedo), local);
      output.sigma_normal_deg = maps.sigma_normal_deg.plane().crop(local);
    }
    return output;
  }

  const Photographs& photographs_;
  const solver::Method& method_;
  TileOptions tile_;
  std::stop_token stop_;
  LightCorrection* correction_;
  std::vector<TileReader> readers_;  // one a worker, as the tallies and the corrected tiles
  std::vector<solver::SolveTally> tallies_;
  std::vector<CorrectedTile> corrected_;
  std::optional<Photosites> photosites_;  // where albedo is demosaiced after it was solved
  std::optional<ModelPart> model_;
};

// Hands bands to the sink on a thread of its own, one at a time.
class Handover {
 public:
  explicit Handover(const BandSink& sink) : sink_(sink) {}
  void put(const MapBand& band) {
    under_way_ = std::async(std::launch::async, [this, band] { return sink_(band); });
  }
  // Until the sink has done with the last band.
  Result<void> wait() {
    if (!under_way_.valid()) return {};
    Stopwatch watch;
    Result<void> result = under_way_.get();
    waited_seconds_ += watch.lap();
    return result;
  }
  double waited_seconds() const { return waited_seconds_; }

 private:
  const BandSink& sink_;
  double waited_seconds_ = 0;
  std::future<Result<void>> under_way_;  // last: waited for before the others go
};

}  // namespace

Result<double> solve_bands(const Photographs& photographs, const solver::Method& method,
                           const TileOptions& tile, const JobContext& context, const BandSink& sink,
                           const BandOptions& options) {
  const Size size = photographs.size;
  std::array<BandMaps, 2> maps = {BandMaps(size.width), BandMaps(size.width)};
  BandSolver solver(photographs, method, tile, context, options);
  Handover handover(sink);
  for (int y0 = 0, turn = 0; y0 < size.height; y0 += kBandRows, turn ^= 1) {
    const Rect band = {0, y0, size.width, std::min(y0 + kBandRows, size.height)};
    const Result<MapBand> solved = solver.solve(band, maps[static_cast<std::size_t>(turn)]);
    if (Result<void> ok = handover.wait(); !ok) return std::move(ok).error();
    if (!solved) return solved.error();
    handover.put(*solved);
    context.progress("solve", static_cast<double>(band.y1) / size.height);
  }
  if (Result<void> ok = handover.wait(); !ok) return std::move(ok).error();
  if (options.tally != nullptr) *options.tally += solver.tally();
  if (options.blocks != nullptr) *options.blocks = solver.blocks();
  return handover.waited_seconds();
}

}  // namespace weft::solve
