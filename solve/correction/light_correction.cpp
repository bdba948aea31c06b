// SPDX-License-Identifier: Apache-2.0
#include "solve/correction/light_correction.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>

#include "core/base/job_context.h"
#include "core/base/parallel.h"
#include "solve/photographs/picture_axes.h"
#include "solver/transport/marched_shadows.h"
#include "solver/transport/slices.h"

namespace weft::solve {
namespace {

constexpr int kBlockColumns = 512;
// As many lights as a normal takes and one to test it by.
constexpr int kLeastSeen = 4;

Rect rows_of(Rect area, int first, int count) {
  return {area.x0, first, area.x1, std::min(first + count, area.y1)};
}

// The least rectangle that holds all of at least one tile.
Rect around(const std::vector<Rect>& tiles) {
  Rect all = tiles.front();
  for (const Rect& tile : tiles) {
    all = {std::min(all.x0, tile.x0), std::min(all.y0, tile.y0), std::max(all.x1, tile.x1),
           std::max(all.y1, tile.y1)};
  }
  return all;
}

}  // namespace

// What one thread needs.
struct LightCorrection::Worker {
  TileReader reader;
  Image<float> radiosity = {};  // [k * planes + p] of radiosity_area, 0 where there is no picture
  std::vector<float> strengths = {};
  Rect radiosity_area = {};
};

LightCorrection::LightCorrection(const Photographs& photographs, const SolvedFrame& solved,
                                 const solver::Relief& relief, const LightCorrectionOptions& options,
                                 int threads)
    : photographs_(&photographs),
      solved_(&solved),
      relief_(&relief),
      planes_(photographs.planes()),
      options_(options),
      applied_(options.stages),
      threads_(resolved_threads(threads)),
      strengths_(*photographs.field, photographs.size, threads_) {
  directions_.count = photographs.count();
  directions_.at = [&photographs, axes = picture_from_rig(photographs.camera)](std::size_t k, int x, int y) {
    return axes * photographs.field->at(k, 1, x, y).direction;
  };
  if (options_.stages.shadows) shadow_reach_ = solver::shadow_reach(relief, directions_);
}

// Calls use(color, first) for each of the two colours that take turns along a row of a plane: of the columns
// from `first` on every other one is of that colour.
template <typename Use>
void LightCorrection::for_each_color(int plane, int y, int x0, int x1, const Use& use) const {
  for (int x = x0; x < std::min(x0 + 2, x1); ++x) use(planes_.channel_at(plane, x, y), x);
}

// Readings over strength of all pixels of `area` that the picture has.
void LightCorrection::read_radiosity(Rect area, Worker& worker) const {
  constexpr int kTileRows = 16;
  const int planes = static_cast<int>(photographs_->count()) * planes_.count;
  const Rect picture = {0, 0, photographs_->size.width, photographs_->size.height};
  worker.radiosity = Image<float>({area.width(), area.height()}, planes);
  worker.radiosity_area = area;
  const Rect inside = {std::max(area.x0, 0) / kRowGroup * kRowGroup, std::max(area.y0, 0),
                       std::min(area.x1, picture.x1), std::min(area.y1, picture.y1)};
  worker.strengths.resize(static_cast<std::size_t>(inside.width()));
  for (int y0 = inside.y0; y0 < inside.y1; y0 += kTileRows) {
    const Rect tile = rows_of(inside, y0, kTileRows);
    const std::span<const View<const float>> readings = worker.reader.read(tile).readings;
    for (int y = tile.y0; y < tile.y1; ++y) read_radiosity_row(tile, y, readings, worker);
  }
}

// What cannot be used is predicted from the solved frame.
void LightCorrection::read_radiosity_row(Rect tile, int y, std::span<const View<const float>> readings,
                                         Worker& worker) const {
  const Rect area = worker.radiosity_area;
  const int first = std::max(tile.x0, area.x0);
  for (std::size_t k = 0; k < photographs_->count(); ++k) {
    for (int p = 0; p < planes_.count; ++p) {
      const auto plane = k * static_cast<std::size_t>(planes_.count) + static_cast<std::size_t>(p);
      const float* reading = readings[plane].row(y - tile.y0) - tile.x0;
      float* sent = worker.radiosity.plane(static_cast<int>(plane)).row(y - area.y0) - area.x0;
      for_each_color(p, y, first, tile.x1, [&](int c, int from) {
        strengths_.read(k, c, y, tile.x0, tile.x1, worker.strengths.data());
        for (int x = from; x < tile.x1; x += 2)
          sent[x] = reading[x] / worker.strengths[static_cast<std::size_t>(x - tile.x0)];
      });
      for (int x = first; x < tile.x1; ++x) {
        if (std::isfinite(sent[x])) continue;
        const Vec3 n = {solved_->normal(x, y, 0), solved_->normal(x, y, 1), solved_->normal(x, y, 2)};
        const double lit = std::max(0.0, dot(n, directions_.at(k, x, y)));
        sent[x] = static_cast<float>(static_cast<double>(solved_->albedo(x, y, p)) * lit);
      }
    }
  }
}

Result<void> LightCorrection::find_shadows(Rect tile, const solver::Normals& normals) {
  std::vector<View<std::uint32_t>> words;
  for (int w = 0; w < visible_.planes(); ++w) words.push_back(visible_.plane(w).crop(in_slab(tile)));
  return solver::march_to_lights(*relief_, tile, normals, directions_, shadow_reach_.reach_px, words);
}

Result<void> LightCorrection::gather_bounces(Rect tile, const solver::Normals& normals, Worker& worker) {
  std::vector<View<const float>> sent;
  std::vector<View<float>> arriving;
  for (int p = 0; p < arriving_.planes(); ++p) {
    sent.emplace_back(worker.radiosity.plane(p));
    arriving.push_back(arriving_.plane(p).crop(in_slab(tile)));
  }
  return solver::gather_by_slices(
      *relief_, tile, normals, {worker.radiosity_area, sent},
      {options_.directions, options_.steps, options_.reach_px, planes_.count == 1}, arriving);
}

// What is to be traced of a block.
std::vector<Rect> LightCorrection::tiles_in(Rect block) const {
  if (tiles_.empty()) return {block};
  std::vector<Rect> inside;
  for (const Rect& tile : tiles_) {
    const Rect part = {std::max(tile.x0, block.x0), tile.y0, std::min(tile.x1, block.x1), tile.y1};
    if (part.x0 < part.x1) inside.push_back(part);
  }
  return inside;
}

Result<void> LightCorrection::trace_block(Rect block, Worker& worker) {
  const std::vector<Rect> tiles = tiles_in(block);
  if (options_.stages.interreflection && !tiles.empty())
    read_radiosity(solver::area_of_slices(around(tiles), options_.reach_px), worker);
  for (const Rect& tile : tiles) {
    const auto normal = [&](int axis) { return solved_->normal.plane(axis).crop(tile); };
    const solver::Normals normals = {normal(0), normal(1), normal(2)};
    if (options_.stages.shadows) {
      if (Result<void> ok = find_shadows(tile, normals); !ok) return ok;
    }
    if (options_.stages.interreflection) {
      if (Result<void> ok = gather_bounces(tile, normals, worker); !ok) return ok;
    }
  }
  return {};
}

Result<void> LightCorrection::prepare(Rect rows) {
  const bool is_there = rows.y0 >= slab_.y0 && rows.y1 <= slab_.y1 && slab_.height() > 0 && tiles_.empty();
  if (is_there) return {};
  const Size size = photographs_->size;
  slab_ = {0, rows.y0, size.width, std::min(std::max(rows.y0 + kSlabRows, rows.y1), size.height)};
  tiles_.clear();
  return trace();
}

Result<void> LightCorrection::prepare_only(Rect rows, std::span<const Rect> tiles) {
  if (rows == slab_ && std::ranges::equal(tiles, tiles_)) return {};
  slab_ = rows;
  tiles_.assign(tiles.begin(), tiles.end());
  return tiles.empty() ? Result<void>() : trace();
}

// The slab, or its tiles.
Result<void> LightCorrection::trace() {
  Stopwatch watch;
  const Size slab = {slab_.width(), slab_.height()};
  if (options_.stages.interreflection && arriving_.size() != slab)
    arriving_ = Image<float>(slab, static_cast<int>(photographs_->count()) * planes_.count);
  if (options_.stages.shadows && visible_.size() != slab)
    visible_ = Image<std::uint32_t>(slab, solver::visibility_words(photographs_->count()));
  std::vector<Rect> blocks;
  for (int x = 0; x < slab_.x1; x += kBlockColumns) {
    blocks.push_back({x, slab_.y0, std::min(x + kBlockColumns, slab_.x1), slab_.y1});
  }
  std::vector<Worker> workers;
  for (int i = 0; i < threads_; ++i) {
    const TileOptions tile = {.width = kBlockColumns + 2 * options_.reach_px + 2 * kRowGroup, .height = 16};
    workers.push_back({TileReader(*photographs_, tile)});
  }
  std::mutex mutex;
  std::optional<Error> failure;
  parallel_for(blocks.size(), threads_, [&](std::size_t i, int worker) {
    const Result<void> traced = trace_block(blocks[i], workers[static_cast<std::size_t>(worker)]);
    if (traced) return;
    const std::lock_guard lock(mutex);
    if (!failure) failure = traced.error();
  });
  seconds_ += watch.lap();
  if (failure) return *failure;
  return {};
}

// Bits of the lights that a pixel of the slab sees, or all where they are too few to be believed and solved
// with.
bool LightCorrection::sees(int x, int y, std::size_t k) const {
  int seen = 0;
  for (int w = 0; w < visible_.planes(); ++w) seen += std::popcount(visible_(x, y, w));
  if (seen < kLeastSeen) return true;
  return (visible_(x, y, static_cast<int>(k / 32)) >> (k % 32) & 1U) != 0;
}

void LightCorrection::apply(Rect tile, std::span<const View<float>> readings) const {
  subtract_bounces(tile, readings);
  mark_shadows(tile, readings);
}

void LightCorrection::subtract_bounces(Rect tile, std::span<const View<float>> readings) const {
  if (!applied_.interreflection) return;
  const auto scale = static_cast<float>(applied_.albedo_scale);
  std::vector<float> strengths(static_cast<std::size_t>(tile.width()));
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const std::size_t k = i / static_cast<std::size_t>(planes_.count);
    const int p = static_cast<int>(i % static_cast<std::size_t>(planes_.count));
    for (int y = tile.y0; y < tile.y1; ++y) {
      float* reading = readings[i].row(y - tile.y0) - tile.x0;
      const float* albedo = solved_->albedo.plane(p).row(y);
      const float* arriving = arriving_.plane(static_cast<int>(i)).row(y - slab_.y0);
      for_each_color(p, y, tile.x0, tile.x1, [&](int c, int first) {
        strengths_.read(k, c, y, tile.x0, tile.x1, strengths.data());
        for (int x = first; x < tile.x1; x += 2)
          reading[x] -= scale * albedo[x] * arriving[x] * strengths[static_cast<std::size_t>(x - tile.x0)];
      });
    }
  }
}

void LightCorrection::mark_shadows(Rect tile, std::span<const View<float>> readings) const {
  if (!applied_.shadows) return;
  const auto planes = static_cast<std::size_t>(planes_.count);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    for (int y = tile.y0; y < tile.y1; ++y) {
      float* reading = readings[i].row(y - tile.y0);
      for (int x = tile.x0; x < tile.x1; ++x) {
        // What cannot be read stays so: the reason counts.
        float& here = reading[x - tile.x0];
        if (std::isfinite(here) && !sees(x, y - slab_.y0, i / planes))
          here = -std::numeric_limits<float>::infinity();
      }
    }
  }
}

}  // namespace weft::solve
