// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "simulator/effects/effects.h"

namespace weft::simulator {
namespace {

/// One damage, in pixels.
struct Part {
  DamageSettings settings;
  Rect rect;
};

std::vector<Part> parts_of(const Scene& scene) {
  const auto pixel = [](double share, int pixels) { return static_cast<int>(std::lround(share * pixels)); };
  std::vector<Part> parts;
  for (const DamageSettings& d : scene.damage) {
    const CameraSettings& c = scene.camera;
    parts.push_back({d,
                     {pixel(d.left, c.width), pixel(d.top, c.height), pixel(d.right, c.width),
                      pixel(d.bottom, c.height)}});
  }
  return parts;
}

double damaged(const Part& part, int y, double sample) {
  switch (part.settings.kind) {
    case DamageKind::kMissing:
      return std::numeric_limits<double>::quiet_NaN();
    case DamageKind::kSaturated:
      return std::numeric_limits<double>::infinity();
    case DamageKind::kBlack:
      return 0;
    case DamageKind::kFade:
      break;
  }
  const double depth = static_cast<double>(y - part.rect.y0) / std::max(part.rect.height() - 1, 1);
  return sample * std::pow(10, -part.settings.decades * depth);
}

Rect common(Rect a, Rect b) {
  const Rect both = {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
  return both.x0 < both.x1 && both.y0 < both.y1 ? both : Rect{};
}

}  // namespace

Pass damage_pass(const Scene& scene) {
  return {"damage", "makes parts of frames missing, saturated, black or fade", PassStage::kShot,
          [parts = parts_of(scene)](PassTile& tile) {
            const auto channels = tile.samples.size() / static_cast<std::size_t>(std::max<std::int64_t>(
                                                            tile.sample_rect.pixels(), 1));
            for (const Part& part : parts) {
              if (tile.led < part.settings.first_led || tile.led > part.settings.last_led) continue;
              for_each_pixel(common(part.rect, tile.sample_rect), [&](std::size_t, int x, int y) {
                double* sample = &tile.samples[channels * index_in(tile.sample_rect, x, y)];
                for (std::size_t c = 0; c < channels; ++c) sample[c] = damaged(part, y, sample[c]);
              });
            }
          }};
}

}  // namespace weft::simulator
