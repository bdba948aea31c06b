// SPDX-License-Identifier: Apache-2.0
#include "library/catalogue/metadata.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/text.h"
#include "core/rig/cloth_kinds.h"
#include "core/solve/solve.h"
#include "solve/session/current.h"
#include "solve/session/left_out_shots.h"
#include "solve/session/session_lock.h"

namespace weft::library {
namespace {

constexpr std::size_t kLongestName = 40;
constexpr double kMost = 1e5;  // grams per square metre, millimetres

// What the value of a field must be; empty where it is that.
using Rule = std::string (*)(const Json& value);

bool is_utf8(const Json& text) {
  try {
    (void)text.dump();
    return true;
  } catch (const Json::type_error&) {
    return false;
  }
}

std::string text_rule(const Json& value, std::size_t longest, bool may_have_lines) {
  if (!value.is_string()) return "must be a text";
  const std::string& text = value.get_ref<const std::string&>();
  if (text.size() > longest) return fmt::format("must be at most {} bytes long", longest);
  if (!is_utf8(value)) return "must be UTF-8";
  const bool has_control = std::ranges::any_of(text, [&](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && !(may_have_lines && c == '\n')) || c == 0x7f;
  });
  return has_control ? "must have no control characters" : "";
}

std::string line_rule(const Json& value) {
  return text_rule(value, kLongestText, false);
}
std::string notes_rule(const Json& value) {
  return text_rule(value, kLongestNotes, true);
}
std::string side_rule(const Json& value) {
  return value == "front" || value == "back" ? "" : "must be front or back";
}
std::string kind_rule(const Json& value) {
  const bool is_one =
      value.is_string() &&
      std::ranges::find(kClothKinds, value.get_ref<const std::string&>()) != kClothKinds.end();
  return is_one ? "" : fmt::format("must be one of {}", fmt::join(kClothKinds, ", "));
}
std::string amount_rule(const Json& value) {
  if (!value.is_number()) return "must be a number";
  const double amount = value.get<double>();
  return std::isfinite(amount) && amount >= 0 && amount <= kMost
             ? ""
             : fmt::format("must be a number from 0 to {}", kMost);
}
std::string tags_rule(const Json& value) {
  if (!value.is_array()) return "must be a list of texts";
  if (value.size() > kMostTags) return fmt::format("must be at most {} tags", kMostTags);
  for (const Json& tag : value) {
    if (const std::string broken = line_rule(tag); !broken.empty()) return "each " + broken;
    if (tag == "") return "must have no empty tag";
  }
  return "";
}

struct Field {
  const char* key;
  Rule rule;
};
constexpr std::array<Field, 9> kFields = {{{"id", line_rule},
                                           {"tags", tags_rule},
                                           {"composition", line_rule},
                                           {"construction", line_rule},
                                           {"side", side_rule},
                                           {"kind", kind_rule},
                                           {"notes", notes_rule},
                                           {"weight_g_m2", amount_rule},
                                           {"thickness_mm", amount_rule}}};

std::vector<std::string> tags_of(const Json& list) {
  auto tags = list.get<std::vector<std::string>>();
  std::ranges::sort(tags);
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  return tags;
}

std::string id_rule(const Json& value) {
  const bool is_id = value.is_string() && value.get_ref<const std::string&>().size() == 16 &&
                     std::ranges::all_of(value.get_ref<const std::string&>(), [](char c) {
                       return ('0' <= c && c <= '9') || ('a' <= c && c <= 'f');
                     });
  return is_id ? "" : "must be the id of a solve";
}

std::string left_out_rule(const Json& value) {
  const bool is_list = value.is_array() && value.size() <= solve::kMostLeftOut;
  const bool has_indices = is_list && std::ranges::all_of(value, [](const Json& shot) {
                             return shot.is_number_integer() && shot >= 0 && shot < 1'000'000;
                           });
  return has_indices ? "" : fmt::format("must be a list of at most {} indices of shots", solve::kMostLeftOut);
}

Error refused(const std::string& key, const std::string& rule) {
  std::string known = "fabric, current_solve, left_out";
  for (const Field& field : kFields) known += fmt::format(", {}", field.key);
  return {ErrorKind::kUsage, "metadata cannot be set", key, rule, "set one of " + known};
}

// Fields of session.json itself.
bool is_of_session(std::string_view key) {
  return key == "fabric" || key == "current_solve" || key == "left_out";
}

// Null where there is no such field.
Rule rule_of(std::string_view key) {
  if (key == "fabric") return line_rule;
  if (key == "current_solve") return id_rule;
  if (key == "left_out") return left_out_rule;
  const auto* known = std::ranges::find(kFields, key, &Field::key);
  return known == kFields.end() ? nullptr : known->rule;
}

Result<void> check_fields(const Json& fields) {
  if (!fields.is_object() || fields.empty()) return refused("", "no field is named");
  for (const auto& [key, value] : fields.items()) {
    const Rule rule = rule_of(key);
    if (rule == nullptr) return refused(key.substr(0, 40), "there is no such field");
    if (value.is_null()) continue;
    if (const std::string broken = rule(value); !broken.empty()) return refused(key, broken);
  }
  return {};
}

// What the fields name must be there.
Result<void> check_names(const Session& session, const Json& fields) {
  if (const auto solve = fields.find("current_solve"); solve != fields.end() && solve->is_string()) {
    if (const Result<Product> found = find_solve(session.folder, solve->get<std::string>()); !found)
      return found.error();
  }
  const auto shots = fields.find("left_out");
  if (shots == fields.end() || !shots->is_array()) return {};
  for (const Json& shot : *shots) {
    if (std::ranges::find(session.shots, shot.get<int>(), &Shot::index) == session.shots.end()) {
      return Error{ErrorKind::kNoInput, "there is no such shot", fmt::format("left_out: {}", shot.dump()),
                   fmt::format("{} has {} shots", session.folder.string(), session.shots.size()),
                   "name shots by their index, from 0"};
    }
  }
  return {};
}

// Lists are sorted, each entry once; a list of no shots is none.
Json in_order(const std::string& key, const Json& value) {
  if (!value.is_array()) return value;
  if (key == "tags") return tags_of(value);
  auto shots = value.get<std::vector<int>>();
  std::ranges::sort(shots);
  shots.erase(std::unique(shots.begin(), shots.end()), shots.end());
  return shots.empty() ? Json() : Json(shots);
}

// A choice of a solve is for the photographs of its moment. Whether that is another one now.
bool note_choice(Session& session) {
  Json& document = session.document;
  const bool is_one = document.contains("current_solve");
  const Json now = is_one ? Json(solve::digest_of_photographs(session)) : Json();
  if (document.value("current_solve_for", Json()) == now) return false;
  if (is_one) {
    document["current_solve_for"] = now;
  } else {
    document.erase("current_solve_for");
  }
  return true;
}

// The revision in a session's document; 0 where it holds none, or none that counts.
int revision_of(const Json& session) {
  const Json metadata = session.value("metadata", Json());
  const Json revision = metadata.is_object() ? metadata.value("revision", Json()) : Json();
  const bool counts = revision.is_number_integer() && revision >= 0 && revision < 1'000'000'000;
  return counts ? revision.get<int>() : 0;
}

}  // namespace

