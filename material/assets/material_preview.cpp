// SPDX-License-Identifier: Apache-2.0
#include "material/assets/material_preview.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/parallel.h"
#include "material/filtering/boxes.h"
#include "material/layers/fit.h"
#include "report/preview.h"

namespace weft::app {
namespace {

using material::ParameterField;

struct Lamp {
  Vec3 to_light;
  double strength = 1;
};

// A key light, a rim light and a sky that is brighter above.
std::vector<Lamp> lamps() {
  std::vector<Lamp> all = {{normalized({-0.55, 0.65, 0.65}), 0.75}, {normalized({0.8, 0.35, -0.55}), 0.5}};
  constexpr int kSky = 12;
  for (int i = 0; i < kSky; ++i) {
    // Equal areas of the sphere along a golden spiral.
    const double y = 1 - 2 * (i + 0.5) / kSky, turn = 2.39996322972865332 * i, r = std::sqrt(1 - y * y);
    all.push_back({{r * std::cos(turn), y, r * std::sin(turn)}, 0.075 * (1 + 0.8 * y)});
  }
  return all;
}

// Albedo, normals and lobe on one grid, whose pixels are about those of the picture.
class Texture {
 public:
  explicit Texture(const PreviewMaps& maps, int threads) : maps_(maps) {
    const double mm_per_pixel = maps.size_mm ? (*maps.size_mm)[0] / maps.surface.size().width : 0;
    const double of_picture = 2 * kPreviewRadius_mm / kPreviewBall;
    int level = 0;
    while (level < static_cast<int>(maps.levels.size()) &&
           mm_per_pixel * std::pow(2, level + 1) <= of_picture)
      ++level;
    mip_ = level == 0 ? nullptr : &maps.levels[static_cast<std::size_t>(level - 1)];
    size_ = material::size_of_level(maps.surface.size(), level);
    if (mip_ != nullptr) {
      ParameterField albedo = {3, {}, {}};
      albedo.map = Image<float>(maps.surface.size(), 3);
      for (int p = 0; p < 3; ++p) {
        for (int y = 0; y < albedo.map.height(); ++y)
          std::copy_n(maps.surface.albedo.plane(p).row(y), albedo.map.width(), albedo.map.plane(p).row(y));
      }
      small_ = material::fitted(albedo, material::BlendSpace::kLinear, {}, size_, threads);
    }
  }

  // The pixel under a place in mm, to the right and up.
  ShadedPoint point(double u_mm, double v_mm, Vec3& normal) const {
    const std::array<int, 2> at = pixel(u_mm, v_mm);
    const int x = at[0], y = at[1];
    ShadedPoint point = maps_.point;
    for (int c = 0; c < 3; ++c)
      point.albedo[static_cast<std::size_t>(c)] =
          mip_ ? small_.at(x, y, c) : double{maps_.surface.albedo(x, y, c)};
    if (mip_) {
      normal = {double{mip_->normal(x, y, 0)}, double{mip_->normal(x, y, 1)}, double{mip_->normal(x, y, 2)}};
      set_lobe(point, mip_->lobe, x, y);
    } else {
      normal = normalized({-double{maps_.surface.slope(x, y, 0)}, -double{maps_.surface.slope(x, y, 1)}, 1});
      if (!maps_.surface.lobe.empty()) set_lobe(point, maps_.surface.lobe, x, y);
    }
    return point;
  }

 private:
  static void set_lobe(ShadedPoint& point, const Image<float>& lobe, int x, int y) {
    point.alpha = double{lobe(x, y, 0)};
    point.alpha_along = double{lobe(x, y, 1)};
    point.yarn_deg = double{lobe(x, y, 2)};
  }

  std::array<int, 2> pixel(double u_mm, double v_mm) const {
    if (!maps_.size_mm) return {0, 0};
    const auto wrapped = [](double share, int count) {
      return std::clamp(static_cast<int>((share - std::floor(share)) * count), 0, count - 1);
    };
    return {wrapped(u_mm / (*maps_.size_mm)[0], size_.width),
            wrapped(-v_mm / (*maps_.size_mm)[1], size_.height)};
  }

  const PreviewMaps& maps_;
  const material::MipLevel* mip_ = nullptr;
  ParameterField small_;
  Size size_;
};

// The light of a place on the ball's unit sphere.
Rgb seen(const Texture& texture, const std::vector<Lamp>& all, Vec3 out) {
  // East along the parallels, north along the meridians.
  const Vec3 east = normalized({out.z, 0, -out.x}), north = cross(out, east);
  const double longitude = std::atan2(out.x, out.z), latitude = std::asin(std::clamp(out.y, -1.0, 1.0));
  Vec3 normal;
  const ShadedPoint point =
      texture.point(kPreviewRadius_mm * longitude, kPreviewRadius_mm * latitude, normal);
  const auto local = [&](Vec3 d) { return Vec3{dot(d, east), dot(d, north), dot(d, out)}; };
  const Vec3 view = local({0, 0, 1});
  Rgb sum = {};
  for (const Lamp& lamp : all) {
    if (!(dot(out, lamp.to_light) > 0)) continue;
    const Rgb one = shaded(point, normal, local(lamp.to_light), view);
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += lamp.strength * one[c];
  }
  return sum;
}

}  // namespace

report::Picture preview_of(const PreviewMaps& maps, int threads) {
  report::Picture picture = report::blank_picture({kPreviewBall, kPreviewBall});
  const Texture texture(maps, threads);
  const std::vector<Lamp> all = lamps();
  const double radius = 0.47 * kPreviewBall, centre = 0.5 * kPreviewBall;
  parallel_for(static_cast<std::size_t>(kPreviewBall), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < kPreviewBall; ++x) {
      const double u = (x + 0.5 - centre) / radius, v = (centre - y - 0.5) / radius, r = std::hypot(u, v);
      // The rim's pixels are covered in part.
      const double covered = std::clamp((1 - r) * radius + 0.5, 0.0, 1.0);
      if (covered == 0) continue;
      const double inside = std::min(r, 0.999);
      const double shrink = r > 0 ? inside / r : 1;
      const Rgb light = seen(texture, all, {u * shrink, v * shrink, std::sqrt(1 - inside * inside)});
      for (int c = 0; c < 3; ++c) {
        const float shown = report::srgb_from_linear(static_cast<float>(light[static_cast<std::size_t>(c)]));
        float& pixel = picture(x, y, c);
        pixel += static_cast<float>(covered) * (shown - pixel);
      }
    }
  });
  return picture;
}

}  // namespace weft::app
