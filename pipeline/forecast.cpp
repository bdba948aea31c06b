// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forecast.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/solve_record.h"
#include "core/vec.h"
#include "pipeline/samples.h"
#include "solver/method.h"
#include "solver/uncertainty/calibration_sigma.h"

namespace weft::pipeline {
namespace {

// Mean over rms of an angle whose two components scatter alike.
const double kMeanOfRms = std::sqrt(kPi) / 2;

// Degrees of error that light from the cloth makes: with a share of it, and with its square, as steep slopes
// see fewer lights to hold against it. Subtracting what a solved relief says of that light leaves the first.
// Fitted to the tuning set's cloths without gloss.
constexpr double kIndirect_deg = 20, kIndirectSquared_deg = 350;

double squared(double v) {
  return v * v;
}

// What remains of `whole` without `part`, of independent parts.
double without(double whole, double part) {
  return std::sqrt(std::max(0.0, squared(whole) - squared(part)));
}

// A mean of squares, and its root.
class Rms {
 public:
  void add(double v) {
    sum_ += v * v;
    ++count_;
  }
  double value() const { return count_ > 0 ? std::sqrt(sum_ / count_) : 0; }

 private:
  double sum_ = 0, count_ = 0;
};

// A mean.
class Mean {
 public:
  void add(double v) {
    sum_ += v;
    ++count_;
  }
  double value() const { return count_ > 0 ? sum_ / count_ : 0; }

 private:
  double sum_ = 0, count_ = 0;
};

Vec3 normal_at(const SampleMaps& maps, int x, int y) {
  return {maps.normal(x, y, 0), maps.normal(x, y, 1), maps.normal(x, y, 2)};
}

bool is_solved(const SampleMaps& maps, int x, int y) {
  return (maps.status(x, y) & kNoSolution) == 0;
}

// Degrees of rms angle for each unit of residual over the albedo, at the middle of a sample.
double degrees_a_residual(const LightField& field, Rect tile) {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0, n = 0;
  for (std::size_t k = 0; k < field.count(); ++k) {
    const LightField::Light light = field.at(k, 1, (tile.x0 + tile.x1) / 2, (tile.y0 + tile.y1) / 2);
    if (!(light.strength > 0)) continue;
    const Vec3 l = light.direction;
    xx += l.x * l.x, xy += l.x * l.y, xz += l.x * l.z;
    yy += l.y * l.y, yz += l.y * l.z, zz += l.z * l.z;
    ++n;
  }
  const double det = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  if (n < 4 || !(det > 0)) return 0;  // three lights fit anything
  const double across = (yy * zz - yz * yz + xx * zz - xz * xz) / det;
  return degrees(std::sqrt(across * n / (n - 3)));
}

// Noise and misfit of a solve.
ErrorForecast scatter_of(const std::vector<SampleMaps>& samples, const LightField& field) {
  Rms sigma, spread;
  for (const SampleMaps& maps : samples) {
    const double scale = degrees_a_residual(field, maps.tile);
    for (int y = 0; y < maps.tile.height(); ++y) {
      for (int x = 0; x < maps.tile.width(); ++x) {
        if (!is_solved(maps, x, y) || !std::isfinite(maps.residual(x, y))) continue;
        sigma.add(static_cast<double>(maps.sigma_normal_deg(x, y)));
        spread.add(scale * static_cast<double>(maps.residual(x, y)));
      }
    }
  }
  ErrorForecast scatter;
  scatter.noise_deg = kMeanOfRms * sigma.value();
  scatter.misfit_deg = kMeanOfRms * without(spread.value(), sigma.value());
  return scatter;
}

// Mean angle between two solves.
double turn_deg(const std::vector<SampleMaps>& a, const std::vector<SampleMaps>& b) {
  Mean turn;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int y = 0; y < a[i].tile.height(); ++y) {
      for (int x = 0; x < a[i].tile.width(); ++x) {
        if (is_solved(a[i], x, y) && is_solved(b[i], x, y))
          turn.add(angle_deg(normal_at(a[i], x, y), normal_at(b[i], x, y)));
      }
    }
  }
  return turn.value();
}

