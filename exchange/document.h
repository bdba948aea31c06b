// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "exchange/textured_material.h"

// What all writers of documents share.

namespace weft::exchange {

/// Files by the names that a TexturedMaterial gives them. The bytes live elsewhere while a writer works.
using FileBytes = std::map<std::string, std::string_view, std::less<>>;

/// A document of a material. The bytes depend on the material and the options alone.
struct Document {
  std::string bytes;
  std::vector<std::string> files = {};     ///< that it names, each once, in the order it names them
  std::vector<std::string> left_out = {};  ///< what the format cannot hold, a sentence each
};

/// Whether `path` is a relative path that any system can hold: parts of 1 to 255 bytes of UTF-8 between "/",
/// none of them "." or "..", no control characters, none of <>:"\|?*$%, no dot or blank at the end of a part,
/// no name that Windows keeps for itself (CON, NUL, COM1, also with an extension). kBadData with the part.
Result<void> check_portable_path(std::string_view path);

/// Whether a text is UTF-8 without control characters.
bool is_plain_text(std::string_view text);

/// What every writer asks first. kBadData with the parameter as `where`: a name that is empty, a text
/// that is not plain, a size that is not above 0, a constant that is not finite or outside its range, a
/// texture whose path is not portable, whose size or bits are none, whose channels do not fit its parameter,
/// whose scale and offset leave the range, or that lies in sRGB and is no colour.
Result<void> check_material(const TexturedMaterial& material);

/// Letters, digits and "_" of `name`, "_" for every other character, with "_" before a digit; "cloth" where
/// no letter or digit is left. Names beyond ASCII, which lose letters so, end in "_" and eight digits that
/// tell them apart. A name of a node in MaterialX and of a prim in USD.
std::string identifier_of(std::string_view name);

/// The shortest text that reads back as the same double ("0.1", "1e-07"), whatever the locale; "0" for -0.
std::string number_text(double value);
/// The same of several, with ", " between.
std::string numbers_text(const std::vector<double>& values);

/// The index of refraction of a dielectric in air with this reflectance at normal incidence, 0 to below 1:
/// (1 + sqrt f0) / (1 - sqrt f0), from Fresnel's equations.
double ior_of_f0(double f0);

/// The two alphas of an anisotropic GGX lobe: `along` the direction that its highlight is stretched in.
struct Alphas {
  double along = 0, across = 0;
};
/// The alphas of a perceptual roughness and a strength of anisotropy as TexturedMaterial has them.
Alphas alphas_of(double roughness, double anisotropy);

}  // namespace weft::exchange
