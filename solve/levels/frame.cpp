// SPDX-License-Identifier: Apache-2.0
#include "solve/levels/frame.h"

#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "solve/levels/stages.h"
#include "solve/photographs/tile_reader.h"

namespace weft::solve {
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

}  // namespace

Result<FrameFacts> solve_frame(const Photographs& photographs, const solver::MethodName& method,
                               const TileOptions& tile, const JobContext& context, const BandSink& sink,
                               bool looks_at_blocks) {
  return solve_by(stages_of(method), photographs, tile, context, sink, looks_at_blocks);
}

Result<FrameFacts> solve_by(std::span<const Stage> stages, const Photographs& photographs,
                            const TileOptions& tile, const JobContext& context, const BandSink& sink,
                            bool looks_at_blocks) {
  Solving solving = {photographs, tile, context, sink, looks_at_blocks};
  FrameFacts& facts = solving.facts;
  Stopwatch watch;
  for (const Stage& stage : stages) {
    if (stage.is_needed && !stage.is_needed(solving)) continue;
    if (Result<void> ok = stage.apply(solving); !ok) return std::move(ok).error();
  }
  facts.work.frame = watch.lap() - facts.waited_seconds - facts.work.total();
  return std::move(facts);
}

std::vector<Stage> without(std::string_view name, std::vector<Stage> stages) {
  std::erase_if(stages, [&](const Stage& stage) { return stage.name == name; });
  return stages;
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
  half.frames = Developed(std::move(rgb));
  half.lobe_share = photographs.lobe_share;
  half.plane_weights = photographs.plane_weights;
  half.sigma_slope = photographs.sigma_slope;
  return half;
}

}  // namespace weft::solve