Result<Metadata> metadata_from_json(const Json& document, const std::string& where) {
  const auto wrong = [&](const char* key, const std::string& rule) {
    return Error{ErrorKind::kBadData, "metadata cannot be used", fmt::format("{}: {}", where, key), rule,
                 "set the field again with weft library tag"};
  };
  if (!document.is_object()) return wrong("metadata", "must be an object");
  for (const Field& field : kFields) {
    if (!document.contains(field.key)) continue;
    if (const std::string broken = field.rule(document[field.key]); !broken.empty())
      return wrong(field.key, broken);
  }
  Metadata metadata;
  metadata.revision = revision_of({{"metadata", document}});
  metadata.id = document.value("id", "");
  if (document.contains("tags")) metadata.tags = tags_of(document["tags"]);
  metadata.composition = document.value("composition", "");
  metadata.construction = document.value("construction", "");
  metadata.side = document.value("side", "");
  metadata.kind = document.value("kind", "");
  metadata.notes = document.value("notes", "");
  metadata.weight_g_m2 = document.value("weight_g_m2", 0.0);
  metadata.thickness_mm = document.value("thickness_mm", 0.0);
  return metadata;
}

Result<void> check_new_metadata(const Json& metadata) {
  if (!metadata.is_object() || metadata.size() > kMostTags)
    return refused("metadata", fmt::format("must be an object of at most {} fields", kMostTags));
  for (const auto& [key, value] : metadata.items()) {
    if (key == "revision" || is_of_session(key)) return refused(key, "is set by weft alone");
    const bool is_name = key.size() <= kLongestName && !key.empty() && plain_name(key) == key;
    if (!is_name) return refused(plain_name(key.substr(0, kLongestName)), "must be a plain name");
    const bool is_plain = value.is_number() || value.is_boolean();
    const Rule rule = rule_of(key);
    const std::string broken = rule != nullptr ? rule(value) : is_plain ? "" : line_rule(value);
    if (!broken.empty()) return refused(key, broken);
  }
  return {};
}

