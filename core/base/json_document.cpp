// SPDX-License-Identifier: Apache-2.0
#include "core/base/json_document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "core/base/files.h"

namespace weft {
namespace {

// Lists in lists beyond this are no document of ours: copying or printing them would overflow the stack.
constexpr int kMostDepth = 64;

Error bad_document(const std::string& where, const std::string& why) {
  return {ErrorKind::kBadData, "document cannot be used", where, why,
          "restore the file from a copy, or make it again with the program that wrote it"};
}

// The beginning of a value as a message quotes it, cut between characters.
std::string beginning_of(const Json& value) {
  const std::string text = value.dump();
  std::size_t end = std::min<std::size_t>(text.size(), 40);
  while (end < text.size() && (text[end] & 0xc0) == 0x80) --end;
  return text.substr(0, end);
}

bool is_triple(const Json& list) {
  return list.is_array() && list.size() == 3 && std::ranges::all_of(list, [](const Json& v) {
           return v.is_number() && std::isfinite(v.get<double>());
         });
}

// The first, quoted, of a text that has one.
std::string key_said_twice(std::string_view text) {
  std::vector<std::set<std::string>> keys;  // of each object that is open
  std::string twice;
  const auto look = [&](int, Json::parse_event_t event, const Json& read) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    const bool is_again = event == Json::parse_event_t::key && !keys.back().insert(read).second;
    if (is_again && twice.empty()) twice = beginning_of(read);
    return true;
  };
  const Json read = Json::parse(text, look, /*allow_exceptions=*/false);
  return read.is_discarded() ? "" : twice;
}

}  // namespace

ParsedJson parse_json(std::string_view text) {
  ParsedJson parsed;
  std::vector<std::size_t> keys;  // said of each object that is open
  bool is_too_deep = false, is_twice = false;
  const auto look = [&](int depth, Json::parse_event_t event, const Json& read) {
    is_too_deep = is_too_deep || depth > kMostDepth;
    if (event == Json::parse_event_t::object_start) keys.push_back(0);
    if (event == Json::parse_event_t::key) ++keys.back();
    if (event != Json::parse_event_t::object_end || is_too_deep) return !is_too_deep;
    is_twice = is_twice || read.size() != keys.back();
    keys.pop_back();
    return true;
  };
  parsed.document = Json::parse(text, look, /*allow_exceptions=*/false);
  if (is_too_deep) {
    parsed.why = fmt::format("it is nested over {} deep", kMostDepth);
  } else if (parsed.document.is_discarded()) {
    parsed.why = "it is not valid JSON";
  } else if (is_twice) {
    parsed.why = fmt::format("it says {} twice", key_said_twice(text));
  }
  return parsed;
}

Result<Json> read_json(const std::filesystem::path& file, const std::string& name, int major) {
  Result<std::string> text = read_text(file);
  if (!text) return std::move(text).error();
  auto [document, why] = parse_json(*text);
  if (!why.empty()) return bad_document(file.string(), why);
  if (!document.is_object() || !document.contains("schema") || !document["schema"].is_string()) {
    return bad_document(file.string(),
                        fmt::format("it has no \"schema\"; \"{}/{}\" was expected", name, major));
  }
  const std::string schema = document["schema"].get<std::string>();
  const std::string prefix = name + '/';
  int version = -1;
  if (schema.starts_with(prefix)) {
    const char* begin = schema.data() + prefix.size();
    const char* end = schema.data() + schema.size();
    const auto [rest, failed] = std::from_chars(begin, end, version);
    if (failed != std::errc() || (rest != end && *rest != '.')) version = -1;
  }
  if (version < 1) {
    return bad_document(file.string(),
                        fmt::format("its schema is \"{}\"; \"{}/{}\" was expected", schema, name, major));
  }
  if (version > major) {
    return Error{ErrorKind::kBadData, "document is newer than this program", file.string(),
                 fmt::format("its schema is {}; this program reads {}/{}", schema, name, major),
                 fmt::format("use a version of weft that reads {}/{}", name, version)};
  }
  return document;
}

