// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/image/image.h"

// A material as it leaves weft: textures, and what each of them means. The writers of documents (glTF,
// MaterialX, USD, U3M) are pure functions of it: the same material gives the same bytes.

namespace weft::exchange {

/// A file of texels, and where in it a parameter stands.
struct Texture {
  std::string file;              ///< relative to the document, "/" between folders
  Size size;                     ///< pixels
  int bits = 8;                  ///< a channel
  std::string channels = "r";    ///< of the file: "r", "g", "b", "a", "rg" or "rgb"
  bool is_srgb = false;          ///< colour with the transfer function of sRGB; else linear
  double scale = 1, offset = 0;  ///< value = scale * texel + offset, texel from 0 to 1 and linear
};

/// A parameter is a texture or the same everywhere.
struct TexturedParameter {
  std::optional<Texture> texture = {};
  std::array<double, 3> constant = {};  ///< linear; where there is a texture its mean
  std::string source = "assumed";       ///< "measured", "derived" or "assumed"
};

/// Values of a parameter are the linear ones of its comment, whatever a document's own convention is.
struct TexturedMaterial {
  std::string name;                              ///< of the cloth
  std::optional<std::array<double, 2>> size_mm;  ///< width and height that a texture covers; none: not known
  bool is_size_known = true;                     ///< else `size_mm` is assumed
  bool repeats = false;                          ///< the right border goes on at the left one, and so down

  TexturedParameter base_color;                ///< albedo, linear Rec.709, 0 to 1
  std::optional<TexturedParameter> normal;     ///< unit, x right, y up (OpenGL); texel = n / 2 + 1/2
  std::optional<TexturedParameter> height_mm;  ///< towards the viewer, mean 0; scale and offset give mm
  /// Perceptual: its square is alpha of GGX, of an anisotropic lobe the smaller of its two.
  std::optional<TexturedParameter> roughness;
  std::optional<TexturedParameter> occlusion;  ///< 1 open
  std::optional<TexturedParameter> opacity;    ///< 1 cloth, 0 hole
  std::optional<TexturedParameter> f0;         ///< reflectance at normal incidence
  std::optional<TexturedParameter> metallic;   ///< 0 or 1
  /// Strength s, 0 to 1, as in KHR_materials_anisotropy: the larger alpha is alpha + (1 - alpha) s^2.
  std::optional<TexturedParameter> anisotropy;
  std::optional<TexturedParameter>
      anisotropy_direction;  ///< unit x, y that a highlight is stretched along; texel = d / 2 + 1/2
  std::optional<TexturedParameter> sheen_color;      ///< linear Rec.709
  std::optional<TexturedParameter> sheen_roughness;  ///< perceptual

  /// What leads back to the photographs: "session", "solve", "maps", "calibration", "source.roughness" ...
  std::vector<std::pair<std::string, std::string>> provenance;
};

}  // namespace weft::exchange
