// SPDX-License-Identifier: Apache-2.0
#include "exchange/presets/preset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include "core/base/text.h"
#include "core/toml/field_toml.h"
#include "core/toml/toml_json.h"
#include "exchange/document.h"

namespace weft::exchange {
namespace {

constexpr const char* kPage = "docs/exports.md";
constexpr const char* kSchema = "weft.preset/1";
constexpr std::size_t kMostFiles = 64;

const std::vector<std::string>& endings_of(Encoding encoding) {
  static const std::array<std::vector<std::string>, 5> endings = {
      {{".png"}, {".tif", ".tiff"}, {".exr"}, {".dds"}, {".tx"}}};
  return endings[static_cast<std::size_t>(encoding)];
}

std::vector<int> bits_of(Encoding encoding) {
  switch (encoding) {
    case Encoding::kPng:
      return {8, 16};
    case Encoding::kTiff:
      return {8, 16, 32};
    case Encoding::kDds:
      return {8};
    default:
      return {16, 32};
  }
}

/// A [[file]], with what depends on other keys as it is said.
struct WrittenFile {
  PresetFile file;
  std::optional<int> bits;
  std::optional<std::string> blocks, normal;
};

/// A [[document]].
struct WrittenDocument {
  PresetDocument document;
};

struct WrittenPreset {
  Preset preset;
  std::string schema;
  std::vector<WrittenFile> files;
  std::vector<WrittenDocument> documents;
};

// How many channels a file of this kind may have.
std::vector<std::size_t> counts_of(const Stored& stored) {
  if (stored.encoding != Encoding::kDds) return {1, 2, 3, 4};
  switch (stored.blocks) {
    case BlockFormat::kBc1:
      return {3};
    case BlockFormat::kBc3:
      return {4};
    case BlockFormat::kBc4:
      return {1};
    case BlockFormat::kBc5:
      return {2};
    case BlockFormat::kBc7:
      break;
  }
  return {3, 4};
}

void describe_name(Fields& fields, std::string& name, const std::vector<std::string>& endings) {
  fields.value({.name = "name", .says = "Pattern with {name}: \"{name}_diff.png\"", .need = kMustSay}, name);
  const auto ends = [&](const std::string& ending) { return name.ends_with(ending); };
  fields.require(std::ranges::any_of(endings, ends), "name",
                 fmt::format("\"{}\" does not end in {}", name, fmt::join(endings, " or ")));
  const std::string example = named(name, "cloth");
  fields.require(example.find_first_of("{}") == std::string::npos, "name",
                 fmt::format("\"{}\" has braces other than those of {{name}}", name));
  const Result<void> portable = check_portable_path(example);
  fields.require(static_cast<bool>(portable), "name",
                 fmt::format("\"{}\": {}", name, portable ? "" : portable.error().why));
}

void describe_stored(Fields& fields, WrittenFile& w) {
  Stored& stored = w.file.stored;
  fields.choice({"encoding", "Of the file"}, stored.encoding, kEncodingNames);
  const std::vector<int> bits = bits_of(stored.encoding);
  fields.value({"bits", "A channel; default the fewest that the encoding has", {8, 32}}, w.bits);
  stored.bits = w.bits.value_or(bits.front());
  fields.require(
      std::ranges::find(bits, stored.bits) != bits.end(), "bits",
      fmt::format("cannot be: {} holds {} bits", name_of(stored.encoding), fmt::join(bits, " or ")));
  fields.choice({"color", "Transfer function of colour channels"}, stored.color, kColorSpaceNames);
  fields.value({"prman", "A tx has the metadata that RenderMan looks for"}, stored.is_prman);
  fields.require(!stored.is_prman || stored.encoding == Encoding::kTx, "prman",
                 "cannot be: only a tx has it");
  Field blocks = {"blocks", "Of a dds"};
  for (const BlockFormat format : kBlockFormats) blocks.words.emplace_back(name_of(format));
  fields.value(blocks, w.blocks);
  const bool is_dds = stored.encoding == Encoding::kDds;
  fields.require(is_dds || !w.blocks, "blocks", "cannot be: only a dds has blocks");
  fields.require(!is_dds || w.blocks, "blocks",
                 fmt::format("is missing: a dds has blocks: {}", fmt::join(blocks.words, ", ")));
  stored.blocks = block_format_named(w.blocks.value_or("")).value_or(stored.blocks);
}

void describe_channels(Fields& fields, PresetFile& file) {
  fields.value({.name = "channels", .says = "Of the catalogue, one to four", .need = kMustSay},
               file.channels);
  const std::vector<std::size_t> counts = counts_of(file.stored);
  fields.require(std::ranges::find(counts, file.channels.size()) != counts.end(), "channels",
                 fmt::format("cannot be: {} are named where {} holds {}", file.channels.size(),
                             words_of(file.stored), fmt::join(counts, " or ")));
  for (const std::string& each : file.channels) {
    if (channel_named(each) != nullptr) continue;
    fields.require(
        false, "channels",
        fmt::format("cannot be: there is no channel {}; the nearest is {}", each, nearest_channel(each)));
  }
}

void describe(Fields& fields, WrittenFile& w) {
  describe_stored(fields, w);
  describe_name(fields, w.file.name, endings_of(w.file.stored.encoding));
  describe_channels(fields, w.file);
  fields.value({.name = "normal",
                .says = "Which way y goes; default that of the preset",
                .words = {kNormalDirectionNames.begin(), kNormalDirectionNames.end()}},
               w.normal);
  fields.value({"optional", "Left out where the cloth has no map for it"}, w.file.is_optional);
}

void describe(Fields& fields, WrittenDocument& w) {
  PresetDocument& document = w.document;
  fields.choice({.name = "kind", .says = "Of the document", .need = kMustSay}, document.kind,
                kDocumentKindNames);
  const bool is_json = document.kind == DocumentKind::kLayers;
  const std::string ending = is_json ? "json" : kDocumentKindNames[static_cast<std::size_t>(document.kind)];
  describe_name(fields, document.name, {"." + ending});
  fields.value({"optional", "Left out where the cloth lacks what the kind asks for"}, document.is_optional);
}

void describe(Fields& fields, WrittenPreset& w) {
  Preset& preset = w.preset;
  fields.value({.name = "schema", .says = kSchema, .need = kMustSay, .words = {kSchema}}, w.schema);
  fields.value({.name = "name", .says = "Letters, digits, \".\", \"_\" and \"-\"", .need = kMustSay},
               preset.name);
  const bool is_plain =
      !preset.name.empty() && plain_name(preset.name) == preset.name && check_portable_path(preset.name);
  fields.require(is_plain, "name", "must have letters, digits, \".\", \"_\" and \"-\" alone");
  fields.value({"says", "For people, a sentence without a full stop"}, preset.says);
  fields.value(
      {.name = "normal", .says = "Which way y goes in its normals", .words = {"opengl", "directx", "both"}},
      preset.normal);
  fields.choice({"roughness", "What its roughness is"}, preset.roughness, kRoughnessConventionNames);
  fields.value(
      {"most_px", "Of the longer side; larger maps are averaged down to it; 0: as they are", {0, 1 << 20}},
      preset.most_px);
  fields.list({.name = "file", .says = "Each texture", .need = kMustSay}, w.files);
  fields.list({"document", "Each document of the textures"}, w.documents);
  fields.require(!w.files.empty(), "file", "must stand at least once, as [[file]]");
  fields.require(std::max(w.files.size(), w.documents.size()) <= kMostFiles, "file",
                 fmt::format("cannot be: there are over {}", kMostFiles));
}

// What no table tells by itself: a name that stands twice, and which way normals go.
class PresetParts {
 public:
  PresetParts(WrittenPreset written, std::string where)
      : written_(std::move(written)), where_(std::move(where)) {}