Result<void> write_json(const std::filesystem::path& file, const Json& document) {
  return write_file(file, document.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
}

const Json* JsonFields::find(const char* key, bool (*is_kind)(const Json&), const char* kind) {
  if (error_) return nullptr;
  if (!object_->is_object() || !object_->contains(key)) {
    error_ = bad_document(where_, fmt::format("\"{}\" is missing", key));
    return nullptr;
  }
  const Json& value = (*object_)[key];
  if (!is_kind(value)) {
    error_ =
        bad_document(where_, fmt::format("\"{}\" is {}; {} was expected", key, beginning_of(value), kind));
    return nullptr;
  }
  return &value;
}

std::string JsonFields::text(const char* key) {
  const Json* value = find(
      key, [](const Json& v) { return v.is_string(); }, "a text");
  return value ? value->get<std::string>() : std::string();
}

std::string JsonFields::text_or(const char* key, std::string fallback) {
  return has(key) ? text(key) : std::move(fallback);
}

double JsonFields::number(const char* key) {
  const Json* value = find(
      key, [](const Json& v) { return v.is_number() && std::isfinite(v.get<double>()); }, "a number");
  return value ? value->get<double>() : 0.0;
}

std::optional<double> JsonFields::optional_number(const char* key) {
  if (!has(key)) return std::nullopt;
  return number(key);
}

int JsonFields::integer(const char* key) {
  const auto fits = [](const Json& v) {
    return v.is_number_integer() && std::abs(v.get<double>()) <= std::numeric_limits<int>::max();
  };
  const Json* value = find(key, fits, "a whole number");
  return value ? value->get<int>() : 0;
}

bool JsonFields::flag(const char* key) {
  const Json* value = find(
      key, [](const Json& v) { return v.is_boolean(); }, "true or false");
  return value && value->get<bool>();
}

std::array<double, 3> JsonFields::rgb(const char* key) {
  const Json* value = find(key, is_triple, "a list of three numbers");
  return value ? value->get<std::array<double, 3>>() : std::array<double, 3>{};
}

Vec3 JsonFields::vec3(const char* key) {
  const std::array<double, 3> v = rgb(key);
  return {v[0], v[1], v[2]};
}

Mat3 JsonFields::mat3(const char* key) {
  const auto is_matrix = [](const Json& rows) {
    return rows.is_array() && rows.size() == 3 && std::ranges::all_of(rows, is_triple);
  };
  const Json* value = find(key, is_matrix, "a list of three rows of three numbers");
  return value ? value->get<Mat3>() : Mat3{};
}

std::size_t JsonFields::place_of(const char* key, std::span<const char* const> names) {
  const std::string name = text(key);
  const auto found = std::ranges::find(names, std::string_view(name));
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  const auto but_last = names.first(names.size() - 1);
  reject(key, fmt::format("is {}; {} or {} was expected", beginning_of(name), fmt::join(but_last, ", "),
                          names.back()));
  return 0;
}

const Json& JsonFields::list(const char* key) {
  static const Json empty = Json::array();
  const Json* value = find(
      key, [](const Json& v) { return v.is_array(); }, "a list");
  return value ? *value : empty;
}

const Json& JsonFields::object(const char* key) {
  static const Json empty = Json::object();
  const Json* value = find(
      key, [](const Json& v) { return v.is_object(); }, "an object");
  return value ? *value : empty;
}

bool JsonFields::has(const char* key) const {
  return object_->is_object() && object_->contains(key);
}

void JsonFields::reject(const char* key, const std::string& rule) {
  if (!error_) error_ = bad_document(where_, fmt::format("\"{}\" {}", key, rule));
}

Result<void> JsonFields::status() const {
  if (error_) return *error_;
  return {};
}

}  // namespace weft
