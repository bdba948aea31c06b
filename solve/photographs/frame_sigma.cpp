// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/frame_sigma.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "solver/kernels/demosaic.h"

namespace weft::solve {
namespace {

constexpr int kCell = 2;
// Rows of angles kept from the band before: those of the pixels that waited for demosaicing.
constexpr int kKept = solver::kDemosaicReach;
// Columns of a block. Over so many the lights change by a percent.
constexpr int kBlock = 64;
// Every such row of a block is looked at: a multiple of the filter's period.
constexpr int kRowsApart = 4;
// Rows of bands that share what is known of the lights: a multiple of a band's.
constexpr int kLightRows = 256;

// Length of the step from normal a to normal b, negative if component `axis` falls.
float step_of(const std::array<float, 3>& a, const std::array<float, 3>& b, std::size_t axis) {
  const float x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
  return std::copysign(std::sqrt(x * x + y * y + z * z), b[axis] - a[axis]);
}

// within_pixel2() by three normals in a row, in the direction in which `axis` grows. Beyond the edge it goes
// on as before.
float within_of(const std::array<float, 3>* before, const std::array<float, 3>& here,
                const std::array<float, 3>* after, std::size_t axis) {
  if (before == nullptr && after == nullptr) return 0;
  const float to = before != nullptr ? step_of(*before, here, axis) : step_of(here, *after, axis);
  return solver::within_pixel2(to, after != nullptr ? step_of(here, *after, axis) : to);
}

std::size_t cells_of(int pixels) {
  return static_cast<std::size_t>((pixels + kCell - 1) / kCell);
}

}  // namespace

ModelPart::CellRow::CellRow(int cells)
    : sums({cells + 2, 1}, static_cast<int>(solver::kCellFacts)), means({kCell * cells, 1}, 2) {}

ModelPart::ModelPart(const Photographs& photographs, int band_rows, const solver::ModelTraits& traits,
                     const solver::BlockChoice* robust, int threads, bool looks_at_blocks)
    : photographs_(photographs),
      planes_(photographs.planes()),
      has_noise_(photographs.noise().has_value()),
      traits_(traits),
      robust_(robust),
      threads_(threads),
      looks_at_blocks_(looks_at_blocks),
      cells_({static_cast<int>(cells_of(photographs.size.width)) + 2, static_cast<int>(cells_of(band_rows))},
             static_cast<int>(solver::kCellFacts)),
      angles_({photographs.size.width, kKept + band_rows}) {
  if (traits.is_half) within2_ = Image<float>({photographs.size.width, band_rows});
}

// What the lights around each block say, for all bands that begin in the next kLightRows rows. Bands begin
// with the phase of the filter.
void ModelPart::set_lights(int y0) {
  blocks_.assign(static_cast<std::size_t>((photographs_.size.width + kBlock - 1) / kBlock), {});
  const LightField& field = *photographs_.field;
  const int y = std::min(y0 + kLightRows / 2, photographs_.size.height - 1);
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    Block& block = blocks_[i];
    const int x = column_of(i);
    block.around.degrees_a_residual = static_cast<float>(solver::degrees_a_residual(field, x, y));
    if (!has_noise_) continue;
    std::array<solver::ResidualNoise, 3> noise;
    for (int c = 0; c < 3; ++c) {
      noise[static_cast<std::size_t>(c)] = solver::residual_noise(field, *photographs_.noise(), x, y, c);
    }
    for (int row = 0; row < 2; ++row) {
      for (int column = 0; column < 2; ++column) {
        const auto c = static_cast<std::size_t>(planes_.channel_at(planes_.speaker(), column, row));
        block.noise[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = noise[c];
      }
    }
  }
}

int ModelPart::column_of(std::size_t block) const {
  return std::min(static_cast<int>(block) * kBlock + kBlock / 2, photographs_.size.width - 1);
}

solver::SolvedPixels ModelPart::pixels_at(int x, int y, const SolvedRows& solved) const {
  const auto at = [&](const auto& view) { return view.row(y) + x; };
  return {{at(solved.normal[0]), at(solved.normal[1]), at(solved.normal[2])},
          at(solved.residual),
          at(solved.albedo),
          at(solved.status),
          blocks_[static_cast<std::size_t>(x / kBlock)].noise[static_cast<std::size_t>(y % 2)]};
}

// The pixel that speaks for a cell is another corner in each of four neighbouring cells, so that they have
// all filters between them. A last row or column that is half a cell speaks for it.
void ModelPart::see_row(int cell_y, const SolvedRows& solved) {
  const int width = solved.status.width(), height = solved.status.height();
  const auto see = [&](int x, bool odd_column, std::size_t count) {
    const auto row = [&](int y) { return pixels_at(x, std::min(y, height - 1), solved); };
    std::array<float*, solver::kCellFacts> facts;
    for (std::size_t f = 0; f < facts.size(); ++f) {
      facts[f] = cells_.plane(static_cast<int>(f)).row(cell_y) + 1 + x / kCell;
    }
    const bool is_odd = x / kCell % 2 != 0;  // the first cell: lanes count from 0
    solver::see_cells({row(kCell * cell_y + (is_odd ? 1 : 0)), row(kCell * cell_y + (is_odd ? 0 : 1))},
                      odd_column, has_noise_, count, facts);
  };
  for (int x = 0; x < width; x += kBlock) see(x, cell_y % 2 != 0, cells_of(std::min(kBlock, width - x)));
  if (width % kCell != 0) see(width - 1, false, 1);
  for (int f = 0; f < cells_.planes(); ++f) cells_(static_cast<int>(cells_of(width)) + 1, cell_y, f) = 0;
}

void ModelPart::sum_blocks(int cell_rows) {
  parallel_for(blocks_.size(), threads_, [&](std::size_t i, int) {
    constexpr std::size_t kCells = kBlock / kCell;
    const std::size_t first = i * kCells, count = std::min(kCells, cells_of(photographs_.size.width) - first);
    const auto total = [&](solver::CellFact fact) {
      std::array<float, kCells + kRowGroup> sums = {};
      for (int row = 0; row < cell_rows; ++row) {
        solver::add_cells(cells_.plane(static_cast<int>(fact)).row(row) + 1 + first, count, sums.data());
      }
      float sum = 0;
      for (std::size_t x = 0; x < count; ++x) sum += sums[x];
      return sum;
    };
    const float pixels = total(solver::kCellPixels);
    const float share = pixels > 0 ? 1 / pixels : 0;
    blocks_[i].around.slope2 = share * total(solver::kCellSlope2);
    blocks_[i].around.misfit2 = share * std::max(total(solver::kCellMisfit2), 0.0F);
  });
}

void ModelPart::see_within(const SolvedRows& solved) {
  const int width = solved.status.width(), height = solved.status.height();
  const auto normal_at = [&](int x, int y) {
    return std::array{solved.normal[0](x, y), solved.normal[1](x, y), solved.normal[2](x, y)};
  };
  parallel_for(static_cast<std::size_t>(height), threads_, [&](std::size_t i, int) {
    const int y = static_cast<int>(i);
    for (int x = 0; x < width; ++x) {
      const std::array<float, 3> here = normal_at(x, y), left = normal_at(std::max(x - 1, 0), y),
                                 right = normal_at(std::min(x + 1, width - 1), y),
                                 above = normal_at(x, std::max(y - 1, 0)),
                                 below = normal_at(x, std::min(y + 1, height - 1));
      const float within2 = within_of(x > 0 ? &left : nullptr, here, x + 1 < width ? &right : nullptr, 0) +
                            within_of(y + 1 < height ? &below : nullptr, here, y > 0 ? &above : nullptr, 1);
      within2_(x, y) = within2;
    }
  });
}

void ModelPart::angles_of(int cell_y, int cell_rows, const SolvedRows& solved, CellRow& row) {
  const int width = solved.status.width();
  const std::size_t cells = cells_of(width);
  std::array<const float*, solver::kCellFacts> columns;
  for (std::size_t f = 0; f < columns.size(); ++f) {
    float* sums = row.sums.plane(static_cast<int>(f)).row(0);
    std::fill_n(sums, cells + 2, 0.0F);
    for (int y = std::max(cell_y - 1, 0); y < std::min(cell_y + 2, cell_rows); ++y) {
      solver::add_cells(cells_.plane(static_cast<int>(f)).row(y), cells + 2, sums);
    }
    columns[f] = sums;
  }
  const solver::CellMeans means = {row.means.plane(0).row(0), row.means.plane(1).row(0)};
  mean_around(columns, cells, means);
  for (int y = kCell * cell_y; y < std::min(kCell * (cell_y + 1), solved.status.height()); ++y) {
    for (int x = 0; x < width; x += kBlock) {
      const Block& block = blocks_[static_cast<std::size_t>(x / kBlock)];
      model_angles(pixels_at(x, y, solved), {means.slope2 + x, means.albedo + x},
                   traits_.is_half ? within2_.plane().row(y) + x : nullptr, block.around, traits_, has_noise_,
                   static_cast<std::size_t>(std::min(kBlock, width - x)), angles_.plane().row(kKept + y) + x);
    }
  }
}

void ModelPart::look_at_blocks(const SolvedRows& solved) {
  const int width = solved.status.width(), height = solved.status.height();
  // The greens, in a mosaic's rows of even number.
  const int from = planes_.channel_at(planes_.speaker(), 0, 0) == 1 || width < 2 ? 0 : 1;
  const std::size_t first = facts_.size();
  facts_.resize(first + blocks_.size());
  parallel_for(blocks_.size(), threads_, [&](std::size_t i, int) {
    const int x0 = static_cast<int>(i) * kBlock, columns = std::min(kBlock, width - x0);
    const int x = x0 + (columns > from ? from : 0);
    solver::BlockSums sums;
    for (int y = 0; y < height; y += kRowsApart) {
      const int below = std::min(y + 1, height - 1);
      const auto at = [&](const auto& view, int row) { return view.row(row) + x; };
      sums.add({{at(solved.normal[0], y), at(solved.normal[1], y), at(solved.normal[2], y)},
                {at(solved.normal[0], below), at(solved.normal[1], below), at(solved.normal[2], below)},
                at(solved.residual, y),
                at(solved.albedo, y),
                at(solved.sigma_normal_deg, y),
                angles_.plane().row(kKept + y) + x,
                at(solved.status, y)},
               x0 + columns - x);
    }
    facts_[first + i] = sums.facts(traits_, blocks_[i].around.robust);
  });
}

void ModelPart::gather(Rect band, const SolvedRows& solved) {
  for (int j = 0; j < kKept && band.y0 > 0; ++j) {
    std::copy_n(angles_.plane().row(band.y0 - first_ - kKept + j), band.width(), angles_.plane().row(j));
  }
  first_ = band.y0 - kKept;
  if (band.y0 % kLightRows == 0) set_lights(band.y0);
  for (std::size_t i = 0; i < blocks_.size() && robust_ != nullptr; ++i) {
    blocks_[i].around.robust = robust_->weight_at(column_of(i), (band.y0 + band.y1) / 2);
  }
  const std::size_t cell_rows = cells_of(band.height());
  parallel_for(cell_rows, threads_, [&](std::size_t i, int) { see_row(static_cast<int>(i), solved); });
  sum_blocks(static_cast<int>(cell_rows));
  if (traits_.is_half) see_within(solved);
  std::vector<CellRow> rows;
  for (int i = 0; i < threads_; ++i) rows.emplace_back(static_cast<int>(cells_of(band.width())));
  parallel_for(cell_rows, threads_, [&](std::size_t i, int worker) {
    angles_of(static_cast<int>(i), static_cast<int>(cell_rows), solved,
              rows[static_cast<std::size_t>(worker)]);
  });
  if (looks_at_blocks_) look_at_blocks(solved);
}

void ModelPart::fill(Rect rows, const std::array<View<const float>, 3>& albedo, View<float> model_normal_deg,
                     const std::array<View<float>, 3>& model_albedo) const {
  parallel_for(static_cast<std::size_t>(rows.height()), threads_, [&](std::size_t i, int) {
    const int y = static_cast<int>(i);
    const auto width = static_cast<std::size_t>(rows.width());
    const float* angles = angles_.plane().row(rows.y0 + y - first_);
    std::copy_n(angles, width, model_normal_deg.row(y));
    for (std::size_t c = 0; c < 3; ++c) {
      solver::model_albedo_sigma(angles, albedo[c].row(y), width, model_albedo[c].row(y));
    }
  });
}

}  // namespace weft::solve