  Result<Preset> joined() {
    Preset& preset = written_.preset;
    for (std::size_t i = 0; i < written_.files.size(); ++i) {
      if (Result<void> ok = add(written_.files[i], fmt::format("file {}", i + 1)); !ok)
        return std::move(ok).error();
    }
    for (std::size_t i = 0; i < written_.documents.size(); ++i) {
      const PresetDocument& document = written_.documents[i].document;
      const std::string place = fmt::format("document {}", i + 1);
      if (Result<void> ok = add_name(document.name, place); !ok) return std::move(ok).error();
      if (preset.roughness != RoughnessConvention::kRoot && document.kind != DocumentKind::kLayers) {
        return unfit(place + ": kind",
                     "documents hold the root of alpha: the preset's roughness must be \"root\"");
      }
      preset.documents.push_back(document);
    }
    return std::move(preset);
  }

 private:
  Error unfit(const std::string& place, std::string why) const {
    return unusable_description(fmt::format("{}: {}", where_, place), kPage, std::move(why));
  }

  Result<void> add_name(const std::string& pattern, const std::string& place) {
    const std::string example = small_letters(named(pattern, "cloth"));
    if (names_.insert(example).second && example != "export.json") return {};
    return unfit(place + ": name",
                 fmt::format("\"{}\" stands twice, as many disks do not tell case", pattern));
  }

