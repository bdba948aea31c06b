// SPDX-License-Identifier: Apache-2.0
#include "tests/solve/cloth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace weft::solve {
namespace {

Photographs unlit(Size size, const DistantLights& lights) {
  Photographs photographs;
  photographs.size = size;
  photographs.albedo_scale = AlbedoScale::kAbsolute;
  photographs.field = *LightField::make(lights, std::nullopt, size, 0);
  return photographs;
}

double reading_of(const Cloth& cloth, const DistantLight& light, int c, int x, int y) {
  const auto channel = static_cast<std::size_t>(c);
  solver::Lobe lobe = cloth.is_matt(x, y) ? solver::Lobe{} : cloth.lobe;
  lobe.alpha *= cloth.roughening(x, y);
  solver::LitFrom from(light.direction, {0, 0, 1}, cloth.lobe_share);
  from.channel = c;
  const Vec3 b = cloth.albedo[channel] * cloth.normal(x, y);
  const double matt = cloth.matt_share(x, y);
  return light.irradiance_rgb[channel] * ((1 - matt) * solver::modelled(lobe, b, from, cloth.yarn(x, y)) +
                                          matt * solver::modelled(solver::Lobe{}, b, from, 0));
}

}  // namespace

DistantLights ten_lights(const std::array<double, 3>& rgb) {
  DistantLights lights;
  const auto add_ring = [&](int count, double zenith_deg) {
    for (int i = 0; i < count; ++i) {
      const double azimuth = 2 * kPi * i / count, zenith = radians(zenith_deg);
      lights.lights.push_back(
          {{std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)},
           rgb});
    }
  };
  add_ring(4, 35);
  add_ring(6, 62);
  return lights;
}

Vec3 wave(int x, int /*y*/) {
  return normalized({std::tan(radians(15)) * std::sin(2 * kPi * x / 24), 0, 1});
}

Photographs developed(Size size, const Cloth& cloth, const DistantLights& lights) {
  Photographs photographs = unlit(size, lights);
  Developed frames;
  for (const DistantLight& light : lights.lights) {
    Image<float>& image = frames.rgb.emplace_back(size, 3);
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x)
          image(x, y, c) = static_cast<float>(reading_of(cloth, light, c, x, y));
      }
    }
  }
  photographs.frames = std::move(frames);
  photographs.lobe_share = cloth.lobe_share;
  return photographs;
}

RawFrame frame_of(Size size, const std::function<double(int x, int y)>& reading) {
  RawFrame frame;
  frame.counts = Image<std::uint16_t>(size);
  frame.black = {{{kBlack, kBlack}, {kBlack, kBlack}}};
  frame.white = kBlack + kRange;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      frame.counts(x, y) =
          static_cast<std::uint16_t>(std::lround(kBlack + kRange * std::clamp(reading(x, y), 0.0, 1.0)));
    }
  }
  return frame;
}

Photographs mosaics(Size size, const Cloth& cloth, const DistantLights& lights) {
  Photographs photographs = unlit(size, lights);
  std::vector<RawFrame> frames;
  for (const DistantLight& light : lights.lights) {
    frames.push_back(frame_of(
        size, [&](int x, int y) { return reading_of(cloth, light, CfaPattern().channel_at(x, y), x, y); }));
  }
  photographs.frames = Mosaics(std::move(frames), std::nullopt,
                               {.electrons_per_count = 2, .read_noise_counts = 3}, {1e6, 100});
  photographs.lobe_share = cloth.lobe_share;
  return photographs;
}

Result<void> WholeMaps::operator()(const MapBand& band) {
  EXPECT_EQ(band.rows.y0, rows) << "bands come in order";
  EXPECT_EQ(band.albedo_rows.y0, albedo_rows);
  const auto copy = [](View<const float> from, Image<float>& to, int plane, int row0) {
    for (int y = 0; y < from.height(); ++y)
      std::copy_n(from.row(y), from.width(), to.plane(plane).row(row0 + y));
  };
  for (int c = 0; c < 3; ++c) {
    copy(band.normal[static_cast<std::size_t>(c)], normal, c, rows);
    copy(band.albedo[static_cast<std::size_t>(c)], albedo, c, albedo_rows);
  }
  for (int y = 0; y < band.status.height(); ++y)
    std::copy_n(band.status.row(y), band.status.width(), status.plane().row(rows + y));
  rows = band.rows.y1;
  albedo_rows = band.albedo_rows.y1;
  return {};
}

}  // namespace weft::solve
