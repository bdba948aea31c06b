// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "exchange/document.h"

// A material as U3M 1.1 (Vizoo, the JSON schema and the rules beside it) and its archive U3MA.

namespace weft::exchange {

struct FibrePart {
  double share = 1;   ///< 0 to 1
  std::string fibre;  ///< in any words: "virgin wool"
};

/// What is known of the cloth beside how it looks.
struct U3mPhysics {
  std::optional<double> thickness_mm, weight_g_m2;
  std::vector<FibrePart> composition;
  std::string construction;  ///< in any words: "twill 2/1"; empty: not known
};

struct U3mOptions {
  std::string description;
  std::string created, modified;  ///< ISO 8601, of the inputs
  std::string digest;             ///< 64 hexadecimal digits of the inputs; the document's id comes from it
  U3mPhysics physics;
};

/// The parts of "80 % wool, 20 % polyamide", "wool 80%, polyamide 20%" or "cotton". Nothing where there is no
/// share to a fibre or the shares miss 1 by more than 0.005; else they are scaled to a sum of 1.
std::optional<std::vector<FibrePart>> fibres_of(std::string_view composition);

/// The word of U3M for a fibre or a construction, or nothing: "polyamide" is its "Polyamid".
std::optional<std::string> u3m_fibre(std::string_view words);
std::optional<std::string> u3m_construction(std::string_view words);

/// A UUID with the version and variant of random ones, made of the first 128 bits of a SHA-256.
std::string uuid_of(std::string_view sha256);

/// The document with all members of one side, `front`. Scalars are grey images of PNG, JPEG or TIFF,
/// constants the means, colours as constants in sRGB. Roughness and anisotropy become those of the principled
/// model (Burley 2012), exact at their means: one factor scales the map of
/// roughness. `custom.weft` holds the
/// provenance.
///
/// kBadData: as check_material(); no known size (U3M is in millimetres); a scalar in one channel of a colour
/// image; another kind of image; times or a digest that are none; a mass or thickness below 0.
Result<Document> u3m_of(const TexturedMaterial& material, const U3mOptions& options);

/// The archive: `name` (ends in ".u3m") and the files that the document names. Errors as zip_of().
Result<std::string> u3ma_of(const std::string& name, const Document& document, const FileBytes& files);

}  // namespace weft::exchange
