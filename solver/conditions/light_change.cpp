// SPDX-License-Identifier: Apache-2.0
#include "solver/conditions/light_change.h"

#include <algorithm>
#include <cmath>

namespace weft::solver {
namespace {

// Whether a point is inside a polygon, by the crossings of a ray to the right.
bool is_inside(const std::vector<std::array<double, 2>>& polygon, double x, double y) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const auto [x0, y0] = polygon[i];
    const auto [x1, y1] = polygon[j];
    if ((y0 > y) != (y1 > y) && x < x0 + (x1 - x0) * (y - y0) / (y1 - y0)) inside = !inside;
  }
  return inside;
}

}  // namespace

double PatchLight::factor() const {
  return (reading_rgb[0] + reading_rgb[1] + reading_rgb[2]) /
         (predicted_rgb[0] + predicted_rgb[1] + predicted_rgb[2]);
}

WhitePatch well_inside(WhitePatch patch) {
  constexpr double kInside = 0.8;
  double x0 = 0, y0 = 0;
  const auto corners = static_cast<double>(patch.polygon_px.size());
  for (const auto& [x, y] : patch.polygon_px) x0 += x / corners, y0 += y / corners;
  for (auto& [x, y] : patch.polygon_px) x = x0 + kInside * (x - x0), y = y0 + kInside * (y - y0);
  return patch;
}

BlockChange block_light(std::span<const View<const float>> earlier,
                        std::span<const View<const float>> later) {
  BlockChange light;
  for (std::size_t p = 0; p < earlier.size(); ++p) {
    for (int y = 0; y < earlier[p].height(); ++y) {
      for (int x = 0; x < earlier[p].width(); ++x) {
        const float a = earlier[p](x, y), b = later[p](x, y);
        if (!std::isfinite(a) || !std::isfinite(b)) continue;
        light.earlier += static_cast<double>(a);
        light.later += static_cast<double>(b);
      }
    }
  }
  return light;
}

std::optional<double> light_ratio(std::vector<BlockChange> blocks) {
  std::erase_if(blocks, [](const BlockChange& b) { return b.earlier <= 0 || b.later <= 0; });
  if (blocks.empty()) return {};
  std::stable_sort(blocks.begin(), blocks.end(), [](const BlockChange& a, const BlockChange& b) {
    return a.later * b.earlier < b.later * a.earlier;
  });
  const std::size_t left_out = blocks.size() / 4;
  BlockChange sum;
  for (std::size_t i = left_out; i < blocks.size() - left_out; ++i) {
    sum.earlier += blocks[i].earlier;
    sum.later += blocks[i].later;
  }
  return sum.later / sum.earlier;
}

double drift_rate(std::span<const LightRepeat> repeats) {
  double changes = 0, squares = 0;
  for (const LightRepeat& r : repeats) {
    const double time = r.later_time - r.earlier_time;
    changes += (r.ratio - 1) * time;
    squares += time * time;
  }
  return squares > 0 ? changes / squares : 0;
}

Rect area_of(const WhitePatch& patch, Size frame) {
  double left = frame.width, top = frame.height, right = -1, bottom = -1;
  for (const auto& [x, y] : patch.polygon_px) {
    left = std::min(left, x), right = std::max(right, x);
    top = std::min(top, y), bottom = std::max(bottom, y);
  }
  const auto within = [](double v, int size) { return static_cast<int>(std::clamp<double>(v, 0, size)); };
  const Rect area = {within(left, frame.width) & ~1, within(top, frame.height) & ~1,
                     within(std::floor(right) + 1, frame.width),
                     within(std::floor(bottom) + 1, frame.height)};
  return area.width() > 0 && area.height() > 0 ? area : Rect();
}

PatchLight patch_light(const WhitePatch& patch, const LightField& field, std::size_t k, Rect area,
                       std::span<const View<const float>> readings, const CfaPattern& cfa) {
  PatchLight light;
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      if (!is_inside(patch.polygon_px, x, y)) continue;
      for (std::size_t p = 0; p < readings.size(); ++p) {
        const float reading = readings[p](x - area.x0, y - area.y0);
        if (!std::isfinite(reading)) {
          ++light.unusable;
          continue;
        }
        const int c = readings.size() == 1 ? cfa.channel_at(x, y) : static_cast<int>(p);
        const auto channel = static_cast<std::size_t>(c);
        const LightField::Light l = field.at(k, c, x, y);
        const double cosine = std::max(l.direction.z, 0.0);
        light.reading_rgb[channel] += static_cast<double>(reading);
        light.predicted_rgb[channel] +=
            patch.reflectance_rgb[channel] * l.strength * cosine * (1 - patch.delta * (1 - cosine));
        ++light.used;
      }
    }
  }
  return light;
}

}  // namespace weft::solver
