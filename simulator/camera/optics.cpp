// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/optics.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "core/base/vec.h"

namespace weft::simulator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr int kSamplesPerCoefficient = 8;
constexpr int kErrorSamples = 257;
constexpr double kGaussianCut = 4;
constexpr std::size_t kBlock = 8;

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

/// The basis functions of one side at the middles of `samples` equal intervals of [-1, 1].
MatrixXd basis(int coefficients, int samples) {
  MatrixXd values(samples, coefficients);
  for (int i = 0; i < coefficients; ++i) {
    GainSpline one{coefficients, 4, std::vector<double>(4 * index(coefficients))};
    for (int row = 0; row < 4; ++row) one.coefficients[index(row * coefficients + i)] = 1;
    for (int s = 0; s < samples; ++s) values(s, i) = one.at((2 * s + 1.0) / samples - 1, 0);
  }
  return values;
}

/// Area that a disc around the origin shares with the rectangle from the origin to (x, y), signed as x y.
double disc_in_corner(double radius, double x, double y) {
  const double w = std::min(std::abs(x), radius), h = std::min(std::abs(y), radius);
  const auto under_arc = [radius](double t) {
    return (t * std::sqrt(std::max(radius * radius - t * t, 0.0)) +
            radius * radius * std::asin(std::min(t / radius, 1.0))) /
           2;
  };
  const double full = std::min(w, std::sqrt(std::max(radius * radius - h * h, 0.0)));
  const double area = full * h + under_arc(w) - under_arc(full);
  return std::copysign(area, x) * std::copysign(1.0, y);
}

/// Share of each pixel in a disc of even light around the middle of pixel (0, 0).
BlurKernel disc(double radius_px) {
  BlurKernel kernel;
  if (radius_px <= 0) return kernel;
  kernel.radius = static_cast<int>(std::ceil(radius_px - 0.5));
  kernel.weights.clear();
  for (int y = -kernel.radius; y <= kernel.radius; ++y)
    for (int x = -kernel.radius; x <= kernel.radius; ++x) {
      const double right = std::abs(x) + 0.5, left = right - 1;  // mirrored, so that the kernel is
      const double bottom = std::abs(y) + 0.5, top = bottom - 1;
      const double area = disc_in_corner(radius_px, right, bottom) - disc_in_corner(radius_px, left, bottom) -
                          disc_in_corner(radius_px, right, top) + disc_in_corner(radius_px, left, top);
      kernel.weights.push_back(std::max(area, 0.0) / (kPi * radius_px * radius_px));
    }
  return kernel;
}

BlurKernel gaussian(double sigma_px) {
  BlurKernel kernel;
  if (sigma_px <= 0) return kernel;
  kernel.radius = static_cast<int>(std::ceil(kGaussianCut * sigma_px));
  std::vector<double> profile;
  for (int i = -kernel.radius; i <= kernel.radius; ++i) {
    const double inner = std::abs(i) - 0.5, scale = std::sqrt(0.5) / sigma_px;
    profile.push_back((std::erf((inner + 1) * scale) - std::erf(inner * scale)) / 2);
  }
  kernel.weights.clear();
  for (const double row : profile)
    for (const double column : profile) kernel.weights.push_back(row * column);
  return kernel;
}

/// Adds share * (a * b) to a kernel that is at least as wide.
void add_joined(BlurKernel& sum, double share, const BlurKernel& a, const BlurKernel& b) {
  const auto at = [](const BlurKernel& k, int x, int y) {
    return index((y + k.radius) * (2 * k.radius + 1) + x + k.radius);
  };
  for (int ya = -a.radius; ya <= a.radius; ++ya)
    for (int xa = -a.radius; xa <= a.radius; ++xa)
      for (int yb = -b.radius; yb <= b.radius; ++yb)
        for (int xb = -b.radius; xb <= b.radius; ++xb)
          sum.weights[at(sum, xa + xb, ya + yb)] +=
              share * a.weights[at(a, xa, ya)] * b.weights[at(b, xb, yb)];
}

/// Makes what the order of summation left unlike alike, and the sum 1.
void settle(BlurKernel& kernel) {
  const int side = 2 * kernel.radius + 1, last = side - 1;
  std::vector<double> even(kernel.weights.size());
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const int near_x = std::min(x, last - x), near_y = std::min(y, last - y);
      even[index(y * side + x)] =
          kernel.weights[index(std::min(near_x, near_y) * side + std::max(near_x, near_y))];
    }
  const double sum = std::accumulate(even.begin(), even.end(), 0.0);
  for (double& weight : even) weight /= sum;
  kernel.weights = std::move(even);
}

}  // namespace

double corner_distance_px(const CameraModel& camera) {
  const double far_x = std::max(camera.cx, camera.size.width - 1 - camera.cx);
  const double far_y = std::max(camera.cy, camera.size.height - 1 - camera.cy);
  return std::max(std::hypot(far_x, far_y), 1.0);
}

