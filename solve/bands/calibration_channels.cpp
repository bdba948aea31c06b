// SPDX-License-Identifier: Apache-2.0
#include "solve/bands/calibration_channels.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/parallel.h"

namespace weft::solve {
namespace {

// 0, 16, 32 ... and the last of `count`.
std::vector<int> places(int count) {
  std::vector<int> at;
  for (int i = 0; i < count - 1; i += kCalibrationSigmaStep) at.push_back(i);
  at.push_back(count - 1);
  return at;
}

}  // namespace

void fill_calibration_sigma(const solver::CalibrationSigmas& sigmas, Rect band,
                            const std::array<View<const float>, 3>& normal, View<const float> albedo,
                            const Planes& planes, int threads, View<float> normal_deg,
                            View<float> relative_albedo) {
  const std::vector<int> columns = places(band.width()), rows = places(band.height());
  std::vector<std::vector<solver::CalibrationSigma>> grid(rows.size());
  parallel_for(rows.size(), threads, [&](std::size_t j, int) {
    const int y = rows[j];
    for (const int x : columns) {
      const Vec3 n = {normal[0](x, y), normal[1](x, y), normal[2](x, y)};
      const int c = planes.channel_at(planes.speaker(), band.x0 + x, band.y0 + y);
      grid[j].push_back(sigmas.at(band.x0 + x, band.y0 + y, c, n, static_cast<double>(albedo(x, y))));
    }
  });
  parallel_for(static_cast<std::size_t>(band.height()), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    const std::size_t j = std::min(row / kCalibrationSigmaStep, rows.size() - 1),
                      below = std::min(j + 1, rows.size() - 1);
    const double t = below == j ? 0 : static_cast<double>(y - rows[j]) / (rows[below] - rows[j]);
    for (int x = 0; x < band.width(); ++x) {
      const std::size_t i = std::min(static_cast<std::size_t>(x) / kCalibrationSigmaStep, columns.size() - 1);
      const std::size_t right = std::min(i + 1, columns.size() - 1);
      const double s = right == i ? 0 : static_cast<double>(x - columns[i]) / (columns[right] - columns[i]);
      const auto blend = [&](double solver::CalibrationSigma::*value) {
        const double above = (1 - s) * grid[j][i].*value + s * grid[j][right].*value;
        return static_cast<float>((1 - t) * above +
                                  t * ((1 - s) * grid[below][i].*value + s * grid[below][right].*value));
      };
      normal_deg(x, y) = blend(&solver::CalibrationSigma::normal_deg);
      relative_albedo(x, y) = blend(&solver::CalibrationSigma::relative_albedo);
    }
  });
}

CalibrationChannels::CalibrationChannels(const Photographs& photographs, solver::CalibrationSigmas sigmas,
                                         int threads)
    : width_(photographs.size.width),
      planes_(photographs.planes()),
      sigmas_(std::move(sigmas)),
      threads_(threads) {}

Result<CalibrationChannels> CalibrationChannels::make(const Photographs& photographs, int threads) {
  Result<solver::CalibrationSigmas> sigmas =
      solver::CalibrationSigmas::make(*photographs.field, photographs.size, photographs.leds,
                                      *photographs.light_covariance, photographs.noise());
  if (!sigmas) return std::move(sigmas).error();
  return CalibrationChannels(photographs, std::move(*sigmas), threads);
}

void CalibrationChannels::keep_normals(const MapBand& band) {
  const int needed = rows_ + band.rows.height();
  if (normal_.height() < needed) {
    Image<float> larger({width_, needed}, 3);
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < rows_; ++y) std::copy_n(normal_.plane(c).row(y), width_, larger.plane(c).row(y));
    }
    normal_ = std::move(larger);
  }
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < band.rows.height(); ++y) {
      std::copy_n(band.normal[static_cast<std::size_t>(c)].row(y), width_, normal_.plane(c).row(rows_ + y));
    }
  }
  rows_ = needed;
}

void CalibrationChannels::forget_normals(int rows_left) {
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < rows_left; ++y) {
      std::copy_n(normal_.plane(c).row(rows_ - rows_left + y), width_, normal_.plane(c).row(y));
    }
  }
  rows_ = rows_left;
}

std::array<View<const float>, 4> CalibrationChannels::of(const MapBand& band) {
  keep_normals(band);
  const int height = band.albedo_rows.height();
  if (albedo_.height() < height) {
    albedo_ = Image<float>({width_, height});
    relative_ = Image<float>({width_, height});
    channels_ = Image<float>({width_, height}, 4);
  }
  const Rect rows = {0, 0, width_, height};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width_; ++x) {
      const int c = planes_.channel_at(planes_.speaker(), x, band.albedo_rows.y0 + y);
      albedo_(x, y) = band.albedo[static_cast<std::size_t>(c)](x, y);
    }
  }
  if (height > 0) {
    fill_calibration_sigma(
        sigmas_, band.albedo_rows,
        {normal_.plane(0).crop(rows), normal_.plane(1).crop(rows), normal_.plane(2).crop(rows)},
        albedo_.plane().crop(rows), planes_, threads_, channels_.plane(3).crop(rows),
        relative_.plane().crop(rows));
  }
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width_; ++x) {
        channels_(x, y, c) = relative_(x, y) * band.albedo[static_cast<std::size_t>(c)](x, y);
      }
    }
  }
  forget_normals(band.rows.y1 - band.albedo_rows.y1);
  return {channels_.plane(0).crop(rows), channels_.plane(1).crop(rows), channels_.plane(2).crop(rows),
          channels_.plane(3).crop(rows)};
}

}  // namespace weft::solve
