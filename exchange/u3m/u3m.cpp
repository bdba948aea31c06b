// SPDX-License-Identifier: Apache-2.0
#include "exchange/u3m/u3m.h"

#include <algorithm>
#include <cmath>

#include "core/base/iso_time.h"
#include "core/base/json_document.h"
#include "exchange/u3m/u3m_front.h"
#include "exchange/u3m/vocabulary.h"

namespace weft::exchange {

namespace {

Error bad_u3m(const std::string& where, const std::string& why, const std::string& remedy) {
  return {ErrorKind::kBadData, "the U3M document cannot be written", where, why, remedy};
}

bool is_sha256(std::string_view text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool is_utf8_text(const std::string& text) {
  std::string flat = text;
  std::ranges::replace(flat, '\n', ' ');
  return is_plain_text(flat);
}

Result<std::string> utc_of(const char* where, const std::string& time) {
  const auto seconds = seconds_of_iso_time(time);
  if (!seconds || *seconds < 0) {
    return bad_u3m(where, "'" + time + "' is no time like 2026-11-21T14:25:01Z", "give one of the session");
  }
  return iso_time(*seconds);
}

Result<void> check_options(const TexturedMaterial& material, const U3mOptions& options) {
  if (!material.size_mm) {
    return bad_u3m("size_mm", "U3M is in millimetres, and the size of the cloth is not known",
                   "scan with a calibrated rig, or choose a format without sizes");
  }
  if (!is_sha256(options.digest)) {
    return bad_u3m("digest", "it is no SHA-256 of 64 hexadecimal digits",
                   "hash what the document is made of");
  }
  if (!is_utf8_text(options.description)) {
    return bad_u3m("description", "it is no UTF-8, or has control characters", "correct the notes");
  }
  const auto is_amount = [](const std::optional<double>& amount) {
    return !amount || (std::isfinite(*amount) && *amount >= 0);
  };
  if (!is_amount(options.physics.thickness_mm)) {
    return bad_u3m("thickness_mm", "it is below 0 or no number", "correct the metadata");
  }
  if (!is_amount(options.physics.weight_g_m2)) {
    return bad_u3m("weight_g_m2", "it is below 0 or no number", "correct the metadata");
  }
  double sum = 0;
  for (const FibrePart& part : options.physics.composition) {
    const bool is_share = std::isfinite(part.share) && part.share >= 0 && part.share <= 1;
    if (!is_share || !is_plain_text(part.fibre)) {
      return bad_u3m("composition", "the share of '" + part.fibre + "' is not within 0 and 1",
                     "correct the metadata");
    }
    sum += part.share;
  }
  if (!options.physics.composition.empty() && std::abs(sum - 1) > 1e-6) {
    return bad_u3m("composition", "its shares have the sum " + number_text(sum), "correct the metadata");
  }
  if (!is_plain_text(options.physics.construction)) {
    return bad_u3m("construction", "it is no UTF-8, or has control characters", "correct the metadata");
  }
  return {};
}

/// A word of a closed list, or "other" with the words themselves.
Json typed(const std::optional<std::string>& word, const std::string& words) {
  if (word) return {{"type", *word}, {"name", nullptr}};
  return {{"type", "other"}, {"name", words}};
}

Json physics_of(const U3mPhysics& physics) {
  const auto amount = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  Json document = {{"thickness", amount(physics.thickness_mm)},
                   {"weight", amount(physics.weight_g_m2)},
                   {"composition", nullptr},
                   {"devices", {{"fab", "null"}}},  // the schema's word for none
                   {"material_type", nullptr},
                   {"construction", nullptr}};
  if (!physics.composition.empty()) {
    Json parts = Json::array();
    for (const FibrePart& part : physics.composition) {
      Json entry = typed(u3m_fibre(part.fibre), part.fibre);
      parts.push_back({{"ratio", part.share}, {"type", entry["type"]}, {"name", entry["name"]}});
    }
    document["composition"] = {{"parts", parts}};
  }
  if (!physics.construction.empty()) {
    const auto word = u3m_construction(physics.construction);
    document["construction"] = typed(word, physics.construction);
    const std::string type(word ? u3m_material_type_of(*word) : "");
    if (!type.empty()) document["material_type"] = typed(type, type);
  }
  return document;
}

bool is_known(const U3mPhysics& physics) {
  return physics.thickness_mm || physics.weight_g_m2 || !physics.composition.empty() ||
         !physics.construction.empty();
}

}  // namespace

std::string uuid_of(std::string_view sha256) {
  std::string digits(sha256.substr(0, 32));
  digits.resize(32, '0');
  digits[12] = '4';
  const std::size_t nibble = std::string_view("0123456789abcdef").find(digits[16]);
  digits[16] = "89ab"[nibble % 4];
  for (const std::size_t at : {20u, 16u, 12u, 8u}) digits.insert(at, 1, '-');
  return digits;
}

Result<Document> u3m_of(const TexturedMaterial& material, const U3mOptions& options) {
  if (auto checked = check_material(material); !checked) return checked.error();
  if (auto checked = check_options(material, options); !checked) return checked.error();
  const auto created = utc_of("created", options.created);
  if (!created) return created.error();
  const auto modified = utc_of("modified", options.modified);
  if (!modified) return modified.error();
  Document document;
  const auto front = u3m_front_of(material, document);
  if (!front) return front.error();

  Json provenance = Json::object();
  for (const auto& [key, value] : material.provenance) provenance[key] = value;
  Json asset = {{"id", uuid_of(options.digest)},
                {"name", material.name},
                {"description", options.description},
                {"created", *created},
                {"modified", *modified},
                {"front", *front},
                {"back", nullptr},
                {"side", nullptr},
                {"physics", is_known(options.physics) ? physics_of(options.physics) : Json()},
                {"metadata", nullptr}};
  const Json root = {{"schema", "1.1"},
                     {"material", asset},
                     {"custom", {{"weft", {{"size_mm", *material.size_mm}, {"provenance", provenance}}}}}};
  document.bytes = root.dump(1) + "\n";
  return document;
}

}  // namespace weft::exchange
