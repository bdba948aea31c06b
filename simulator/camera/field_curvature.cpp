// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/field_curvature.h"

#include <algorithm>
#include <cmath>

namespace weft::simulator {
namespace {

constexpr double kStepsAPixel = 32;

BlurKernel disc_of(int step) {
  return blur_kernel({.defocus_px = step / kStepsAPixel});
}

int last_step(const FieldSettings& settings) {
  return static_cast<int>(std::ceil(kStepsAPixel * settings.corner_px)) + 1;
}

/// Adds `share` of what a disc gathers around a pixel.
void add_gathered(const BlurKernel& disc, double share, const Rgb* centre, std::ptrdiff_t row, Rgb& sum) {
  const double* weight = disc.weights.data();
  for (int y = -disc.radius; y <= disc.radius; ++y) {
    const Rgb* from = centre + y * row - disc.radius;
    for (int x = -disc.radius; x <= disc.radius; ++x, ++from, ++weight) {
      for (std::size_t c = 0; c < 3; ++c) sum[c] += share * *weight * (*from)[c];
    }
  }
}

}  // namespace

BlurKernel widest_disc(const FieldSettings& settings) {
  return disc_of(last_step(settings));
}

FieldCurvature::FieldCurvature(const FieldSettings& settings, const CameraModel& camera)
    : cx_(camera.cx),
      cy_(camera.cy),
      corner_px_(corner_distance_px(camera)),
      largest_px_(settings.corner_px) {
  for (int i = 0; i <= last_step(settings); ++i) discs_.push_back(disc_of(i));
}

double FieldCurvature::diameter_px(double x, double y) const {
  const double radius = std::hypot(x - cx_, y - cy_) / corner_px_;
  return largest_px_ * std::min(radius * radius, 1.0);
}

void FieldCurvature::blur(std::span<const Rgb> in, Rect in_rect, Rect out_rect, std::span<Rgb> out) const {
  const std::ptrdiff_t row = in_rect.width();
  auto to = out.begin();
  for (int y = out_rect.y0; y < out_rect.y1; ++y) {
    const Rgb* centre = in.data() + (y - in_rect.y0) * row + (out_rect.x0 - in_rect.x0);
    for (int x = out_rect.x0; x < out_rect.x1; ++x, ++centre, ++to) {
      const double step = kStepsAPixel * diameter_px(x, y), share = step - std::floor(step);
      const auto i = static_cast<std::size_t>(step);
      *to = {};
      add_gathered(discs_[i], 1 - share, centre, row, *to);
      add_gathered(discs_[i + 1], share, centre, row, *to);
    }
  }
}

}  // namespace weft::simulator