Result<Metadata> metadata_of(const Session& session) {
  const auto found = session.document.find("metadata");
  if (found == session.document.end()) return Metadata();
  return metadata_from_json(*found, (session.folder / "session.json").string());
}

Json json_of(const Metadata& m) {
  const auto amount = [](double value) { return value > 0 ? Json(value) : Json(); };
  return {{"id", m.id},
          {"tags", m.tags},
          {"composition", m.composition},
          {"construction", m.construction},
          {"side", m.side},
          {"kind", m.kind},
          {"notes", m.notes},
          {"weight_g_m2", amount(m.weight_g_m2)},
          {"thickness_mm", amount(m.thickness_mm)},
          {"revision", m.revision}};
}

Result<MetadataChange> change_metadata(const std::filesystem::path& folder, const Json& fields,
                                       const Provided& provided) {
  if (Result<void> ok = check_fields(fields); !ok) return std::move(ok).error();
  const Result<Descriptor> lock = solve::lock_session(folder);
  if (!lock) return lock.error();
  Result<Session> session = read_session(folder);
  if (!session) return std::move(session).error();
  const int revision = revision_of(session->document);
  if (Result<void> ok = check_names(*session, fields); !ok) return std::move(ok).error();

  Json& document = session->document;
  document["fabric"] = session->fabric;
  if (!document.contains("metadata") || !document["metadata"].is_object())
    document["metadata"] = Json::object();
  const auto holder_of = [&](const std::string& key) -> Json& {
    return is_of_session(key) ? document : document["metadata"];
  };
  const auto changed_meanwhile = [&](const std::string& why) {
    return Error{ErrorKind::kTryAgain, "session was changed meanwhile", folder.string(), why,
                 "read it again, then repeat the change"};
  };
  if (provided.revision && *provided.revision != revision) {
    return changed_meanwhile(
        fmt::format("the revision of its metadata is {}, not {}", revision, *provided.revision));
  }
  for (const auto& [key, value] : provided.values.items()) {
    if (holder_of(key).value(key, Json()) != value) return changed_meanwhile(key + " is another");
  }

  MetadataChange change = {folder, Json::object(), Json::object(), revision};
  for (const auto& [key, value] : fields.items()) {
    Json& holder = holder_of(key);
    Json before = holder.value(key, Json());
    const Json after = in_order(key, value);
    if (before == after) continue;
    if (after.is_null()) {
      holder.erase(key);
    } else {
      holder[key] = after;
    }
    change.before[key] = std::move(before);
    change.after[key] = after;
  }
  if (fields.contains("current_solve") && note_choice(*session) && !change.after.contains("current_solve"))
    change.before["current_solve"] = change.after["current_solve"] = fields["current_solve"];
  if (change.after.empty()) return change;
  session->fabric = document.value("fabric", "");
  document["metadata"]["revision"] = change.revision = revision + 1;
  if (Result<void> ok = write_session(*session); !ok) return std::move(ok).error();
  return change;
}

std::string words_of(const MetadataChange& change) {
  std::string words;
  for (const auto& [key, value] : change.after.items()) {
    std::string said = value.is_string() ? value.get<std::string>() : value.is_null() ? "none" : value.dump();
    if (value.is_array()) {
      said = value.empty() ? "none" : "";
      for (const Json& each : value)
        said += (said.empty() ? "" : ", ") + (each.is_string() ? each.get<std::string>() : each.dump());
    }
    words += fmt::format("{}{}: {}", words.empty() ? "" : "; ", key, said);
  }
  return fmt::format("{} of {}", words.empty() ? "nothing" : words, change.folder.stem().string());
}

}  // namespace weft::library
