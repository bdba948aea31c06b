// SPDX-License-Identifier: Apache-2.0
#include "exchange/presets/channels.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/text.h"

namespace weft::exchange {
namespace {

// Luminance of linear Rec.709.
constexpr float kLumaR = 0.2126F, kLumaG = 0.7152F, kLumaB = 0.0722F;

float luminance(const float* rgb) {
  return kLumaR * rgb[0] + kLumaG * rgb[1] + kLumaB * rgb[2];
}

float same(const float* in, const ChannelFacts& /*facts*/) {
  return in[0];
}
template <int N>
float number(const float* /*in*/, const ChannelFacts& /*facts*/) {
  return static_cast<float>(N) / 2;
}

float normal_y(const float* in, const ChannelFacts& facts) {
  return facts.direction == NormalDirection::kDirectX ? -in[0] : in[0];
}

// A normal whose slopes have mean 0 over the cloth.
struct Slope {
  double x = 0, y = 0, length = 1;
};
Slope detail_slope(const float* xyz, const ChannelFacts& facts) {
  const double z = std::max(static_cast<double>(xyz[2]), 1e-6);
  Slope slope = {static_cast<double>(xyz[0]) / z + facts.mean_slope[0],
                 static_cast<double>(xyz[1]) / z + facts.mean_slope[1], 1};
  slope.length = std::sqrt(slope.x * slope.x + slope.y * slope.y + 1);
  return slope;
}
float detail_x(const float* in, const ChannelFacts& facts) {
  const Slope slope = detail_slope(in, facts);
  return static_cast<float>(slope.x / slope.length);
}
float detail_y(const float* in, const ChannelFacts& facts) {
  const Slope slope = detail_slope(in, facts);
  const double y = slope.y / slope.length;
  return static_cast<float>(facts.direction == NormalDirection::kDirectX ? -y : y);
}
float detail_albedo(const float* in, const ChannelFacts& facts) {
  return static_cast<float>(0.5 * static_cast<double>(luminance(in)) / std::max(facts.mean_luminance, 1e-6));
}
float gray(const float* in, const ChannelFacts& /*facts*/) {
  return luminance(in);
}

double root_of_product(const float* alphas) {
  return std::sqrt(std::max(0.0, static_cast<double>(alphas[0])) *
                   std::max(0.0, static_cast<double>(alphas[1])));
}
float roughness(const float* in, const ChannelFacts& facts) {
  return static_cast<float>(in_convention(facts.roughness, root_of_product(in)));
}
float roughness_least(const float* in, const ChannelFacts& facts) {
  return static_cast<float>(in_convention(facts.roughness, static_cast<double>(std::min(in[0], in[1]))));
}

// KHR_materials_anisotropy: the larger alpha is a + (1 - a) s^2 of the smaller one a.
float anisotropy(const float* in, const ChannelFacts& /*facts*/) {
  const double a = static_cast<double>(std::min(in[0], in[1])),
               b = static_cast<double>(std::max(in[0], in[1]));
  return a < 1 && b > a ? static_cast<float>(std::sqrt((b - a) / (1 - a))) : 0.0F;
}
// The azimuth that a highlight is stretched along: the axis of the larger alpha, 0 where both are one.
double stretched_rad(const float* in) {
  constexpr double kRadPerDeg = 0.017453292519943295;
  if (in[0] == in[1]) return 0;
  return (static_cast<double>(in[2]) + (in[1] > in[0] ? 0 : 90)) * kRadPerDeg;
}
float anisotropy_x(const float* in, const ChannelFacts& /*facts*/) {
  return static_cast<float>(std::cos(stretched_rad(in)));
}
float anisotropy_y(const float* in, const ChannelFacts& /*facts*/) {
  return static_cast<float>(std::sin(stretched_rad(in)));
}

float specular(const float* in, const ChannelFacts& /*facts*/) {
  return in[0] / 0.08F;
}
// The tint itself for what is no metal, the albedo for what is.
float specular_tint(const float* in, const ChannelFacts& /*facts*/) {
  return in[2] + in[1] * (in[0] - in[2]);
}

std::vector<Channel> all_channels() {
  using enum ChannelKind;
  using enum MapPlane;
  const std::vector<MapPlane> rgb = {kAlbedoR, kAlbedoG, kAlbedoB}, xyz = {kNormalX, kNormalY, kNormalZ},
                              alphas = {kAlpha, kAlphaAlong}, lobe = {kAlpha, kAlphaAlong, kYarnDeg};
  return {{"albedo.r", "diffuse reflectance, red", kColor, "", 0, 1, {kAlbedoR}, same},
          {"albedo.g", "green", kColor, "", 0, 1, {kAlbedoG}, same},
          {"albedo.b", "blue", kColor, "", 0, 1, {kAlbedoB}, same},
          {"albedo.gray", "luminance of the albedo", kColor, "", 0, 1, rgb, gray},
          {"detail.albedo", "half of the luminance over its mean", kData, "", 0, 1, rgb, detail_albedo},
          {"normal.x", "to the right", kNormal, "", -1, 1, {kNormalX}, same},
          {"normal.y", "up, or down in DirectX's direction", kNormal, "", -1, 1, {kNormalY}, normal_y},
          {"normal.z", "to the viewer", kNormal, "", -1, 1, {kNormalZ}, same},
          {"detail.normal.x", "of normals whose slopes have mean 0", kNormal, "", -1, 1, xyz, detail_x},
          {"detail.normal.y", "of the same", kNormal, "", -1, 1, xyz, detail_y},
          {"height",
           "to the viewer, from the least to the largest of the cloth",
           kData,
           "mm",
           0,
           1,
           {kHeight},
           same,
           0.0F},
          {"occlusion", "share of the sky that is seen", kData, "", 0, 1, {kOpenness}, same, 1.0F},
          {"opacity", "0 a hole, 1 cloth", kData, "", 0, 1, {kOpacity}, same, 1.0F},
          {"cavity", "0 deep, 0.5 flat, 1 high", kData, "", 0, 1, {kCavity}, same, 0.5F},
          {"roughness", "of the geometric mean of both alphas, in the preset's convention", kData, "", 0, 1,
           alphas, roughness},
          {"roughness.least", "of the smaller alpha, in the preset's convention", kData, "", 0, 1, alphas,
           roughness_least},
          {"anisotropy", "s of KHR_materials_anisotropy", kData, "", 0, 1, alphas, anisotropy, 0.0F},
          {"anisotropy.x", "direction that highlights are stretched along, to the right", kNormal, "", -1, 1,
           lobe, anisotropy_x, 1.0F},
          {"anisotropy.y", "up", kNormal, "", -1, 1, lobe, anisotropy_y, 0.0F},
          {"f0", "reflectance at normal incidence", kData, "", 0, 1, {kF0}, same},
          {"specular", "that reflectance over 0.08", kData, "", 0, 1, {kF0}, specular, 0.5F},
          {"specular_tint.r",
           "colour of the highlight, of a metal the albedo: red",
           kColor,
           "",
           0,
           1,
           {kAlbedoR, kMetallic, kTintR},
           specular_tint},
          {"specular_tint.g", "green", kColor, "", 0, 1, {kAlbedoG, kMetallic, kTintG}, specular_tint},
          {"specular_tint.b", "blue", kColor, "", 0, 1, {kAlbedoB, kMetallic, kTintB}, specular_tint},
          {"metallic", "0 or 1", kData, "", 0, 1, {kMetallic}, same, 0.0F},
          {"sheen.r", "colour of the sheen, red", kColor, "", 0, 1, {kSheenR}, same, 0.0F},
          {"sheen.g", "green", kColor, "", 0, 1, {kSheenG}, same, 0.0F},
          {"sheen.b", "blue", kColor, "", 0, 1, {kSheenB}, same, 0.0F},
          {"sheen_roughness", "root of the sheen's alpha", kData, "", 0, 1, {kSheenRoughness}, same, 0.0F},
          {"cloth", "0 GGX alone, 1 the lobe of cloth alone", kData, "", 0, 1, {kCloth}, same, 0.0F},
          {"zero", "0", kData, "", 0, 1, {}, number<0>},
          {"half", "0.5", kData, "", 0, 1, {}, number<1>},
          {"one", "1", kData, "", 0, 1, {}, number<2>}};
}

}  // namespace

double in_convention(RoughnessConvention convention, double alpha) {
  switch (convention) {
    case RoughnessConvention::kAlpha:
      return on_scale(GlossScale::kAlpha, alpha);
    case RoughnessConvention::kRoot:
      return on_scale(GlossScale::kRoughness, alpha);
    case RoughnessConvention::kGloss:
      return on_scale(GlossScale::kGloss, alpha);
    case RoughnessConvention::kBlinnPhong:
      return on_scale(GlossScale::kBlinnPhong, alpha);
    case RoughnessConvention::kSmoothness:
      return 1 - on_scale(GlossScale::kRoughness, alpha);
  }
  return alpha;
}

double alpha_in(RoughnessConvention convention, double value) {
  switch (convention) {
    case RoughnessConvention::kAlpha:
      return alpha_of(GlossScale::kAlpha, value);
    case RoughnessConvention::kRoot:
      return alpha_of(GlossScale::kRoughness, value);
    case RoughnessConvention::kGloss:
      return alpha_of(GlossScale::kGloss, value);
    case RoughnessConvention::kBlinnPhong:
      return alpha_of(GlossScale::kBlinnPhong, value);
    case RoughnessConvention::kSmoothness:
      return alpha_of(GlossScale::kRoughness, 1 - value);
  }
  return value;
}

const std::vector<Channel>& channel_catalogue() {
  static const std::vector<Channel> channels = all_channels();
  return channels;
}

const Channel* channel_named(std::string_view name) {
  for (const Channel& channel : channel_catalogue()) {
    if (name == channel.name) return &channel;
  }
  return nullptr;
}

std::string nearest_channel(std::string_view name) {
  const auto far = [name](const Channel& channel) { return edit_distance(name, channel.name); };
  return std::ranges::min_element(channel_catalogue(), {}, far)->name;
}

ChannelRange range_of(const Channel& channel, const ChannelFacts& facts) {
  if (channel.name == std::string_view("height")) return {facts.height_least_mm, facts.height_most_mm};
  return {channel.least, channel.most};
}

}  // namespace weft::exchange