Vignette::Vignette(const VignetteSettings& settings, const CameraModel& camera)
    : cx_(camera.cx),
      cy_(camera.cy),
      per_fx_(1 / camera.fx),
      per_fy_(1 / camera.fy),
      half_power_(settings.cosine_power / 2) {
  const double corner_px = corner_distance_px(camera);
  loss_per_px2_ = settings.corner_loss / (corner_px * corner_px);
}

double Vignette::gain(double x, double y) const {
  const double dx = x - cx_, dy = y - cy_, px = dx * per_fx_, py = dy * per_fy_;
  const double per_cos2 = 1 + px * px + py * py;
  const double natural = half_power_ == 2   ? 1 / (per_cos2 * per_cos2)
                         : half_power_ == 0 ? 1
                                            : std::pow(per_cos2, -half_power_);
  return natural * std::max(1 - loss_per_px2_ * (dx * dx + dy * dy), 0.01);
}

GainFit fit_gain(const Vignette& vignette, Size size, int columns, int rows) {
  const auto log_gain = [&](double u, double v) {
    return std::log(vignette.gain((u + 1) / 2 * (size.width - 1), (v + 1) / 2 * (size.height - 1)));
  };
  const int across = kSamplesPerCoefficient * columns, down = kSamplesPerCoefficient * rows;
  MatrixXd gains(down, across);
  for (int j = 0; j < down; ++j)
    for (int i = 0; i < across; ++i)
      gains(j, i) = log_gain((2 * i + 1.0) / across - 1, (2 * j + 1.0) / down - 1);
  GainFit fit;
  fit.mean_log_gain = gains.mean();
  gains.array() -= fit.mean_log_gain;

  // The normal equations of a tensor product part into those of its sides.
  const MatrixXd a = basis(columns, across), b = basis(rows, down);
  const MatrixXd half = (b.transpose() * b).ldlt().solve(b.transpose() * gains);
  const MatrixXd c = (a.transpose() * a).ldlt().solve(a.transpose() * half.transpose()).transpose();
  fit.spline = {columns, rows, {}};
  for (Index j = 0; j < rows; ++j)
    for (Index i = 0; i < columns; ++i) fit.spline.coefficients.push_back(c(j, i));

  for (int j = 0; j < kErrorSamples; ++j)
    for (int i = 0; i < kErrorSamples; ++i) {
      const double u = 2.0 * i / (kErrorSamples - 1) - 1, v = 2.0 * j / (kErrorSamples - 1) - 1;
      const double error = fit.mean_log_gain + fit.spline.at(u, v) - log_gain(u, v);
      fit.max_error = std::max(fit.max_error, std::abs(error));
    }
  return fit;
}

BlurKernel blur_kernel(const BlurSettings& settings) {
  const BlurKernel defocus = disc(settings.defocus_px / 2), spread = gaussian(settings.spread_px);
  const double halo_share = settings.halo_share;
  const BlurKernel halo = halo_share > 0 ? disc(settings.halo_radius_px) : BlurKernel{};
  BlurKernel kernel;
  kernel.radius = std::max(defocus.radius + spread.radius, halo.radius);
  kernel.weights.assign(index((2 * kernel.radius + 1) * (2 * kernel.radius + 1)), 0.0);
  add_joined(kernel, 1 - halo_share, defocus, spread);
  if (halo_share > 0) add_joined(kernel, halo_share, halo, BlurKernel{});
  settle(kernel);
  return kernel;
}

double spread_px(const BlurSettings& settings) {
  BlurSettings core = settings;
  core.halo_share = 0;
  const BlurKernel kernel = blur_kernel(core);
  const int side = 2 * kernel.radius + 1;
  double variance = 0;
  for (int i = 0; i < side * side; ++i) {
    const double x = i % side - kernel.radius;
    variance += kernel.weights[index(i)] * x * x;
  }
  return std::sqrt(variance);
}

void convolve(const BlurKernel& kernel, std::span<const double> in, Rect out_rect, int channels,
              std::span<double> out) {
  const int side = 2 * kernel.radius + 1;
  const std::size_t row = index(out_rect.width() * channels);
  const std::size_t in_row = row + index(2 * kernel.radius * channels);
  struct Tap {
    double weight;
    std::size_t offset;
  };
  std::vector<Tap> taps;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      if (const double weight = kernel.weights[index(y * side + x)]; weight > 0)
        taps.push_back({weight, index(y) * in_row + index(x * channels)});

  for (std::size_t y = 0; y < index(out_rect.height()); ++y) {
    const double* from = in.data() + y * in_row;
    double* to = out.data() + y * row;
    std::size_t i = 0;
    for (; i + kBlock <= row; i += kBlock) {
      std::array<double, kBlock> sums = {};
      for (const Tap& tap : taps)
        for (std::size_t k = 0; k < kBlock; ++k) sums[k] += tap.weight * from[tap.offset + i + k];
      std::copy(sums.begin(), sums.end(), to + i);
    }
    for (; i < row; ++i) {
      double sum = 0;
      for (const Tap& tap : taps) sum += tap.weight * from[tap.offset + i];
      to[i] = sum;
    }
  }
}

}  // namespace weft::simulator
