// SPDX-License-Identifier: Apache-2.0
#include "exchange/presets/mips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "exchange/blocks/dds.h"
#include "exchange/presets/reduce.h"

namespace weft::exchange {
namespace {

std::optional<int> place_of(const PresetFile& file, const std::string& channel) {
  const auto found = std::ranges::find(file.channels, channel);
  if (found == file.channels.end()) return std::nullopt;
  return static_cast<int>(found - file.channels.begin());
}

// The third part of a unit direction that looks to the viewer.
Image<float> third_of(View<const float> x, View<const float> y) {
  Image<float> z(x.size());
  for (int j = 0; j < x.height(); ++j) {
    for (int i = 0; i < x.width(); ++i)
      z(i, j) = std::sqrt(std::max(0.0F, 1 - x(i, j) * x(i, j) - y(i, j) * y(i, j)));
  }
  return z;
}

void reduce_direction(const PresetFile& file, const std::string& stem, const Image<float>& values,
                      int threads, Image<float>& to) {
  const std::optional<int> x = place_of(file, stem + ".x"), y = place_of(file, stem + ".y"),
                           z = place_of(file, stem + ".z");
  if (!x || !y) return;
  const Image<float> third = third_of(values.plane(*x), values.plane(*y));
  Image<float> spare(to.size());
  reduce_normals({values.plane(*x), values.plane(*y), third.plane()}, threads,
                 {to.plane(*x), to.plane(*y), z ? to.plane(*z) : spare.plane()});
}

// Where a plane stands among those of a level of the lobe.
std::optional<int> place_in_lobe(MapPlane plane) {
  constexpr std::array kLobe = {MapPlane::kAlpha, MapPlane::kAlphaAlong, MapPlane::kYarnDeg};
  const auto* found = std::ranges::find(kLobe, plane);
  if (found == kLobe.end()) return std::nullopt;
  return static_cast<int>(found - kLobe.begin());
}

}  // namespace

bool is_of_lobe(const Channel& channel) {
  return !channel.planes.empty() &&
         std::ranges::all_of(channel.planes, [](MapPlane plane) { return place_in_lobe(plane).has_value(); });
}

void put_lobe(const PresetFile& file, const ChannelFacts& facts, LobeLevels lobe, int level,
              Image<float>& values) {
  if (lobe.empty()) return;
  const Image<float>& from = lobe[std::min(static_cast<std::size_t>(level), lobe.size()) - 1];
  ChannelFacts own = facts;
  own.direction = file.direction;
  for (std::size_t c = 0; c < file.channels.size(); ++c) {
    const Channel& channel = *channel_named(file.channels[c]);
    if (!is_of_lobe(channel)) continue;
    std::array<float, 4> in = {};
    for (int y = 0; y < values.height(); ++y) {
      const int row = std::min(y, from.height() - 1);
      for (int x = 0; x < values.width(); ++x) {
        for (std::size_t i = 0; i < channel.planes.size(); ++i)
          in[i] = from(std::min(x, from.width() - 1), row, *place_in_lobe(channel.planes[i]));
        values(x, y, static_cast<int>(c)) = channel.value(in.data(), own);
      }
    }
  }
}

Image<float> next_level(const PresetFile& file, const Image<float>& values, int threads) {
  Image<float> next(level_size(values.size(), 1), values.planes());
  for (int c = 0; c < values.planes(); ++c) reduce(values.plane(c), Averaging::kMean, threads, next.plane(c));
  for (const char* stem : {"normal", "detail.normal"}) reduce_direction(file, stem, values, threads, next);
  return next;
}

}  // namespace weft::exchange
