// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

// What a material is made of. Files that people write, stacks of layers and built materials share this table.

namespace weft::material {

enum class Parameter {
  kAlbedo,
  kAlbedoTint,
  kOpacity,
  kNormal,
  kNormalScale,
  kHeight,
  kOcclusion,
  kCavity,
  kRoughness,
  kSpecular,
  kSpecularTint,
  kMetallic,
  kAnisotropy,
  kAnisotropyDeg,
  kSheen,
  kSheenRoughness,
  kCloth
};
inline constexpr std::size_t kParameters = 17;

enum class ParameterKind {
  kScalar,  ///< one number
  kColour,  ///< linear Rec.709
  kNormal,  ///< X, Y, Z; x to the right, y up the picture, z towards the viewer
  kBinary,  ///< as a number 0 or 1; a map may lie between
};

/// What a mask of one half means between two layers.
enum class BlendSpace {
  kLinear,  ///< the mean of both numbers
  kSlope,   ///< of both slopes: the normal of the mean height
  kAxis,    ///< of both directions, as vectors of twice the angle and the anisotropy as their length
  kFactor,  ///< none: it changes another parameter of its own table and is gone
};

struct ParameterFacts {
  Parameter parameter;
  const char* name;  ///< in files
  ParameterKind kind;
  const char* unit;    ///< as files of maps have it
  double least, most;  ///< of each number
  std::array<double, 3> otherwise;
  BlendSpace blend;
  const char* says;
};

/// All of them, in the order of Parameter.
std::span<const ParameterFacts> parameters();
const ParameterFacts& facts_of(Parameter parameter);
std::optional<Parameter> parameter_named(std::string_view name);

/// Numbers that a value has in a file: 3 of colours and normals, else 1.
int numbers_of(ParameterKind kind);

/// Reflectance at normal incidence over `specular` (Burley 2012).
inline constexpr double kF0OfSpecular = 0.08;

}  // namespace weft::material
