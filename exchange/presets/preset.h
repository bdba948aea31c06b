// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/image_io/image_io.h"
#include "exchange/blocks/block_format.h"
#include "exchange/presets/channels.h"

// A preset says which files a user gets: names, channels, encodings. It is TOML (docs/exports.md has the
// keys) and names no cloth, so that it serves any.

namespace weft::exchange {

enum class Encoding { kPng, kTiff, kExr, kDds, kTx };
inline constexpr std::array<const char*, 5> kEncodingNames = {"png", "tiff", "exr", "dds", "tx"};
inline constexpr std::array<const char*, 3> kColorSpaceNames = {"data", "srgb", "linear"};

/// How samples are stored.
struct Stored {
  Encoding encoding = Encoding::kPng;
  int bits = 8;                            ///< a channel; of exr and tx 16 is half and 32 float
  BlockFormat blocks = BlockFormat::kBc7;  ///< of dds
  ColorSpace color = ColorSpace::kData;    ///< kSrgb: colour channels get its transfer function
  bool is_prman = false;                   ///< of tx: with the metadata that RenderMan looks for

  bool is_float() const { return encoding == Encoding::kExr || encoding == Encoding::kTx || bits == 32; }
  friend bool operator==(const Stored&, const Stored&) = default;
};
const char* name_of(Encoding encoding);
/// "png, 16 bits", "exr, half", "dds, bc5".
std::string words_of(const Stored& stored);

struct PresetFile {
  std::string name;                   ///< pattern with {name}: "{name}_diff.png"
  std::vector<std::string> channels;  ///< of the catalogue; one to four
  Stored stored;
  NormalDirection direction = NormalDirection::kOpenGl;
  bool is_optional = false;  ///< left out where the cloth has no map for it
};

enum class DocumentKind { kGlb, kMaterialX, kUsda, kUsdz, kU3m, kU3ma, kLayers };
inline constexpr std::array<const char*, 7> kDocumentKindNames = {"glb", "mtlx", "usda",  "usdz",
                                                                  "u3m", "u3ma", "layers"};
/// Whether a document of this kind holds its textures itself.
bool holds_its_files(DocumentKind kind);

struct PresetDocument {
  DocumentKind kind = DocumentKind::kGlb;
  std::string name;          ///< pattern with {name}
  bool is_optional = false;  ///< left out where the cloth lacks what the kind asks for
};

struct Preset {
  std::string name;
  std::string says;               ///< for people, a sentence without a full stop
  std::string normal = "opengl";  ///< or "directx" or "both"
  RoughnessConvention roughness = RoughnessConvention::kRoot;
  int most_px = 0;  ///< of the longer side; larger maps are averaged down to it. 0: as they are
  std::vector<PresetFile> files;
  std::vector<PresetDocument> documents;

  /// Whether textures lie in the documents alone.
  bool keeps_no_files() const;
};

/// A preset from its TOML (schema weft.preset/1); `where` is its file. kBadData with file and key: an unknown
/// key, channel or word with the nearest known one, channels that the encoding cannot hold, a name that does
/// not end as its encoding does, that is not portable (exchange/document.h), or that stands twice, also in
/// other case.
Result<Preset> preset_from_toml(std::string_view text, const std::string& where);

/// What weft brings along, in the order of their names.
struct ShippedPreset {
  const char* name;
  const char* toml;
};
const std::vector<ShippedPreset>& shipped_presets();

/// A pattern with the name of the cloth in it.
std::string named(const std::string& pattern, const std::string& name);

}  // namespace weft::exchange
