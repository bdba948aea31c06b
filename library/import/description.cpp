// SPDX-License-Identifier: Apache-2.0
#include "library/import/description.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "core/base/files.h"
#include "core/toml/field_toml.h"
#include "core/toml/toml_json.h"
#include "library/catalogue/metadata.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 9> kMetadataKeys = {
    "id", "tags", "composition", "construction", "side", "kind", "notes", "weight_g_m2", "thickness_mm"};

Error refused(const fs::path& file, const std::string& key, std::string why) {
  return {ErrorKind::kBadData, "what is said of the photographs cannot be used",
          fmt::format("{}: {}", file.string(), key), std::move(why), "see docs/archives.md for its keys"};
}

struct NumberKey {
  const char* key;
  std::optional<double> ImportDescription::*value;
  bool may_be_zero;
};
constexpr std::array<NumberKey, 4> kNumbers = {
    {{"cloth_height_mm", &ImportDescription::cloth_height_mm, true},
     {"exposure_us", &ImportDescription::exposure_us, false},
     {"iso", &ImportDescription::iso, false},
     {"f_number", &ImportDescription::f_number, false}}};

Result<void> take_key(const fs::path& file, const std::string& key, const Json& value,
                      ImportDescription& said) {
  const auto* number =
      std::ranges::find(kNumbers, key, [](const NumberKey& n) { return std::string(n.key); });
  if (number != kNumbers.end()) {
    const double is = value.is_number() ? value.get<double>() : std::nan("");
    if (!std::isfinite(is) || std::abs(is) > 1e9) return refused(file, key, "must be a number");
    if (!number->may_be_zero && is <= 0) return refused(file, key, "must be above 0");
    said.*(number->value) = is;
    return {};
  }
  if (key == "fabric") {
    if (!value.is_string() || value.get<std::string>().size() > kLongestText)
      return refused(file, key, fmt::format("must be a text of at most {} bytes", kLongestText));
    said.fabric = value.get<std::string>();
    return {};
  }
  const std::string name = key == "barcode" ? "id" : key;
  if (std::ranges::find(kMetadataKeys, name) == kMetadataKeys.end()) {
    std::vector<std::string> known = {"fabric", "barcode"};
    for (const NumberKey& each : kNumbers) known.emplace_back(each.key);
    known.insert(known.end(), kMetadataKeys.begin(), kMetadataKeys.end());
    return refused(file, key.substr(0, 40), no_such_key(known, key));
  }
  if (Result<void> ok = check_new_metadata(Json{{name, value}}); !ok)
    return refused(file, key, ok.error().why);
  said.metadata[name] = value;
  return {};
}

Result<Json> document_of(const fs::path& file) {
  if (file.extension() == ".toml") {
    const Result<toml::table> table = read_toml(file);
    if (!table) return table.error();
    return weft::json_of(*table);
  }
  const Result<std::string> text = read_text(file);
  if (!text) return text.error();
  Json document = Json::parse(*text, nullptr, false);
  if (!document.is_object()) return refused(file, "", "it is no JSON object");
  return document;
}

}  // namespace

void ImportDescription::take(const ImportDescription& other) {
  if (!other.fabric.empty()) fabric = other.fabric;
  for (const NumberKey& number : kNumbers)
    if (other.*(number.value)) this->*(number.value) = other.*(number.value);
  for (const auto& [key, value] : other.metadata.items()) metadata[key] = value;
}

Result<ImportDescription> read_description(const fs::path& file) {
  const Result<Json> document = document_of(file);
  if (!document) return document.error();
  ImportDescription said;
  for (const auto& [key, value] : document->items())
    if (Result<void> ok = take_key(file, key, value, said); !ok) return std::move(ok).error();
  return said;
}

std::vector<fs::path> descriptions_of(const std::vector<fs::path>& files, const fs::path& root,
                                      const fs::path& folder, const std::string& session) {
  std::vector<fs::path> wanted;
  for (fs::path at = folder;; at = at.parent_path()) {
    wanted.insert(wanted.begin(), at / "import.toml");
    if (at == root || at == at.parent_path()) break;
  }
  const std::string name = folder.filename().string();
  wanted.push_back(folder.parent_path() / (name + ".json"));
  wanted.push_back(folder / (name + ".json"));
  if (session != name) wanted.push_back(folder / (session + ".json"));
  std::erase_if(wanted, [&](const fs::path& file) {
    // The folder above the one that was named is not looked into.
    return std::ranges::find(files, file) == files.end() &&
           !(file.parent_path() == root.parent_path() && is_there(file));
  });
  return wanted;
}

}  // namespace weft::library