// Gives the four pixels of each cell their mean normal: what half the resolution sees.
void average_cells(std::vector<SampleMaps>& samples) {
  for (SampleMaps& maps : samples) {
    for (int y = 0; y + 1 < maps.tile.height(); y += 2) {
      for (int x = 0; x + 1 < maps.tile.width(); x += 2) {
        for (int c = 0; c < 3; ++c) {
          const float mean = (maps.normal(x, y, c) + maps.normal(x + 1, y, c) + maps.normal(x, y + 1, c) +
                              maps.normal(x + 1, y + 1, c)) /
                             4;
          for (int i = 0; i < 4; ++i) maps.normal(x + i % 2, y + i / 2, c) = mean;
        }
      }
    }
  }
}

Result<double> calibration_deg(const Photographs& photographs, const std::vector<SampleMaps>& samples) {
  if (!photographs.light_covariance) return 0.0;
  const Size size = photographs.size;
  const Result<solver::CalibrationSigmas> sigmas = solver::CalibrationSigmas::make(
      *photographs.field, size, photographs.leds, *photographs.light_covariance, photographs.noise());
  if (!sigmas) return sigmas.error();
  const Planes planes = photographs.planes();
  Rms rms;
  for (const SampleMaps& maps : samples) {
    const int x = maps.tile.width() / 2, y = maps.tile.height() / 2;
    if (!is_solved(maps, x, y)) continue;
    const int px = maps.tile.x0 + x, py = maps.tile.y0 + y;
    const int c = planes.channel_at(planes.speaker(), px, py);
    rms.add(sigmas->at(px, py, c, normal_at(maps, x, y), static_cast<double>(maps.albedo(x, y))).normal_deg);
  }
  return kMeanOfRms * rms.value();
}

}  // namespace

double ErrorForecast::total_deg() const {
  return std::sqrt(squared(noise_deg) + squared(misfit_deg) + squared(indirect_deg) + squared(shortcut_deg) +
                   squared(calibration_deg));
}

Result<Forecast> forecast_errors(const Photographs& photographs, int threads) {
  const auto solve = [&](const std::unique_ptr<solver::Method>& method) {
    return solve_samples(photographs, *method, threads);
  };
  const std::vector<SampleMaps> standard = solve(solver::standard_method());
  const std::vector<SampleMaps> robust = solve(solver::robust_method());
  const Result<solver::Gates> gates = measure_gates(standard, photographs);
  if (!gates) return gates.error();
  const Result<double> calibration = calibration_deg(photographs, standard);
  if (!calibration) return calibration.error();
  const double share = gates->indirect.value;
  const LightField& field = *photographs.field;

  ErrorForecast of_standard = scatter_of(standard, field);
  of_standard.indirect_deg = kIndirect_deg * share + kIndirectSquared_deg * squared(share);
  of_standard.calibration_deg = *calibration;

  ErrorForecast of_fast = of_standard;
  of_fast.level = solver::Level::kFast;
  of_fast.shortcut_deg = turn_deg(solve(solver::fast_method()), standard);

  ErrorForecast of_preview = of_standard;
  of_preview.level = solver::Level::kPreview;
  std::vector<SampleMaps> cells = solve(solver::least_squares_method());
  of_preview.noise_deg = scatter_of(cells, field).noise_deg / 2;  // of four photosites
  average_cells(cells);
  // A photosite's noise is three quarters its own and one quarter its cell's.
  of_preview.shortcut_deg = without(turn_deg(cells, standard), std::sqrt(0.75) * of_standard.noise_deg);

  // What the start that most readings agree on turns was misfit.
  ErrorForecast of_robust = of_standard;
  of_robust.level = solver::Level::kRobust;
  of_robust.misfit_deg = without(of_standard.misfit_deg, turn_deg(robust, standard));

  ErrorForecast of_reference = of_robust;
  of_reference.level = solver::Level::kReference;
  if (gates->interreflection()) of_reference.indirect_deg = kIndirect_deg * share;
  return Forecast{*gates, {of_preview, of_fast, of_standard, of_robust, of_reference}};
}

}  // namespace weft::pipeline
