// SPDX-License-Identifier: Apache-2.0
#include "exchange/presets/preset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <set>
#include <span>
#include <utility>

#include "core/text.h"
#include "core/toml/toml_keys.h"
#include "exchange/document.h"

namespace weft::exchange {
namespace {

constexpr const char* kPage = "docs/exports.md";
constexpr const char* kSchema = "weft.preset/1";
constexpr std::size_t kMostFiles = 64;

// Reads the tables of one preset; the first thing that is wrong is remembered, with its file and key.
class PresetReader {
 public:
  PresetReader(const toml::table& table, std::string where) : table_(&table), where_(std::move(where)) {}

  Result<Preset> read();

 private:
  std::size_t word(TomlKeys& keys, const char* key, const std::string& value,
                   std::span<const char* const> words);
  Stored stored(TomlKeys& keys);
  void channels(TomlKeys& keys, PresetFile& file);
  void name(TomlKeys& keys, const std::string& pattern, const std::vector<std::string>& endings);
  PresetFile file(TomlKeys& keys);
  PresetDocument document(TomlKeys& keys);
  void several(const char* key, const std::function<void(TomlKeys&)>& read_one);
  void keep(const TomlKeys& keys) {
    if (Result<void> status = keys.status(); !status && !error_) error_ = status.error();
  }

