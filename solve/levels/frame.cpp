// SPDX-License-Identifier: Apache-2.0
#include "solve/levels/frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "core/base/parallel.h"
#include "solve/bands/realign.h"
#include "solve/correction/left_out.h"
#include "solve/photographs/tile_reader.h"

namespace weft::pipeline {
namespace {

// Readings of one channel that make one of a cell: their mean, or the value of the first that cannot be
// used.
class CellReading {
 public:
  void add(float reading) {
    if (!std::isfinite(reading) && std::isfinite(unusable_)) unusable_ = reading;
    sum_ += static_cast<double>(reading);
    ++count_;
  }
  float mean() const { return std::isfinite(unusable_) ? static_cast<float>(sum_ / count_) : unusable_; }

 private:
  double sum_ = 0;
  int count_ = 0;
  float unusable_ = 0;
};

// Rows y and y + 1 of one photograph as row y / 2 of its half.
void halve_rows(const Planes& planes, std::span<const View<const float>> readings, int y,
                Image<float>& half) {
  for (int x = 0; x < half.width(); ++x) {
    std::array<CellReading, 3> cell;
    for (int dy = 0; dy < 2; ++dy) {
      for (int dx = 0; dx < 2; ++dx) {
        const int column = 2 * x + dx;
        for (int p = 0; p < planes.count; ++p) {
          const int c = planes.channel_at(p, column, y + dy);
          cell[static_cast<std::size_t>(c)].add(readings[static_cast<std::size_t>(p)](column, dy));
        }
      }
    }
    for (int c = 0; c < 3; ++c) half(x, y / 2, c) = cell[static_cast<std::size_t>(c)].mean();
  }
}

// The camera that sees the same with pixels of twice the size.
CameraModel half_camera(CameraModel camera, Size size) {
  camera.size = size;
  camera.fx /= 2;
  camera.fy /= 2;
  camera.cx = (camera.cx - 0.5) / 2;
  camera.cy = (camera.cy - 0.5) / 2;
  return camera;
}

Result<void> solve_tiles(const Photographs& photographs, const solver::Method& method,
                         const TileOptions& tile, const JobContext& context, const BandSink& sink,
                         BandOptions options, FrameFacts& facts) {
  options.tally = &facts.tally;
  const Result<double> waited = solve_bands(photographs, method, tile, context, sink, options);
  if (!waited) return waited.error();
  facts.waited_seconds = *waited;
  return {};
}

// What lights tell of a method, or of the blocks that two methods share, when they are left out.
Result<void> check(const Photographs& photographs, const solver::Method& method, const JobContext& context,
                   FrameFacts& facts) {
  Result<solver::LeftOut> left_out =
      leave_out_lights(photographs, {.method = &method},
                       solver::patches_of(photographs.size, solver::PatchUse::kReport), context);
  if (!left_out) return std::move(left_out).error();
  facts.left_out = std::move(*left_out);
  return {};
}

Result<FrameFacts> solve_as_seen(const Photographs& photographs, const solver::MethodName& method,
                                 const TileOptions& tile, const JobContext& context, const BandSink& sink) {
  FrameFacts facts;
  const std::unique_ptr<solver::Method> asked = method.make();
  if (method.extent == solver::Extent::kWholeFrame) {
    Result<ReferenceFacts> solved = solve_reference(photographs, tile, {}, context, sink);
    if (!solved) return std::move(solved).error();
    facts.waited_seconds = solved->waited_seconds;
    facts.tally = solved->tally;
    facts.robust_share = solved->robust_share;
    facts.gloss = solved->gloss;
    facts.work = solved->work;
    facts.left_out = std::move(solved->left_out);
    facts.reference = std::move(*solved);
    return facts;
  }
  BandOptions bands = {.model = solver::ModelTraits{.is_half = method.extent == solver::Extent::kHalfSize}};
  const std::unique_ptr<solver::Method> standard = solver::method_of(solver::Level::kStandard).make();
  std::unique_ptr<solver::Method> by_block;
  std::optional<solver::BlockChoice> robust;
  if (method.level == solver::Level::kRobust) {
    Result<solver::BlockChoice> choice =
        choose_by_block(photographs, {.method = standard.get()}, {.method = asked.get()}, context);
    if (!choice) return std::move(choice).error();
    facts.robust_share = choice->share();
    by_block = solver::blended_method(*standard, *asked, *choice);
    bands.robust = &robust.emplace(std::move(*choice));
  }
  const solver::Method* chosen = by_block ? by_block.get() : asked.get();
  std::optional<Gloss> gloss;
  if (method.level == solver::Level::kRobust) {
    Result<Gloss> found = Gloss::find(photographs, *chosen, nullptr, context);
    if (!found) return std::move(found).error();
    facts.gloss = found->facts;
    facts.work.lobe = found->facts.seconds;
    chosen = &gloss.emplace(std::move(*found)).over(*chosen);
  }
  if (Result<void> ok = solve_tiles(photographs, *chosen, tile, context, sink, bands, facts); !ok)
    return std::move(ok).error();
  if (Result<void> ok = check(photographs, *chosen, context, facts); !ok) return std::move(ok).error();
  return facts;
}

}  // namespace

Result<FrameFacts> solve_frame(const Photographs& photographs, const solver::MethodName& method,
                               const TileOptions& tile, const JobContext& context, const BandSink& sink) {
  const Planes planes = method.make()->wants_rgb() ? Planes() : photographs.planes();
  BandSink next = sink;
  std::optional<Deblur> deblur;
  if (photographs.spread) {
    deblur.emplace(photographs.size, planes, *photographs.spread, context.threads, sink);
    next = [&](const MapBand& band) { return deblur->put(band); };
  }
  std::optional<Realign> realign;
  if (photographs.lateral && photographs.camera && planes.count == 1) {
    realign.emplace(photographs.size, planes.cfa, *photographs.lateral, *photographs.camera, context.threads,
                    next);
  }
  const BandSink aligned = [&](const MapBand& band) { return realign->put(band); };
  Stopwatch watch;
  Result<FrameFacts> facts = solve_as_seen(photographs, method, tile, context, realign ? aligned : next);
  if (facts) facts->work.frame = watch.lap() - facts->waited_seconds - facts->work.total();
  if (facts && deblur) facts->deblur = deblur->facts();
  if (facts && realign) {
    facts->lateral_corner_px = {shift_at_corner(photographs.lateral->red, *photographs.camera),
                                shift_at_corner(photographs.lateral->blue, *photographs.camera)};
  }
  return facts;
}

Result<Photographs> half_size(const Photographs& photographs, int threads) {
  const Size size = {photographs.size.width / 2, photographs.size.height / 2};
  if (size.width == 0 || size.height == 0) {
    return Error{ErrorKind::kBadData, "picture is too small for a preview", "photographs",
                 "it has fewer than two rows or columns", "solve it with --quality fast"};
  }
  Photographs half;
  half.size = size;
  half.leds = photographs.leds;
  half.albedo_scale = photographs.albedo_scale;
  half.color = photographs.color;
  half.camera = photographs.camera;
  if (half.camera) half.camera = half_camera(*half.camera, size);
  Result<LightField> field =
      LightField::make(photographs.field->lights(), half.camera, size, photographs.field->cloth_height_mm());
  if (!field) return std::move(field).error();
  half.field = std::move(*field);
  std::vector<Image<float>> rgb;
  for (std::size_t k = 0; k < photographs.count(); ++k) rgb.emplace_back(size, 3);

  const Planes planes = photographs.planes();
  const TileOptions rows = {.width = photographs.size.width, .height = 2};
  std::vector<TileReader> readers;
  for (int i = 0; i < resolved_threads(threads); ++i) readers.emplace_back(photographs, rows);
  parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t i, int worker) {
    const int y = 2 * static_cast<int>(i);
    const std::span<const View<const float>> readings =
        readers[static_cast<std::size_t>(worker)].read({0, y, photographs.size.width, y + 2}).readings;
    const auto count = static_cast<std::size_t>(planes.count);
    for (std::size_t k = 0; k < rgb.size(); ++k)
      halve_rows(planes, readings.subspan(k * count, count), y, rgb[k]);
  });
  half.frames = Developed{std::move(rgb)};
  half.lobe_share = photographs.lobe_share;
  half.plane_weights = photographs.plane_weights;
  return half;
}

}  // namespace weft::pipeline
