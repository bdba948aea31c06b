// SPDX-License-Identifier: Apache-2.0
#include "solve/bands/albedo_color.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/base/parallel.h"
#include "core/rig/color_transform.h"

namespace weft::solve {
namespace {

constexpr double kStep = 1e-3;  // of albedo, for the slope of a curve

// d Rec.709 / d camera.
Mat3 slope_at(const ColorTransform& transform, const Rgb& camera) {
  if (!transform.curve) return transform.rec709_from_camera;
  Mat3 slope = {};
  for (std::size_t k = 0; k < 3; ++k) {
    Rgb plus = camera, minus = camera;
    plus[k] += kStep;
    minus[k] -= kStep;
    const Rgb up = rec709_of_camera(transform, plus), down = rec709_of_camera(transform, minus);
    for (std::size_t c = 0; c < 3; ++c) slope[c][k] = (up[c] - down[c]) / (2 * kStep);
  }
  return slope;
}

// Variance of channel c of matrix * camera from the matrix's own.
double variance_of(const std::vector<double>& covariance, std::size_t c, const Rgb& camera) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      sum += camera[i] * camera[j] * covariance[(3 * c + i) * 9 + 3 * c + j];
    }
  }
  return std::max(sum, 0.0);
}

Rgb at(const std::array<View<const float>, 3>& planes, int x, int y) {
  return {static_cast<double>(planes[0](x, y)), static_cast<double>(planes[1](x, y)),
          static_cast<double>(planes[2](x, y))};
}

}  // namespace

AlbedoColor::AlbedoColor(ColorTransform transform, int width, int threads)
    : transform_(std::move(transform)),
      threads_(threads),
      albedo_({width, 0}, 3),
      sigma_({width, 0}, 3),
      model_({width, 0}, 3),
      calibration_({width, 0}, 3) {}

MapBand AlbedoColor::of(const MapBand& camera, std::vector<View<const float>>& calibration) {
  const Size size = {albedo_.width(), camera.albedo_rows.height()};
  if (albedo_.height() < size.height) {
    for (Image<float>* image : {&albedo_, &sigma_, &model_, &calibration_}) *image = Image<float>(size, 3);
  }
  const bool of_lights = !calibration.empty(), is_known = has_covariance(),
             has_model = camera.model_albedo[0].height() > 0;
  parallel_for(static_cast<std::size_t>(size.height), threads_, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size.width; ++x) {
      const Rgb from = at(camera.albedo, x, y), sigma = at(camera.sigma_albedo, x, y);
      const Rgb to = rec709_of_camera(transform_, from);
      const Mat3 slope = slope_at(transform_, from);
      for (std::size_t c = 0; c < 3; ++c) {
        const int plane = static_cast<int>(c);
        albedo_(x, y, plane) = static_cast<float>(to[c]);
        sigma_(x, y, plane) = static_cast<float>(
            std::hypot(slope[c][0] * sigma[0], slope[c][1] * sigma[1], slope[c][2] * sigma[2]));
        const auto together = [&](std::span<const View<const float>> channels) {
          double sum = 0;
          for (std::size_t k = 0; k < 3; ++k) sum += slope[c][k] * static_cast<double>(channels[k](x, y));
          return sum;
        };
        if (has_model) model_(x, y, plane) = static_cast<float>(std::abs(together(camera.model_albedo)));
        const double of_light = of_lights ? together(calibration) : 0;
        const double own = is_known ? variance_of(transform_.covariance, c, from) : 0;
        calibration_(x, y, plane) = static_cast<float>(std::sqrt(of_light * of_light + own));
      }
    }
  });
  MapBand band = camera;
  const Rect rows = {0, 0, size.width, size.height};
  if (!of_lights && is_known) calibration.resize(3);
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    band.albedo[channel] = albedo_.plane(c).crop(rows);
    band.sigma_albedo[channel] = sigma_.plane(c).crop(rows);
    if (has_model) band.model_albedo[channel] = model_.plane(c).crop(rows);
    if (!calibration.empty()) calibration[channel] = calibration_.plane(c).crop(rows);
  }
  return band;
}

}  // namespace weft::solve
