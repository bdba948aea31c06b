// SPDX-License-Identifier: Apache-2.0
#include "exchange/presets/pack.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace weft::exchange {
namespace {

const SourcePlane& plane_in(const SourcePlanes& planes, MapPlane plane) {
  return planes[static_cast<std::size_t>(plane)];
}

// Inverse of each other to rounding (IEC 61966-2-1); below 0 the straight part goes on.
float to_srgb(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
}
float from_srgb(float display) {
  return display <= 0.04045F ? display / 12.92F : std::pow((display + 0.055F) / 1.055F, 2.4F);
}

// Where the values of one plane of a pixel come from.
struct Cursor {
  const float* row = nullptr;
  float constant = 0;
  float at(int x) const { return row == nullptr ? constant : row[x]; }
};

Cursor cursor_of(const SourcePlanes& planes, MapPlane plane, int y) {
  const SourcePlane& source = plane_in(planes, plane);
  if (!source.pixels.empty()) return {source.pixels.row(y), 0};
  return {nullptr, static_cast<float>(source.constant.value_or(kind_of(plane).otherwise.value_or(0)))};
}

void pack_channel(const Channel& channel, const SourcePlanes& planes, const ChannelFacts& facts, int y0,
                  View<float> out) {
  std::array<Cursor, 4> cursors;
  std::array<float, 4> in = {};
  for (int y = 0; y < out.height(); ++y) {
    for (std::size_t i = 0; i < channel.planes.size(); ++i)
      cursors[i] = cursor_of(planes, channel.planes[i], y0 + y);
    float* row = out.row(y);
    for (int x = 0; x < out.width(); ++x) {
      for (std::size_t i = 0; i < channel.planes.size(); ++i) in[i] = cursors[i].at(x);
      row[x] = channel.value(in.data(), facts);
    }
  }
}

// The function of a sample for each channel of the file, over all pixels.
template <typename Change>
void change_each(View<float> plane, const Change& change) {
  for (int y = 0; y < plane.height(); ++y) {
    float* row = plane.row(y);
    for (int x = 0; x < plane.width(); ++x) row[x] = change(row[x]);
  }
}

bool is_display_color(const PresetFile& file, const Channel& channel) {
  return file.stored.color == ColorSpace::kSrgb && channel.kind == ChannelKind::kColor;
}

}  // namespace

Result<void> check_file(const PresetFile& file, const SourcePlanes& planes, const std::string& preset) {
  for (const std::string& name : file.channels) {
    for (const MapPlane plane : channel_named(name)->planes) {
      const PlaneKind& kind = kind_of(plane);
      if (plane_in(planes, plane).is_there() || kind.otherwise) continue;
      return Error{ErrorKind::kBadData, "the preset asks for a map that is not there",
                   fmt::format("preset {}: {}", preset, file.name),
                   fmt::format("{} comes from the map {}, which these maps lack", name, kind.map),
                   fmt::format("make it first, as by weft maps --maps {}, or mark the file optional = true",
                               kind.map)};
    }
  }
  return {};
}

bool says_something(const PresetFile& file, const SourcePlanes& planes) {
  return std::ranges::any_of(file.channels, [&](const std::string& name) {
    const Channel& channel = *channel_named(name);
    std::array<float, 4> in = {};
    bool is_there = false;
    for (std::size_t i = 0; i < channel.planes.size(); ++i) {
      const SourcePlane& source = plane_in(planes, channel.planes[i]);
      if (!source.pixels.empty()) return true;
      is_there = is_there || source.constant.has_value();
      in[i] = cursor_of(planes, channel.planes[i], 0).constant;
    }
    return is_there && !(channel.neutral && *channel.neutral == channel.value(in.data(), {}));
  });
}

void pack_values(const PresetFile& file, const SourcePlanes& planes, const ChannelFacts& facts, int y0,
                 std::span<const View<float>> out) {
  ChannelFacts own = facts;
  own.direction = file.direction;
  for (std::size_t c = 0; c < file.channels.size(); ++c)
    pack_channel(*channel_named(file.channels[c]), planes, own, y0, out[c]);
}

void to_samples(const PresetFile& file, const ChannelFacts& facts, std::span<const View<float>> values) {
  for (std::size_t c = 0; c < file.channels.size(); ++c) {
    const Channel& channel = *channel_named(file.channels[c]);
    if (is_display_color(file, channel)) change_each(values[c], to_srgb);
    if (file.stored.is_float()) continue;
    const ChannelRange range = range_of(channel, facts);
    const auto least = static_cast<float>(range.least), span = static_cast<float>(range.most - range.least);
    if (least == 0 && span == 1) continue;
    change_each(values[c], [=](float v) { return span > 0 ? (v - least) / span : 0.5F; });
  }
}

void to_values(const PresetFile& file, const ChannelFacts& facts, std::span<const View<float>> samples) {
  for (std::size_t c = 0; c < file.channels.size(); ++c) {
    const Channel& channel = *channel_named(file.channels[c]);
    if (!file.stored.is_float()) {
      const ChannelRange range = range_of(channel, facts);
      const auto least = static_cast<float>(range.least), span = static_cast<float>(range.most - range.least);
      if (least != 0 || span != 1) change_each(samples[c], [=](float v) { return least + span * v; });
    }
    if (is_display_color(file, channel)) change_each(samples[c], from_srgb);
  }
}

std::vector<std::string> channel_names(std::size_t channels) {
  constexpr std::array<std::array<const char*, 4>, 4> kNames = {
      {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}};
  const auto& names = kNames[channels - 1];
  return {names.begin(), names.begin() + static_cast<std::ptrdiff_t>(channels)};
}

}  // namespace weft::exchange
