// SPDX-License-Identifier: Apache-2.0
#include "pipeline/light_correction.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>

#include "core/job.h"
#include "core/parallel.h"
#include "pipeline/picture_axes.h"
#include "solver/transport/gather.h"

namespace weft::pipeline {
namespace {

constexpr int kBlockColumns = 512;
// As many lights as a normal takes and one to test it by.
constexpr int kLeastSeen = 4;

// The strength of light k in channel c along a row, straight between points a grid cell apart.
void read_strengths(const LightField& field, std::size_t k, int c, int y, int x0, int x1, float* strength) {
  constexpr int kCell = LightField::kCell;
  for (int cell = x0 / kCell * kCell; cell < x1; cell += kCell) {
    const double left = field.at(k, c, cell, y).strength, right = field.at(k, c, cell + kCell, y).strength;
    for (int x = std::max(cell, x0); x < std::min(cell + kCell, x1); ++x) {
      strength[x - x0] = static_cast<float>(left + (right - left) * (x - cell) / kCell);
    }
  }
}

Rect rows_of(Rect area, int first, int count) {
  return {area.x0, first, area.x1, std::min(first + count, area.y1)};
}

}  // namespace

// What one thread needs.
struct LightCorrection::Worker {
  TileReader reader;
  std::vector<float> radiosity;
  std::vector<float> strengths;
  Rect radiosity_area;
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
      threads_(resolved_threads(threads)) {
  directions_.count = photographs.count();
  directions_.at = [&photographs, axes = picture_from_rig(photographs.camera)](std::size_t k, int x, int y) {
    return axes * photographs.field->at(k, 1, x, y).direction;
  };
  if (options_.stages.shadows) shadow_reach_ = solver::shadow_reach(relief, directions_);
}

// Readings over strength of all pixels of `area`, side by side; what cannot be used is predicted from the
// solved frame.
void LightCorrection::read_radiosity(Rect area, Worker& worker) const {
  constexpr int kTileRows = 16;
  const LightField& field = *photographs_->field;
  const std::size_t lights = photographs_->count();
  const auto planes = static_cast<std::size_t>(planes_.count);
  const auto width = static_cast<std::size_t>(area.width());
  worker.radiosity_area = area;
  worker.radiosity.resize(width * static_cast<std::size_t>(area.height()) * lights * planes);
  worker.strengths.resize(width * 3);
  for (int y0 = area.y0; y0 < area.y1; y0 += kTileRows) {
    const Rect tile = rows_of(area, y0, kTileRows);
    const std::span<const View<const float>> readings = worker.reader.read(tile).readings;
    for (int y = tile.y0; y < tile.y1; ++y) {
      float* row = worker.radiosity.data() + static_cast<std::size_t>(y - area.y0) * width * lights * planes;
      for (std::size_t k = 0; k < lights; ++k) {
        for (int c = 0; c < 3; ++c) {
          read_strengths(field, k, c, y, area.x0, area.x1,
                         worker.strengths.data() + static_cast<std::size_t>(c) * width);
        }
        for (std::size_t p = 0; p < planes; ++p) {
          const float* reading = readings[k * planes + p].row(y - tile.y0);
          for (std::size_t i = 0; i < width; ++i) {
            const int x = area.x0 + static_cast<int>(i);
            const auto c = static_cast<std::size_t>(planes_.channel_at(static_cast<int>(p), x, y));
            float value = reading[i] / worker.strengths[c * width + i];
            if (!std::isfinite(value)) {
              const Vec3 n = {solved_->normal(x, y, 0), solved_->normal(x, y, 1), solved_->normal(x, y, 2)};
              const double lit = std::max(0.0, dot(n, directions_.at(k, x, y)));
              value =
                  static_cast<float>(static_cast<double>(solved_->albedo(x, y, static_cast<int>(p))) * lit);
            }
            row[(i * lights + k) * planes + p] = value;
          }
        }
      }
    }
  }
}

Result<void> LightCorrection::trace_block(Rect block, Worker& worker) {
  const int bounce_reach = options_.stages.interreflection ? options_.reach_px + 1 : 0;
  const int halo = std::max(shadow_reach_.reach_px + 1, bounce_reach);
  Result<solver::HeightGrid> grid = solver::HeightGrid::build(*relief_, block, halo);
  if (!grid) return std::move(grid).error();
  const solver::Normals normals = {solved_->normal.plane(0).crop(block), solved_->normal.plane(1).crop(block),
                                   solved_->normal.plane(2).crop(block)};
  const Rect local = {block.x0, block.y0 - slab_.y0, block.x1, block.y1 - slab_.y0};
  if (options_.stages.shadows) {
    std::vector<View<std::uint32_t>> words;
    for (int w = 0; w < visible_.planes(); ++w) words.push_back(visible_.plane(w).crop(local));
    if (Result<void> ok =
            solver::find_visible_lights(*grid, block, normals, directions_, shadow_reach_.reach_px, words);
        !ok) {
      return ok;
    }
  }
  if (!options_.stages.interreflection) return {};
  Rect area = solver::within_reach(*relief_, block, options_.reach_px);
  area.x0 = area.x0 / kRowGroup * kRowGroup;
  read_radiosity(area, worker);
  std::vector<View<float>> arriving;
  for (int p = 0; p < arriving_.planes(); ++p) arriving.push_back(arriving_.plane(p).crop(local));
  return solver::gather_light(*grid, block, normals, {area, arriving_.planes(), worker.radiosity},
                              {options_.rays, options_.reach_px, planes_.count == 1}, arriving);
}

Result<void> LightCorrection::prepare(Rect rows) {
  if (rows.y0 >= slab_.y0 && rows.y1 <= slab_.y1 && slab_.height() > 0) return {};
  Stopwatch watch;
  const Size size = photographs_->size;
  slab_ = {0, rows.y0, size.width, std::min(std::max(rows.y0 + kSlabRows, rows.y1), size.height)};
  const Size slab = {size.width, slab_.height()};
  if (arriving_.size() != slab) {
    if (options_.stages.interreflection)
      arriving_ = Image<float>(slab, static_cast<int>(photographs_->count()) * planes_.count);
    if (options_.stages.shadows) {
      visible_ = Image<std::uint32_t>(slab, solver::visibility_words(photographs_->count()));
    }
  }
  std::vector<Rect> blocks;
  for (int x = 0; x < size.width; x += kBlockColumns) {
    blocks.push_back({x, slab_.y0, std::min(x + kBlockColumns, size.width), slab_.y1});
  }
  std::vector<Worker> workers;
  for (int i = 0; i < threads_; ++i) {
    const TileOptions tile = {.width = kBlockColumns + 2 * options_.reach_px + 2 * kRowGroup, .height = 16};
    workers.push_back({TileReader(*photographs_, tile), {}, {}, {}});
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
  const LightField& field = *photographs_->field;
  const std::size_t lights = photographs_->count();
  const auto planes = static_cast<std::size_t>(planes_.count);
  const auto width = static_cast<std::size_t>(tile.width());
  std::vector<float> strengths(3 * width);
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (std::size_t k = 0; k < lights; ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        read_strengths(field, k, static_cast<int>(c), y, tile.x0, tile.x1, strengths.data() + c * width);
      }
      for (std::size_t p = 0; p < planes; ++p) {
        float* reading = readings[k * planes + p].row(y - tile.y0);
        for (std::size_t i = 0; i < width; ++i) {
          const int x = tile.x0 + static_cast<int>(i), row = y - slab_.y0;
          const auto c = static_cast<std::size_t>(planes_.channel_at(static_cast<int>(p), x, y));
          const float albedo = scale * solved_->albedo(x, y, static_cast<int>(p));
          reading[i] -=
              albedo * arriving_(x, row, static_cast<int>(k * planes + p)) * strengths[c * width + i];
        }
      }
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

}  // namespace weft::pipeline