  Result<void> add(const WrittenFile& written, const std::string& place) {
    PresetFile file = written.file;
    if (Result<void> ok = add_name(file.name, place); !ok) return ok;
    const auto is_y = [](const std::string& each) { return each == "normal.y" || each == "detail.normal.y"; };
    const std::string direction = written.normal.value_or(written_.preset.normal);
    const bool has_direction = written.normal || std::ranges::any_of(file.channels, is_y);
    if (has_direction && direction == "both") {
      return unfit(place + ": normal",
                   "the preset has normals in both directions, and this file does not say which");
    }
    if (has_direction && direction == "directx") file.direction = NormalDirection::kDirectX;
    written_.preset.files.push_back(std::move(file));
    return {};
  }

  WrittenPreset written_;
  std::string where_;
  std::set<std::string> names_;
};

}  // namespace

const char* name_of(Encoding encoding) {
  return kEncodingNames[static_cast<std::size_t>(encoding)];
}

std::string words_of(const Stored& stored) {
  const std::string name = name_of(stored.encoding);
  if (stored.encoding == Encoding::kDds) return name + ", " + name_of(stored.blocks);
  if (stored.bits == 32) return name + ", float";
  if (stored.is_float()) return name + ", half";
  return fmt::format("{}, {} bits", name, stored.bits);
}

bool holds_its_files(DocumentKind kind) {
  return kind == DocumentKind::kGlb || kind == DocumentKind::kUsdz || kind == DocumentKind::kU3ma;
}

bool Preset::keeps_no_files() const {
  return !documents.empty() && std::ranges::all_of(documents, [](const PresetDocument& each) {
    return holds_its_files(each.kind);
  });
}

Result<Preset> preset_from_toml(std::string_view text, const std::string& where) {
  const Result<toml::table> table = parse_toml(text, where);
  if (!table) return table.error();
  Result<WrittenPreset> written = read_fields<WrittenPreset>(*table, where, kPage);
  if (!written) return std::move(written).error();
  return PresetParts(std::move(*written), where).joined();
}

std::string named(const std::string& pattern, const std::string& name) {
  constexpr std::string_view kHole = "{name}";
  std::string text = pattern;
  for (std::size_t at = text.find(kHole); at != std::string::npos; at = text.find(kHole, at + name.size()))
    text.replace(at, kHole.size(), name);
  return text;
}

}  // namespace weft::exchange
