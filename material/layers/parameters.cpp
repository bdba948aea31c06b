// SPDX-License-Identifier: Apache-2.0
#include "material/layers/parameters.h"

#include <algorithm>

namespace weft::material {
namespace {

using enum ParameterKind;
using enum BlendSpace;

constexpr std::array<ParameterFacts, kParameters> kFacts = {{
    {Parameter::kAlbedo,
     "albedo",
     kColour,
     "share",
     0,
     1,
     {0.5, 0.5, 0.5},
     kLinear,
     "diffuse reflectance, linear Rec.709"},
    {Parameter::kAlbedoTint,
     "albedo_tint",
     kColour,
     "ratio",
     0,
     4,
     {1, 1, 1},
     kFactor,
     "multiplies the albedo"},
    {Parameter::kOpacity, "opacity", kScalar, "share", 0, 1, {1}, kLinear, "1 cloth, 0 a hole"},
    {Parameter::kNormal,
     "normal",
     kNormal,
     "unit vector",
     -1,
     1,
     {0, 0, 1},
     kSlope,
     "x to the right, y up, z towards the viewer"},
    {Parameter::kNormalScale, "normal_scale", kScalar, "ratio", 0, 4, {1}, kFactor, "multiplies the slopes"},
    {Parameter::kHeight, "height_mm", kScalar, "mm", -100, 100, {0}, kLinear, "towards the viewer"},
    {Parameter::kOcclusion, "occlusion", kScalar, "share", 0, 1, {1}, kLinear, "share of the sky, 1 open"},
    {Parameter::kCavity, "cavity", kScalar, "", 0, 1, {0.5}, kLinear, "0 deep, 0.5 flat, 1 high"},
    {Parameter::kRoughness,
     "roughness",
     kScalar,
     "roughness",
     0,
     1,
     {0.7},
     kLinear,
     "its square is alpha of GGX, across the yarn"},
    {Parameter::kSpecular, "specular", kScalar, "ratio", 0, 12.5, {0.5}, kLinear, "f0 = 0.08 times it"},
    {Parameter::kSpecularTint,
     "specular_tint",
     kColour,
     "ratio",
     0,
     1,
     {1, 1, 1},
     kLinear,
     "colour of what is mirrored"},
    {Parameter::kMetallic, "metallic", kBinary, "share", 0, 1, {0}, kLinear, "0 or 1; layers mix them"},
    {Parameter::kAnisotropy,
     "anisotropy",
     kScalar,
     "share",
     0,
     1,
     {0},
     kAxis,
     "alpha along the yarn is alpha (1 - anisotropy)"},
    {Parameter::kAnisotropyDeg,
     "anisotropy_deg",
     kScalar,
     "deg",
     0,
     180,
     {0},
     kAxis,
     "of the yarn, from +x counter-clockwise"},
    {Parameter::kSheen,
     "sheen",
     kColour,
     "share",
     0,
     1,
     {0.04, 0.04, 0.04},
     kLinear,
     "f0 of the fibres that stand up"},
    {Parameter::kSheenRoughness,
     "sheen_roughness",
     kScalar,
     "roughness",
     0,
     1,
     {0.7},
     kLinear,
     "its square is the spread of the fibres that stand up"},
    {Parameter::kCloth,
     "cloth",
     kScalar,
     "share",
     0,
     1,
     {0},
     kLinear,
     "weight of the lobe of fibres that stand up; the rest is GGX's"},
}};

}  // namespace

std::span<const ParameterFacts> parameters() {
  return kFacts;
}

const ParameterFacts& facts_of(Parameter parameter) {
  return kFacts[static_cast<std::size_t>(parameter)];
}

std::optional<Parameter> parameter_named(std::string_view name) {
  const auto* found =
      std::ranges::find(kFacts, name, [](const ParameterFacts& f) { return std::string_view(f.name); });
  return found == kFacts.end() ? std::nullopt : std::optional(found->parameter);
}

int numbers_of(ParameterKind kind) {
  return kind == kColour || kind == kNormal ? 3 : 1;
}

}  // namespace weft::material
