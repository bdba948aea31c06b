// SPDX-License-Identifier: Apache-2.0
#include "pipeline/model_sigma.h"

#include <algorithm>

#include "core/parallel.h"
#include "core/solve_record.h"
#include "solver/kernels/demosaic.h"

namespace weft::pipeline {
namespace {

constexpr int kCell = 2;
// Rows of cells kept from the band before: those of the pixels that waited for demosaicing, and one above.
constexpr int kKept = solver::kDemosaicReach / kCell + 1;
// Columns of a block. Over so many the lights change by a percent.
constexpr int kBlock = 64;
// A slope of 56 degrees, a residual of three times the albedo, and the least that is divided by.
constexpr float kMostSlope2 = 2.25F, kMostResidual = 3, kLeastAlbedo = 1e-3F;

// What residuals have beyond noise.
float misfit2_of(float residual2, float noise2, float pixels) {
  return pixels > 0 ? std::max(residual2 - noise2, 0.0F) / pixels : 0;
}

}  // namespace

ModelPart::ModelPart(const Photographs& photographs, int band_rows, const solver::ModelTraits& traits,
                     int threads)
    : photographs_(photographs),
      planes_(photographs.planes()),
      has_noise_(photographs.noise().has_value()),
      traits_(traits),
      threads_(threads),
      cells_({(photographs.size.width + 1) / kCell, kKept + band_rows / kCell}, kSums) {}

// What each block knows before its pixels are seen.
void ModelPart::set_blocks(Rect band) {
  blocks_.assign(static_cast<std::size_t>((band.width() + kBlock - 1) / kBlock), {});
  const LightField& field = *photographs_.field;
  const int y = (band.y0 + band.y1) / 2;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const int x = std::min(static_cast<int>(i) * kBlock + kBlock / 2, band.width() - 1);
    blocks_[i].degrees_a_residual = static_cast<float>(solver::degrees_a_residual(field, x, y));
    for (int c = 0; c < 3 && has_noise_; ++c) {
      blocks_[i].noise[static_cast<std::size_t>(c)] =
          solver::ResidualNoise::at(field, *photographs_.noise(), x, y, c);
    }
  }
}

// Adds row y of the band, frame_y of the frame, to a row of cells.
void ModelPart::add_row(int frame_y, int y, const SolvedRows& solved, int row) {
  const float *nx = solved.normal[0].row(y), *ny = solved.normal[1].row(y), *nz = solved.normal[2].row(y);
  const float *residual = solved.residual.row(y), *rho = solved.albedo.row(y);
  const std::uint16_t* status = solved.status.row(y);
  std::array<float*, kSums> sums;
  for (int p = 0; p < kSums; ++p) sums[static_cast<std::size_t>(p)] = cells_.plane(p).row(row);
  const std::array<std::size_t, kCell> channel = {
      static_cast<std::size_t>(planes_.channel_at(planes_.speaker(), 0, frame_y)),
      static_cast<std::size_t>(planes_.channel_at(planes_.speaker(), 1, frame_y))};
  for (int x = 0; x < solved.status.width(); ++x) {
    if (status[x] & kNoSolution) continue;
    const int cell = x / kCell;
    const float z2 = nz[x] * nz[x], albedo = std::max(rho[x], kLeastAlbedo);
    const float q = residual[x] < kMostResidual ? residual[x] : kMostResidual;
    sums[kPixels][cell] += 1;
    sums[kSlope2][cell] += 1 - z2 < kMostSlope2 * z2 ? (1 - z2) / z2 : kMostSlope2;
    sums[kAlbedo][cell] += albedo;
    sums[kShaded][cell] += (status[x] & kShadowed) != 0 ? 1.0F : 0.0F;
    if (!has_noise_) continue;
    const Block& block = blocks_[static_cast<std::size_t>(x / kBlock)];
    sums[kResidual2][cell] += q * q;
    sums[kNoise2][cell] +=
        block.noise[channel[static_cast<std::size_t>(x % kCell)]](nx[x], ny[x], nz[x], albedo);
  }
}