  const toml::table* table_;
  std::string where_;
  Preset preset_;
  std::set<std::string> names_;
  std::optional<Error> error_;
};

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::size_t PresetReader::word(TomlKeys& keys, const char* key, const std::string& value,
                               std::span<const char* const> words) {
  const auto found = std::ranges::find(words, value, [](const char* each) { return std::string(each); });
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  const auto far = [&](const char* each) { return edit_distance(value, each); };
  keys.reject(key, fmt::format("\"{}\" is none of {}; the nearest is {}", value, fmt::join(words, ", "),
                               *std::ranges::min_element(words, {}, far)));
  return 0;
}

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

Stored PresetReader::stored(TomlKeys& keys) {
  Stored stored;
  stored.encoding =
      static_cast<Encoding>(word(keys, "encoding", keys.text_or("encoding", "png"), kEncodingNames));
  const std::vector<int> bits = bits_of(stored.encoding);
  stored.bits = keys.integer_or("bits", bits.front(), 8, 32);
  if (std::ranges::find(bits, stored.bits) == bits.end())
    keys.reject("bits", fmt::format("{} holds {} bits", name_of(stored.encoding), fmt::join(bits, " or ")));
  stored.color =
      static_cast<ColorSpace>(word(keys, "color", keys.text_or("color", "data"), kColorSpaceNames));
  stored.is_prman = keys.flag_or("prman", false);
  if (stored.is_prman && stored.encoding != Encoding::kTx) keys.reject("prman", "only a tx has it");
  const std::string blocks = keys.text_or("blocks", "");
  if ((stored.encoding == Encoding::kDds) != !blocks.empty()) {
    keys.reject("blocks",
                blocks.empty() ? "a dds has blocks: bc1, bc3, bc4, bc5 or bc7" : "only a dds has blocks");
  } else if (!blocks.empty()) {
    if (const std::optional<BlockFormat> format = block_format_named(blocks)) {
      stored.blocks = *format;
    } else {
      keys.reject("blocks", fmt::format("\"{}\" is none of bc1, bc3, bc4, bc5, bc7", blocks));
    }
  }
  return stored;
}

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

void PresetReader::channels(TomlKeys& keys, PresetFile& file) {
  file.channels = keys.texts_or("channels", {});
  const std::vector<std::size_t> counts = counts_of(file.stored);
  if (std::ranges::find(counts, file.channels.size()) == counts.end()) {
    keys.reject("channels", fmt::format("{} are named where {} holds {}", file.channels.size(),
                                        words_of(file.stored), fmt::join(counts, " or ")));
  }
  bool has_y = false;
  for (const std::string& each : file.channels) {
    if (channel_named(each) == nullptr) {
      keys.reject("channels",
                  fmt::format("there is no channel {}; the nearest is {}", each, nearest_channel(each)));
    }
    has_y = has_y || each == "normal.y" || each == "detail.normal.y";
  }
  const std::string otherwise = preset_.normal == "both" ? "" : preset_.normal;
  const std::string direction = keys.text_or("normal", otherwise);
  if (!has_y && !keys.has("normal")) return;
  if (direction.empty()) {
    keys.reject("normal", "the preset has normals in both directions, and this file does not say which");
    return;
  }
  file.direction = static_cast<NormalDirection>(word(keys, "normal", direction, kNormalDirectionNames));
}

void PresetReader::name(TomlKeys& keys, const std::string& pattern, const std::vector<std::string>& endings) {
  const auto ends = [&](const std::string& ending) { return pattern.ends_with(ending); };
  if (std::ranges::none_of(endings, ends)) {
    keys.reject("name", fmt::format("\"{}\" does not end in {}", pattern, fmt::join(endings, " or ")));
    return;
  }
  const std::string example = named(pattern, "cloth");
  if (example.find_first_of("{}") != std::string::npos) {
    keys.reject("name", fmt::format("\"{}\" has braces other than those of {{name}}", pattern));
  } else if (const Result<void> portable = check_portable_path(example); !portable) {
    keys.reject("name", fmt::format("\"{}\": {}", pattern, portable.error().why));
  } else if (!names_.insert(lower(example)).second || lower(example) == "export.json") {
    keys.reject("name", fmt::format("\"{}\" stands twice, as many disks do not tell case", pattern));
  }
}

PresetFile PresetReader::file(TomlKeys& keys) {
  keys.know({"name", "channels", "encoding", "bits", "blocks", "color", "normal", "prman", "optional"});
  PresetFile file;
  file.stored = stored(keys);
  file.name = keys.text_or("name", "");
  name(keys, file.name, endings_of(file.stored.encoding));
  channels(keys, file);
  file.is_optional = keys.flag_or("optional", false);
  return file;
}

PresetDocument PresetReader::document(TomlKeys& keys) {
  keys.know({"name", "kind", "optional"});
  PresetDocument document;
  document.kind = static_cast<DocumentKind>(word(keys, "kind", keys.text_or("kind", ""), kDocumentKindNames));
  document.name = keys.text_or("name", "");
  const bool is_json = document.kind == DocumentKind::kLayers;
  const std::string ending = is_json ? "json" : kDocumentKindNames[static_cast<std::size_t>(document.kind)];
  name(keys, document.name, {"." + ending});
  document.is_optional = keys.flag_or("optional", false);
  if (preset_.roughness != RoughnessConvention::kRoot && !is_json)
    keys.reject("kind", "documents hold the root of alpha: the preset's roughness must be \"root\"");
  return document;
}

void PresetReader::several(const char* key, const std::function<void(TomlKeys&)>& read_one) {
  TomlKeys all(*table_, where_, kPage);
  if (!all.has(key)) return;
  const std::vector<const toml::table*> tables = all.tables(key);
  if (tables.size() > kMostFiles) all.reject(key, fmt::format("there are over {}", kMostFiles));
  keep(all);
  for (std::size_t i = 0; i < tables.size(); ++i) {
    TomlKeys keys(*tables[i], fmt::format("{}: {} {}", where_, key, i + 1), kPage);
    read_one(keys);
    keep(keys);
  }
}

Result<Preset> PresetReader::read() {
  TomlKeys keys(*table_, where_, kPage);
  keys.know({"schema", "name", "says", "normal", "roughness", "most_px", "file", "document"});
  const std::string schema = keys.text_or("schema", "");
  if (schema != kSchema) keys.reject("schema", fmt::format("\"{}\" is not {}", schema, kSchema));
  preset_.name = keys.text_or("name", "");
  if (preset_.name.empty() || plain_name(preset_.name) != preset_.name || !check_portable_path(preset_.name))
    keys.reject("name", "a preset's name has letters, digits, \".\", \"_\" and \"-\" alone");
  preset_.says = keys.text_or("says", "");
  constexpr std::array<const char*, 3> kNormals = {"opengl", "directx", "both"};
  preset_.normal = kNormals[word(keys, "normal", keys.text_or("normal", "opengl"), kNormals)];
  preset_.roughness = static_cast<RoughnessConvention>(
      word(keys, "roughness", keys.text_or("roughness", "root"), kRoughnessConventionNames));
  preset_.most_px = keys.integer_or("most_px", 0, 0, 1 << 20);
  keep(keys);
  several("file", [&](TomlKeys& each) { preset_.files.push_back(file(each)); });
  several("document", [&](TomlKeys& each) { preset_.documents.push_back(document(each)); });
  if (preset_.files.empty()) keys.reject("file", "there is no [[file]]");
  keep(keys);
  if (error_) return *error_;
  return std::move(preset_);
}

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
  return PresetReader(*table, where).read();
}

std::string named(const std::string& pattern, const std::string& name) {
  constexpr std::string_view kHole = "{name}";
  std::string text = pattern;
  for (std::size_t at = text.find(kHole); at != std::string::npos; at = text.find(kHole, at + name.size()))
    text.replace(at, kHole.size(), name);
  return text;
}

}  // namespace weft::exchange
