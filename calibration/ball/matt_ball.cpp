// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "calibration/ball/ball_shots.h"
#include "core/base/statistics.h"

namespace weft::calibration {
namespace {

constexpr double kMattRim = 0.93;    // of the radius: beyond it normals turn too fast
constexpr int kMostPixels = 20'000;  // of a ball that are looked at
constexpr double kLitFrom = 0.15;    // cosine to the lamp
constexpr double kTukeyMatt = 4.685;
constexpr double kLeastScale = 2e-4;  // of the brightest
constexpr int kLeastPixels = 60;

struct MattPixel {
  Eigen::Vector4d n;  ///< normal and 1
  float value = 0;
};

std::vector<MattPixel> pixels_of(const Image<float>& shot, const BallView& view) {
  const Circle& c = view.circle();
  const double reach = kMattRim * c.radius;
  const int step = std::max(1, static_cast<int>(std::sqrt(kPi * reach * reach / kMostPixels)));
  std::vector<MattPixel> pixels;
  for (int y = std::max(0, static_cast<int>(c.y - reach)); y <= std::min(shot.height() - 1.0, c.y + reach);
       y += step) {
    for (int x = std::max(0, static_cast<int>(c.x - reach)); x <= std::min(shot.width() - 1.0, c.x + reach);
         x += step) {
      if (std::hypot(x - c.x, y - c.y) > reach) continue;
      const std::optional<BallPoint> p = view.at(x, y);
      if (p) pixels.push_back({{p->normal.x, p->normal.y, p->normal.z, 1}, shot(x, y)});
    }
  }
  return pixels;
}

/// I = g . n + a, its covariance, and how much of the shading it explains.
struct Shading {
  Eigen::Vector4d g = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double explained = 0;
  double clipped_share = 0;
};

double lit_cosine(const Eigen::Vector4d& n, const Eigen::Vector4d& g) {
  return n.head<3>().dot(g.head<3>()) / std::max(g.head<3>().norm(), 1e-12);
}

/// Share of the variance of all pixels that max(0, g . n) + a explains, the worst twentieth left out.
double explained_by(const std::vector<MattPixel>& pixels, const Eigen::Vector4d& g) {
  std::vector<double> squares;
  double mean = 0, variance = 0;
  for (const MattPixel& p : pixels) mean += p.value;
  mean /= static_cast<double>(pixels.size());
  for (const MattPixel& p : pixels) {
    const double said = std::max(0.0, p.n.head<3>().dot(g.head<3>())) + g[3];
    squares.push_back((p.value - said) * (p.value - said));
    variance += (p.value - mean) * (p.value - mean);
  }
  std::ranges::sort(squares);
  double sum = 0;
  for (std::size_t i = 0; i < squares.size() * 19 / 20; ++i) sum += squares[i];
  return variance > 0 ? 1 - sum / variance : 0;
}

std::optional<Shading> shading_of(const std::vector<MattPixel>& pixels) {
  std::vector<float> values;
  for (const MattPixel& p : pixels) values.push_back(p.value);
  if (values.size() < kLeastPixels) return std::nullopt;
  const double bright = quantile(values, 0.98);
  if (!(bright > 0)) return std::nullopt;
  Shading fit;
  double scale = 0.2 * bright;
  for (int i = 0; i < 25; ++i) {
    Eigen::Matrix4d a = Eigen::Matrix4d::Identity() * 1e-9;
    Eigen::Vector4d b = Eigen::Vector4d::Zero();
    std::vector<double> sizes;
    double used = 0;
    for (const MattPixel& p : pixels) {
      if (p.value >= kClippedFrom) continue;
      if (i == 0 ? p.value < 0.3 * bright : lit_cosine(p.n, fit.g) < kLitFrom) continue;
      const double residual = p.value - p.n.dot(fit.g);
      const double t = residual / (kTukeyMatt * scale);
      const double w = i == 0 ? 1 : std::abs(t) < 1 ? (1 - t * t) * (1 - t * t) : 0;
      a += w * p.n * p.n.transpose();
      b += w * p.value * p.n;
      used += w;
      sizes.push_back(std::abs(residual));
    }
    if (used < kLeastPixels / 2.0) return std::nullopt;
    const Eigen::Vector4d before = fit.g;
    fit.g = a.ldlt().solve(b);
    if (i > 0) scale = std::max(1.4826 * median(sizes), kLeastScale * bright);
    fit.covariance = scale * scale * a.inverse();
    if (!fit.g.allFinite() || !(fit.g.head<3>().norm() > 0)) return std::nullopt;
    if (i > 3 && (fit.g - before).norm() < 1e-7 * bright) break;
  }
  fit.explained = explained_by(pixels, fit.g);
  fit.clipped_share = static_cast<double>(std::ranges::count_if(
                          pixels, [](const MattPixel& p) { return p.value >= kClippedFrom; })) /
                      static_cast<double>(pixels.size());
  return fit;
}

}  // namespace

BallReading read_matt_ball(const std::vector<Image<float>>& shots, const BallView& view, double sigma_px) {
  BallReading reading;
  std::vector<double> explained;
  const Circle& c = view.circle();
  for (const Image<float>& shot : shots) {
    LampOnBall& lamp = reading.lamps.emplace_back();
    const std::optional<Shading> shading = shading_of(pixels_of(shot, view));
    explained.push_back(shading ? std::max(0.0, shading->explained) : 0);
    if (!shading || shading->explained < 0.5) continue;
    const Eigen::Vector3d g = shading->g.head<3>();
    lamp.found = true;
    lamp.strength = g.norm();
    lamp.direction = normalized({g[0], g[1], g[2]});
    const double of_noise = std::sqrt(shading->covariance.topLeftCorner<3, 3>().trace()) / g.norm();
    lamp.sigma_deg = degrees(std::hypot(of_noise, sigma_px / c.radius));
    lamp.strength_sigma = of_noise * g.norm();
    lamp.clipped = shading->clipped_share > 0.3;
    // Brightest where the normal points to the lamp, or at the rim nearest to it.
    const double across = std::hypot(lamp.direction.x, lamp.direction.y);
    const double out = lamp.direction.z > 0 ? 1 : 1 / std::max(across, 1e-9);
    lamp.x = c.x + c.radius * lamp.direction.x * out;
    lamp.y = c.y - c.radius * lamp.direction.y * out;
  }
  reading.quality = median(explained);
  return reading;
}

}  // namespace weft::calibration
