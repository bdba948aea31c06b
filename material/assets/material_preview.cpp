// SPDX-License-Identifier: Apache-2.0
#include "material/assets/material_preview.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/parallel.h"
#include "material/filtering/boxes.h"
#include "material/layers/fit.h"
#include "report/preview.h"
#include "solver/reflectance/lobe.h"

namespace weft::material {
namespace {

using solver::Lobe;
using solver::LobeFamily;

constexpr double kLeastAlpha = 0.02;  // below it a lobe is seen by no pixel

// pi D V of a lobe, without its reflectance.
double facets(Lobe lobe, Vec3 normal, const solver::LitFrom& from, double yarn) {
  lobe.f0 = 1;
  return solver::specular(lobe, normal, from, yarn);
}

double schlick(double f0, double cosine) {
  return f0 + (1 - f0) * std::pow(1 - std::clamp(cosine, 0.0, 1.0), 5);
}

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
    size_ = size_of_level(maps.surface.size(), level);
    if (mip_ != nullptr) {
      ParameterField albedo = {3, {}, {}};
      albedo.map = Image<float>(maps.surface.size(), 3);
      for (int p = 0; p < 3; ++p) {
        for (int y = 0; y < albedo.map.height(); ++y)
          std::copy_n(maps.surface.albedo.plane(p).row(y), albedo.map.width(), albedo.map.plane(p).row(y));
      }
      small_ = fitted(albedo, BlendSpace::kLinear, {}, size_, threads);
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
  const MipLevel* mip_ = nullptr;
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

Rgb shaded(const ShadedPoint& point, Vec3 normal, Vec3 to_light, Vec3 to_view) {
  const double n_l = dot(normal, to_light);
  if (!(n_l > 0)) return {0, 0, 0};
  const solver::LitFrom from(to_light, to_view);
  const double alpha = std::clamp(point.alpha, kLeastAlpha, 1.0);
  const Lobe ggx = {.family = LobeFamily::kAnisotropicGgx,
                    .alpha = alpha,
                    .along = std::clamp(point.alpha_along / alpha, 0.05, 20.0)};
  const Lobe fuzz = {.family = LobeFamily::kCloth, .alpha = std::clamp(point.sheen_alpha, kLeastAlpha, 1.0)};
  const double mirrored = point.cloth < 1 ? facets(ggx, normal, from, radians(point.yarn_deg)) : 0;
  const double fuzzed = point.cloth > 0 ? facets(fuzz, normal, from, 0) : 0;
  Rgb out = {};
  for (std::size_t c = 0; c < out.size(); ++c) {
    const double f0 =
        point.f0 * point.f0_tint[c] + point.metallic * (point.albedo[c] - point.f0 * point.f0_tint[c]);
    const double f = schlick(f0, from.light_half), f_sheen = schlick(point.sheen[c], from.light_half);
    const double diffuse = std::max(point.albedo[c], 0.0) * (1 - point.metallic);
    const double by_ggx = diffuse * (1 - f) + f * mirrored;
    const double by_cloth = diffuse * (1 - f_sheen) + f_sheen * fuzzed;
    out[c] = n_l * (by_ggx + point.cloth * (by_cloth - by_ggx));
  }
  return out;
}

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

}  // namespace weft::material
