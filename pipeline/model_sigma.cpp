// SPDX-License-Identifier: Apache-2.0
#include "pipeline/model_sigma.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/solve_record.h"
#include "solver/kernels/demosaic.h"
#include "solver/method.h"

namespace weft::pipeline {
namespace {

constexpr int kCell = 2;
// Rows of cells kept from the band before: those of the pixels that waited for demosaicing, and one above.
constexpr int kKept = (solver::kDemosaicReach + kCell - 1) / kCell + 1;
// Columns of a block. Over so many the lights change by a percent.
constexpr int kBlock = 64;
// A slope of 56 degrees, a residual of three times the albedo, and the least that is divided by.
constexpr float kMostSlope2 = 2.25F, kMostResidual = 3, kLeastAlbedo = 1e-3F;

// Length of the step from normal a to normal b, negative if component `axis` falls.
float step_of(const std::array<float, 3>& a, const std::array<float, 3>& b, std::size_t axis) {
  const float x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
  return std::copysign(std::sqrt(x * x + y * y + z * z), b[axis] - a[axis]);
}

// Of three normals in a row, in the direction in which `axis` grows. Beyond the edge it goes on as before.
float within_of(const std::array<float, 3>* before, const std::array<float, 3>& here,
                const std::array<float, 3>* after, std::size_t axis) {
  if (before == nullptr && after == nullptr) return 0;
  const float to = before != nullptr ? step_of(*before, here, axis) : step_of(here, *after, axis);
  return solver::within_pixel2(to, after != nullptr ? step_of(here, *after, axis) : to);
}

}  // namespace

ModelPart::ModelPart(const Photographs& photographs, int band_rows, const solver::ModelTraits& traits,
                     int threads)
    : photographs_(photographs),
      planes_(photographs.planes()),
      has_noise_(photographs.noise().has_value()),
      traits_(traits),
      threads_(threads),
      cells_({(photographs.size.width + kCell - 1) / kCell, kKept + band_rows / kCell}, kSums) {
  if (traits.is_half) within2_deg2_ = Image<float>({photographs.size.width, band_rows});
}

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

// What the pixel that speaks for a cell shows. It is another corner in each of four neighbouring cells, so
// that they have all filters between them.
ModelPart::Sums ModelPart::seen_at(int cell_x, int cell_y, int frame_y0, const SolvedRows& solved) const {
  const int x = std::min(cell_x * kCell + cell_y % kCell, solved.status.width() - 1),
            y = std::min(cell_y * kCell + cell_x % kCell, solved.status.height() - 1);
  const std::uint16_t status = solved.status(x, y);
  if (status & kNoSolution) return {};
  const float nz = solved.normal[2](x, y), z2 = nz * nz, residual = solved.residual(x, y);
  const float albedo = std::max(solved.albedo(x, y), kLeastAlbedo);
  const float q = residual < kMostResidual ? residual : kMostResidual;
  Sums seen = {};
  seen[kPixels] = 1;
  seen[kSlope2] = 1 - z2 < kMostSlope2 * z2 ? (1 - z2) / z2 : kMostSlope2;
  seen[kAlbedo] = albedo;
  seen[kShaded] = (status & kShadowed) != 0 ? 1.0F : 0.0F;
  if (!has_noise_) return seen;
  const auto c = static_cast<std::size_t>(planes_.channel_at(planes_.speaker(), x, frame_y0 + y));
  const Block& block = blocks_[static_cast<std::size_t>(x / kBlock)];
  seen[kMisfit2] = q * q - block.noise[c](solved.normal[0](x, y), solved.normal[1](x, y), nz, albedo);
  return seen;
}

// Of all cells from `first_row` on.
void ModelPart::sum_blocks(int first_row) {
  parallel_for(blocks_.size(), threads_, [&](std::size_t i, int) {
    const int x0 = static_cast<int>(i) * kBlock / kCell;
    const int x1 = std::min(x0 + kBlock / kCell, cells_.width());
    Sums sums = {};
    for (int row = first_row; row < known_; ++row) {
      for (const Sum p : {kPixels, kSlope2, kMisfit2}) {
        const float* cells = cells_.plane(p).row(row);
        for (int x = x0; x < x1; ++x) sums[p] += cells[x];
      }
    }
    if (!(sums[kPixels] > 0)) return;
    blocks_[i].slope2 = sums[kSlope2] / sums[kPixels];
    blocks_[i].misfit2 = std::max(sums[kMisfit2], 0.0F) / sums[kPixels];
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
      within2_deg2_(x, y) = static_cast<float>(degrees(1) * degrees(1)) * within2;
    }
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
  known_ = kept + (band.height() + kCell - 1) / kCell;
  set_blocks(band);
  parallel_for(static_cast<std::size_t>(known_ - kept), threads_, [&](std::size_t i, int) {
    const int cell_y = static_cast<int>(i), row = kept + cell_y;
    for (int cell_x = 0; cell_x < cells_.width(); ++cell_x) {
      const Sums seen = seen_at(cell_x, cell_y, band.y0, solved);
      for (std::size_t p = 0; p < kSums; ++p) cells_(cell_x, row, static_cast<int>(p)) = seen[p];
    }
  });
  sum_blocks(kept);
  if (traits_.is_half) see_within(solved);
}

void ModelPart::angles_at(int row, std::vector<float>& angles) const {
  const std::size_t width = angles.size(), stride = width + 2;
  std::vector<float> columns(kSums * stride);  // sums of three rows, with none beyond both ends
  for (std::size_t p = 0; p < kSums; ++p) {
    float* sums = columns.data() + p * stride + 1;
    for (int j = std::max(row - 1, 0); j < std::min(row + 2, known_); ++j) {
      const float* cells = cells_.plane(static_cast<int>(p)).row(j);
      for (std::size_t x = 0; x < width; ++x) sums[x] += cells[x];
    }
  }
  for (std::size_t x = 0; x < width; ++x) {
    Sums around;
    for (std::size_t p = 0; p < kSums; ++p) {
      const float* sums = columns.data() + p * stride + x;
      around[p] = sums[0] + sums[1] + sums[2];
    }
    angles[x] = around[kPixels] > 0 ? angle_of(around, blocks_[x * kCell / kBlock]) : 0;
  }
}

float ModelPart::angle_of(const Sums& around, const Block& block) const {
  const float share = 1 / around[kPixels];
  return solver::model_sigma_deg({.slope2 = around[kSlope2] * share,
                                  .slope2_around = block.slope2,
                                  .albedo = around[kAlbedo] * share,
                                  .shadowed = around[kShaded] * share,
                                  .misfit2 = std::max(around[kMisfit2], 0.0F) * share,
                                  .misfit2_around = block.misfit2},
                                 block.degrees_a_residual, traits_);
}

void ModelPart::fill(Rect rows, const std::array<View<const float>, 3>& albedo, View<float> model_normal_deg,
                     const std::array<View<float>, 3>& model_albedo) const {
  if (rows.height() == 0) return;
  const int first = rows.y0 / kCell, last = (rows.y1 - 1) / kCell;
  parallel_for(static_cast<std::size_t>(last - first + 1), threads_, [&](std::size_t i, int) {
    const int cell_y = first + static_cast<int>(i);
    const int y0 = std::max(cell_y * kCell, rows.y0) - rows.y0,
              y1 = std::min((cell_y + 1) * kCell, rows.y1) - rows.y0;
    std::vector<float> angles(static_cast<std::size_t>(cells_.width()));
    angles_at(cell_y - first_, angles);
    for (int y = y0; y < y1; ++y) {
      float* angle = model_normal_deg.row(y);
      for (int x = 0; x < rows.width(); ++x) angle[x] = angles[static_cast<std::size_t>(x / kCell)];
      if (traits_.is_half) {
        const float* within2 = within2_deg2_.plane().row(y);
        for (int x = 0; x < rows.width(); ++x) {
          angle[x] = std::min(std::sqrt(angle[x] * angle[x] + within2[x]), solver::kUnknownAngleDeg);
        }
      }
      for (std::size_t c = 0; c < 3; ++c) {
        const float* of = albedo[c].row(y);
        float* share = model_albedo[c].row(y);
        for (int x = 0; x < rows.width(); ++x) share[x] = solver::model_albedo_share(angle[x]) * of[x];
      }
    }
  });
}

}  // namespace weft::pipeline