// Of all cells from `first_row` on.
void ModelPart::sum_blocks(int first_row) {
  parallel_for(blocks_.size(), threads_, [&](std::size_t i, int) {
    const int x0 = static_cast<int>(i) * kBlock / kCell;
    const int x1 = std::min(x0 + kBlock / kCell, cells_.width());
    Sums sums = {};
    for (int row = first_row; row < known_; ++row) {
      for (const Sum p : {kPixels, kSlope2, kResidual2, kNoise2}) {
        const float* cells = cells_.plane(p).row(row);
        for (int x = x0; x < x1; ++x) sums[p] += cells[x];
      }
    }
    if (sums[kPixels] > 0) blocks_[i].slope2 = sums[kSlope2] / sums[kPixels];
    blocks_[i].misfit2 = misfit2_of(sums[kResidual2], sums[kNoise2], sums[kPixels]);
  });
}

void ModelPart::gather(Rect band, const SolvedRows& solved) {
  const int kept = std::min(known_, kKept);
  for (int p = 0; p < kSums; ++p) {
    for (int j = 0; j < kept; ++j) {
      std::copy_n(cells_.plane(p).row(known_ - kept + j), cells_.width(), cells_.plane(p).row(j));
    }
  }
  first_ = band.y0 / kCell - kept;
  known_ = kept + (band.height() + 1) / kCell;
  set_blocks(band);
  parallel_for(static_cast<std::size_t>(known_ - kept), threads_, [&](std::size_t i, int) {
    const int row = kept + static_cast<int>(i), y0 = static_cast<int>(i) * kCell;
    for (int p = 0; p < kSums; ++p) std::fill_n(cells_.plane(p).row(row), cells_.width(), 0.0F);
    for (int y = y0; y < std::min(y0 + kCell, band.height()); ++y) add_row(band.y0 + y, y, solved, row);
  });
  sum_blocks(kept);
}

// Sums over the 3 x 3 cells around one.
ModelPart::Sums ModelPart::around(int cell_x, int row) const {
  Sums sums = {};
  for (int j = std::max(row - 1, 0); j < std::min(row + 2, known_); ++j) {
    for (int p = 0; p < kSums; ++p) {
      const float* cells = cells_.plane(p).row(j);
      for (int i = std::max(cell_x - 1, 0); i < std::min(cell_x + 2, cells_.width()); ++i) {
        sums[static_cast<std::size_t>(p)] += cells[i];
      }
    }
  }
  return sums;
}

float ModelPart::angle_at(int cell_x, int row) const {
  const Sums sums = around(cell_x, row);
  const float pixels = sums[kPixels];
  if (!(pixels > 0)) return 0;
  const Block& block = blocks_[static_cast<std::size_t>(cell_x * kCell / kBlock)];
  const solver::ModelEvidence evidence = {.slope2 = sums[kSlope2] / pixels,
                                          .slope2_around = block.slope2,
                                          .albedo = sums[kAlbedo] / pixels,
                                          .shadowed = sums[kShaded] / pixels,
                                          .misfit2 = misfit2_of(sums[kResidual2], sums[kNoise2], pixels),
                                          .misfit2_around = block.misfit2};
  return solver::model_sigma_deg(evidence, block.degrees_a_residual, traits_);
}

void ModelPart::fill(Rect rows, const std::array<View<const float>, 3>& albedo, View<float> model_normal_deg,
                     const std::array<View<float>, 3>& model_albedo) const {
  parallel_for(static_cast<std::size_t>((rows.height() + 1) / kCell), threads_, [&](std::size_t i, int) {
    const int y0 = static_cast<int>(i) * kCell, row = rows.y0 / kCell + static_cast<int>(i) - first_;
    for (int x0 = 0; x0 < rows.width(); x0 += kCell) {
      const float deg = angle_at(x0 / kCell, row), share = solver::model_albedo_share(deg);
      for (int y = y0; y < std::min(y0 + kCell, rows.height()); ++y) {
        for (int x = x0; x < std::min(x0 + kCell, rows.width()); ++x) {
          model_normal_deg(x, y) = deg;
          for (std::size_t c = 0; c < 3; ++c) model_albedo[c](x, y) = share * albedo[c](x, y);
        }
      }
    }
  });
}

}  // namespace weft::pipeline
