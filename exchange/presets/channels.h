// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"
#include "core/rig/gloss_scale.h"

// What a channel of an exported file may hold, and how it is computed from the maps of a cloth.

namespace weft::exchange {

/// The planes of a folder of maps (docs/formats.md), in the order of kPlaneKinds.
enum class MapPlane : std::size_t {
  kAlbedoR,
  kAlbedoG,
  kAlbedoB,
  kNormalX,
  kNormalY,
  kNormalZ,
  kHeight,
  kOpenness,
  kOpacity,
  kAlpha,
  kAlphaAlong,
  kYarnDeg,
  kF0,
  kCavity,
  kMetallic,
  kSheenR,
  kSheenG,
  kSheenB,
  kSheenRoughness,
  kCloth,
  kTintR,
  kTintG,
  kTintB
};

/// Where a plane stands, and what it is where a folder has no such map.
struct PlaneKind {
  const char* map;      ///< by its name in maps.json
  const char* channel;  ///< of its file
  std::optional<double> otherwise = {};
};
inline constexpr std::size_t kPlanes = 23;
inline constexpr std::array<PlaneKind, kPlanes> kPlaneKinds = {{{"albedo", "R"},
                                                                {"albedo", "G"},
                                                                {"albedo", "B"},
                                                                {"normal", "X"},
                                                                {"normal", "Y"},
                                                                {"normal", "Z"},
                                                                {"height", "height"},
                                                                {"occlusion", "openness"},
                                                                {"opacity", "opacity", 1},
                                                                {"roughness", "alpha"},
                                                                {"roughness", "alpha_along"},
                                                                {"roughness", "yarn_deg"},
                                                                {"specular", "f0"},
                                                                {"cavity", "cavity"},
                                                                {"metallic", "metallic", 0},
                                                                {"sheen", "R", 0},
                                                                {"sheen", "G", 0},
                                                                {"sheen", "B", 0},
                                                                {"sheen_roughness", "sheen_roughness", 0},
                                                                {"cloth", "cloth", 0},
                                                                {"specular_tint", "R", 1},
                                                                {"specular_tint", "G", 1},
                                                                {"specular_tint", "B", 1}}};
constexpr const PlaneKind& kind_of(MapPlane plane) {
  return kPlaneKinds[static_cast<std::size_t>(plane)];
}

/// A plane as it was read: pixels, or one number.
struct SourcePlane {
  View<const float> pixels = {};        ///< empty: the number stands everywhere
  std::optional<double> constant = {};  ///< neither: there is no such map
  bool is_there() const { return !pixels.empty() || constant.has_value(); }
};
using SourcePlanes = std::array<SourcePlane, kPlanes>;

enum class NormalDirection { kOpenGl, kDirectX };  ///< y upwards, y downwards
inline constexpr std::array<const char*, 2> kNormalDirectionNames = {"opengl", "directx"};

/// What a channel `roughness` holds.
enum class RoughnessConvention {
  kAlpha,       ///< alpha of GGX
  kRoot,        ///< its root, as glTF and most engines have it
  kGloss,       ///< of seed 001
  kBlinnPhong,  ///< of seed 004
  kSmoothness   ///< one less the root
};
inline constexpr std::array<const char*, 5> kRoughnessConventionNames = {"alpha", "root", "gloss",
                                                                         "blinn-phong", "smoothness"};
/// `alpha`, 0 to 1, in that convention, 0 to 1; and back.
double in_convention(RoughnessConvention convention, double alpha);
double alpha_in(RoughnessConvention convention, double value);

/// What channels need to know beside the pixel's own planes.
struct ChannelFacts {
  NormalDirection direction = NormalDirection::kOpenGl;
  RoughnessConvention roughness = RoughnessConvention::kRoot;
  double height_least_mm = 0, height_most_mm = 0;  ///< of the cloth
  double mean_luminance = 0.5;                     ///< of the albedo
  std::array<double, 2> mean_slope = {};           ///< -x / z and -y / z of the normals
};

enum class ChannelKind {
  kColor,   ///< linear Rec.709
  kNormal,  ///< part of a unit direction
  kData
};

/// One row of the catalogue. An integer file holds (value - least) / (most - least), a float file the value.
struct Channel {
  const char* name;
  const char* says;
  ChannelKind kind;
  const char* unit;              ///< empty: none
  double least = 0, most = 1;    ///< of the value; of `height` those of the facts
  std::vector<MapPlane> planes;  ///< what it is computed from
  float (*value)(const float* planes, const ChannelFacts& facts);  ///< of one pixel
  std::optional<float> neutral = {};  ///< the value of a cloth that has nothing of the kind
};

const std::vector<Channel>& channel_catalogue();
/// Null where there is none of this name.
const Channel* channel_named(std::string_view name);
std::string nearest_channel(std::string_view name);

/// The range of a channel with these facts.
struct ChannelRange {
  double least = 0, most = 1;
};
ChannelRange range_of(const Channel& channel, const ChannelFacts& facts);

}  // namespace weft::exchange
