// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/light_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/statistics.h"
#include "core/rig/light_field.h"

namespace weft::capture {
namespace {

constexpr int kRounds = 3;
constexpr std::size_t kLeastFrames = 4;  // a patch has three unknowns
constexpr double kStill = 0.02;          // residual over the mean below which a reading has its full weight
constexpr double kLittle = 0.05;  // of the mean: a prediction below says nothing of a frame's brightness
constexpr double kFarthest = 1;   // residual over the mean that counts: highlights have no limit
constexpr double kRidge = 1e-6;   // of the trace: directions in one plane leave a component open

/// x of a x = r for a symmetric positive matrix, by Cramer's rule.
Vec3 solved(const std::array<Vec3, 3>& a, Vec3 r) {
  const Vec3 u = cross(a[1], a[2]), v = cross(a[2], a[0]), w = cross(a[0], a[1]);
  return (1 / dot(a[0], u)) * (r.x * u + r.y * v + r.z * w);
}

/// Readings of one patch, those that are full left out.
struct Patch {
  std::vector<std::size_t> frames;
  std::vector<double> reading;
  std::vector<Vec3> incident;
  double mean = 0;

  bool is_fittable() const { return frames.size() >= kLeastFrames && mean > 0; }

  /// Albedo times normal by iterated weights towards least absolute deviations.
  Vec3 fitted(const std::vector<double>& gain) const {
    Vec3 b;
    for (int round = 0; round < kRounds; ++round) {
      std::array<Vec3, 3> a = {};
      Vec3 r;
      for (std::size_t i = 0; i < frames.size(); ++i) {
        const Vec3 s = gain[frames[i]] * incident[i];
        const double off = round == 0 ? 0 : std::abs(reading[i] - dot(s, b)) / mean;
        const double weight = 1 / (off + kStill);
        a[0] = a[0] + weight * s.x * s;
        a[1] = a[1] + weight * s.y * s;
        a[2] = a[2] + weight * s.z * s;
        r = r + weight * reading[i] * s;
      }
      const double ridge = kRidge * (a[0].x + a[1].y + a[2].z);
      a[0].x += ridge;
      a[1].y += ridge;
      a[2].z += ridge;
      b = solved(a, r);
    }
    return b;
  }
};

Patch patch_of(std::size_t i, const std::vector<const std::vector<double>*>& light,
               const std::vector<const std::vector<Vec3>*>& incident) {
  Patch patch;
  for (std::size_t f = 0; f < light.size(); ++f) {
    const double reading = (*light[f])[i];
    if (!std::isfinite(reading)) continue;
    patch.frames.push_back(f);
    patch.reading.push_back(reading);
    patch.incident.push_back((*incident[f])[i]);
    patch.mean += reading;
  }
  if (!patch.frames.empty()) patch.mean /= static_cast<double>(patch.frames.size());
  return patch;
}

}  // namespace

Result<PatchLights> PatchLights::make(const Calibration& calibration, double cloth_height_mm,
                                      const ClothPose& pose) {
  const Size size = calibration.camera->size;
  const auto field =
      LightField::make(seen_from(pose, cloth_height_mm, *calibration.lights),
                       seen_from(pose, cloth_height_mm, *calibration.camera), size, cloth_height_mm);
  if (!field) return field.error();
  PatchLights model = {PatchGrid::over(size), {}, {}, 0, {}};
  if (calibration.response) model.scale.linearity = calibration.response->linearity;

  const auto light_at = [&](std::size_t k, int c, int i) {
    const Rect patch = model.grid.patch(i);
    const int x = std::min((patch.x0 + patch.x1) / 2, size.width - 1);
    const int y = std::min((patch.y0 + patch.y1) / 2, size.height - 1);
    return field->at(k, c, x, y);
  };
  std::array<double, 3> mean_rgb = {};
  const double count = static_cast<double>(field->count()) * model.grid.count();
  for (std::size_t k = 0; k < field->count(); ++k)
    for (int i = 0; i < model.grid.count(); ++i)
      for (std::size_t c = 0; c < 3; ++c) mean_rgb[c] += light_at(k, static_cast<int>(c), i).strength / count;
  model.reading = *std::max_element(mean_rgb.begin(), mean_rgb.end());
  for (std::size_t c = 0; c < 3; ++c) model.scale.weight_rgb[c] = mean_rgb[1] / mean_rgb[c];

  for (std::size_t k = 0; k < field->count(); ++k) {
    auto& led = model.leds.emplace_back();
    for (int i = 0; i < model.grid.count(); ++i) {
      double strength = 0;
      for (std::size_t c = 0; c < 3; ++c)
        strength += model.scale.weight_rgb[c] * light_at(k, static_cast<int>(c), i).strength / 3;
      led.push_back(strength / mean_rgb[1] * light_at(k, 1, i).direction);
    }
  }
  model.room.assign(static_cast<std::size_t>(model.grid.count()), Vec3{0, 0, 1});
  return model;
}

PatchFit fit_light(const std::vector<const std::vector<double>*>& light,
                   const std::vector<const std::vector<Vec3>*>& incident, std::size_t step) {
  const std::size_t frames = light.size();
  std::vector<Patch> patches;
  for (std::size_t i = 0; i < light.front()->size(); i += step) {
    Patch patch = patch_of(i, light, incident);
    if (patch.is_fittable()) patches.push_back(std::move(patch));
  }
  PatchFit fit = {0, std::vector<double>(frames, 1)};
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::vector<double>> ratios(frames);
    double sum = 0;
    for (const Patch& patch : patches) {
      const Vec3 b = patch.fitted(fit.gain);
      double off = 0;
      for (std::size_t i = 0; i < patch.frames.size(); ++i) {
        const std::size_t f = patch.frames[i];
        const double predicted = std::max(0.0, fit.gain[f] * dot(patch.incident[i], b));
        off += std::min(std::abs(patch.reading[i] - predicted) / patch.mean, kFarthest);
        if (predicted > kLittle * patch.mean) ratios[f].push_back(patch.reading[i] / predicted);
      }
      sum += off / static_cast<double>(patch.frames.size());
    }
    fit.misfit = patches.empty() ? 0 : sum / static_cast<double>(patches.size());
    double log_sum = 0;
    for (std::size_t f = 0; f < frames; ++f) {
      if (!ratios[f].empty()) fit.gain[f] *= std::max(median(std::move(ratios[f])), 1e-3);
      log_sum += std::log(fit.gain[f]);
    }
    for (double& gain : fit.gain) gain *= std::exp(-log_sum / static_cast<double>(frames));
  }
  return fit;
}

std::vector<double> expected_light(const std::vector<const std::vector<double>*>& light,
                                   const std::vector<const std::vector<Vec3>*>& incident,
                                   const std::vector<Vec3>& of) {
  const std::vector<double> even(light.size(), 1);
  std::vector<double> expected(of.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < of.size(); ++i) {
    if (light.size() < kLeastFrames) break;
    const Patch patch = patch_of(i, light, incident);
    if (patch.is_fittable()) expected[i] = std::max(0.0, dot(of[i], patch.fitted(even)));
  }
  return expected;
}

}  // namespace weft::capture
