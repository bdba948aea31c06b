// SPDX-License-Identifier: Apache-2.0
#include "simulator/targets/target.h"

#include <algorithm>

#include "simulator/camera/scene_camera.h"
#include "simulator/effects/effects.h"
#include "simulator/spectra/observer.h"

namespace weft::simulator {
namespace {

/// A target and the colours of its inks.
struct Inked {
  Target target;
  std::vector<Rgb> inks;
};

std::vector<Inked> inked_targets(const Scene& scene, bool seen_by_camera) {
  ChannelWeights weights = rec709_weights();
  if (seen_by_camera && scene.effects.spectral) {
    if (const auto camera = camera_weights(scene.spectra.led, scene.spectra.filters)) weights = *camera;
  }
  std::vector<Inked> targets;
  for (const TargetSettings& settings : scene.targets) {
    Inked inked = {*Target::make(settings, scene.seed, static_cast<int>(targets.size())), {}};
    const Result<std::vector<Spectrum>> inks = inks_of(settings, scene.spectra.chart);
    for (const Spectrum& ink : *inks) inked.inks.push_back(channel_reflectance(weights, ink));
    targets.push_back(std::move(inked));
  }
  return targets;
}

ViewRay ray_of(const Lens& lens, int x, int y) {
  const CameraRay ray = lens.ray(x, y);
  return {ray.origin_mm, ray.direction, lens.ray(x + 1, y).direction - ray.direction,
          lens.ray(x, y + 1).direction - ray.direction};
}

}  // namespace

Pass targets_pass(const Scene& scene, const SceneRig& rig, bool seen_by_camera) {
  return {"targets", "lays boards, charts and paper on the table", PassStage::kSurface,
          [targets = inked_targets(scene, seen_by_camera), lens = *Lens::of(rig.camera)](PassTile& tile) {
            tile.target.assign(tile.surface.size(), kCloth);
            for_each_pixel(tile.area, [&](std::size_t i, int x, int y) {
              const ViewRay ray = ray_of(lens, x, y);
              std::optional<TargetHit> nearest;
              std::size_t number = 0;
              for (std::size_t t = 0; t < targets.size(); ++t) {
                const auto hit = targets[t].target.hit(ray);
                if (!hit || (nearest && nearest->distance_mm <= hit->distance_mm)) continue;
                nearest = hit;
                number = t;
              }
              if (!nearest) return;
              const auto& [target, inks] = targets[number];
              const TargetPoint point = target.at(nearest->spot);
              const Rgb ink = target.average(nearest->spot, inks);
              for (std::size_t c = 0; c < 3; ++c) {
                const double albedo = std::min(point.brightness * ink[c], 1.0);
                tile.albedo[i][c] += point.coverage * (albedo - tile.albedo[i][c]);
              }
              if (point.coverage < 0.5) return;
              tile.target[i] = static_cast<int>(number);
              tile.point_mm[i] = point.point_mm;
              tile.surface[i] = {};
              tile.surface[i].normal = point.normal;
            });
          }};
}

Pass paper_pass(const Scene& scene) {
  std::vector<double> non_lambertian;
  for (const TargetSettings& target : scene.targets) non_lambertian.push_back(target.sheet.non_lambertian);
  non_lambertian.resize(scene.targets.size() + scene.balls.size());
  return {"paper", "lets paper depart from Lambert's law", PassStage::kLight,
          [non_lambertian = std::move(non_lambertian)](PassTile& tile) {
            for (std::size_t i = 0; i < tile.irradiance.size(); ++i) {
              if (tile.target[i] < 0) continue;
              const double cosine = std::max(dot(tile.surface[i].normal, tile.light[i].direction), 0.0);
              tile.irradiance[i] *=
                  lambert_factor(non_lambertian[static_cast<std::size_t>(tile.target[i])], cosine);
            }
          }};
}

Pass balls_pass(const Scene& scene, const SceneRig& rig) {
  return {"balls", "lays balls on the table", PassStage::kSurface,
          [balls = scene.balls, first = static_cast<int>(scene.targets.size()),
           lens = *Lens::of(rig.camera)](PassTile& tile) {
            if (first == 0) tile.target.assign(tile.surface.size(), kCloth);
            for_each_pixel(tile.area, [&](std::size_t i, int x, int y) {
              for (std::size_t b = 0; b < balls.size(); ++b) {
                const std::optional<BallHit> there = hit(balls[b], ray_of(lens, x, y));
                if (!there) continue;
                for (double& albedo : tile.albedo[i]) albedo += there->coverage * (balls[b].albedo - albedo);
                if (there->coverage < 0.5) continue;
                tile.target[i] = first + static_cast<int>(b);
                tile.point_mm[i] = there->point_mm;
                tile.surface[i] = {};
                tile.surface[i].normal = there->normal;
              }
            });
          }};
}

Pass mirrored_lamps_pass(const Scene& scene, const SceneRig& rig) {
  return {"mirrored lamps", "lets balls mirror the LED", PassStage::kLight,
          [balls = scene.balls, first = static_cast<int>(scene.targets.size()),
           lens = *Lens::of(rig.camera)](PassTile& tile) {
            if (tile.led == 0) return;
            for_each_pixel(tile.area, [&](std::size_t i, int x, int y) {
              if (tile.target[i] < first) return;
              const BallSettings& ball = balls[static_cast<std::size_t>(tile.target[i] - first)];
              tile.irradiance[i] += tile.light[i].strength *
                                    mirrored(ball, ray_of(lens, x, y), tile.light[i].direction) / ball.albedo;
            });
          }};
}

}  // namespace weft::simulator
