// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/base/vec.h"

namespace weft {

/// JSON with its keys in the order they were written, so that files read as they were meant.
using Json = nlohmann::ordered_json;

/// Why a text is not read as JSON: "it says \"leds\" twice". Empty: it is read.
struct ParsedJson {
  Json document;
  std::string why;
};
/// Lists in lists to 64 deep, and each key of an object once.
ParsedJson parse_json(std::string_view text);

/// Reads a document whose "schema" is `name`/`major` or `name`/`major`.minor. A newer major version is
/// refused with a sentence that names the version needed; a newer minor version is read and its fields are
/// kept.
Result<Json> read_json(const std::filesystem::path& file, const std::string& name, int major);

/// Writes a document aside, synced and renamed, indented for people.
Result<void> write_json(const std::filesystem::path& file, const Json& document);

/// Typed access to the fields of one JSON object. The first field that is missing or of the wrong kind is
/// remembered with its path; every later read then returns a default, so a reader is a plain list of fields
/// that ends with `status()`.
class JsonFields {
 public:
  JsonFields(const Json& object, std::string where) : object_(&object), where_(std::move(where)) {}

  std::string text(const char* key);
  double number(const char* key);  ///< finite
  int integer(const char* key);
  bool flag(const char* key);
  Vec3 vec3(const char* key);
  std::array<double, 3> rgb(const char* key);
  Mat3 mat3(const char* key);  ///< a list of its rows
  std::optional<double> optional_number(const char* key);
  std::string text_or(const char* key, std::string fallback);
  /// The list under `key`, or an empty one once something is wrong.
  const Json& list(const char* key);
  const Json& object(const char* key);
  bool has(const char* key) const;
  /// The value of an enum by its name; `names` has one a value, in their order.
  template <typename Enum, std::size_t N>
  Enum one_of(const char* key, const std::array<const char*, N>& names) {
    return static_cast<Enum>(place_of(key, names));
  }
  std::size_t place_of(const char* key, std::span<const char* const> names);

  /// Remembers that the value of `key` breaks a rule: "must be above 0".
  void reject(const char* key, const std::string& rule);
  const std::string& where() const { return where_; }
  Result<void> status() const;

 private:
  const Json* find(const char* key, bool (*is_kind)(const Json&), const char* kind);

  const Json* object_;
  std::string where_;
  std::optional<Error> error_;
};

}  // namespace weft
