// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/image/color_spaces.h"
#include "core/image/image.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_key.h"
#include "simulator/spectra/spectrum.h"

// Reads and checks scenes, one table at a time. Internal to simulator/scene.

namespace weft::simulator {

/// Reads a picture that a scene names. Without one, scenes keep the names of their pictures alone.
using ReadPicture = std::function<Result<Image<float>>(const std::filesystem::path&)>;

/// parse_scene of scene.h, with the pictures.
Result<Scene> parse_scene_and_pictures(std::string_view toml, const std::string& where,
                                       const ReadPicture& read_picture);

/// What all readers of one scene share.
struct SceneSource {
  std::string where;
  std::filesystem::path folder;  ///< names of files are relative to it
  ReadPicture read_picture;
  std::optional<Error> error;  ///< the first one
};

/// Reads one table over the values that are there and checks what results. Without a table it only checks.
class SceneReader {
 public:
  SceneReader(const toml::table* table, std::string path, SceneSource& source)
      : table_(table), path_(std::move(path)), source_(&source) {}

  void number(const SceneKey& key, double& value, Range allowed);
  template <typename Integer>
  void integer(const SceneKey& key, Integer& value, std::int64_t least, std::int64_t most);
  void flag(const SceneKey& key, bool& value);
  void text(const SceneKey& key, std::string& value);
  template <typename Value>
  void choice(const SceneKey& key, Value& value, const std::type_identity_t<Names<Value>>& names);
  /// A choice on which it depends what other keys there are.
  template <typename Value>
  void kind(const SceneKey& key, Value& value, const std::type_identity_t<Names<Value>>& names) {
    choice(key, value, names);
  }
  /// A colour: three numbers, or one for grey.
  void rgb(const SceneKey& key, Rgb& value, Range allowed);
  void vec3(const SceneKey& key, Vec3& value, Range allowed);
  /// As many numbers as there are, in brackets.
  void numbers(const SceneKey& key, std::span<double> values, Range allowed);
  /// One or more numbers in brackets.
  void numbers(const SceneKey& key, std::vector<double>& values, Range allowed);
  /// The name of a file, made absolute.
  void file(const SceneKey& key, std::string& value);
  void picture(const SceneKey& key, std::string& file_name, std::shared_ptr<const Image<float>>& image);
  /// The name of a table of 36 lines, or 36 numbers in brackets.
  void spectrum(const SceneKey& key, Spectrum& value);
  /// As many spectra as there are, in brackets.
  void spectra(const SceneKey& key, std::span<Spectrum> values);
  /// The name of a folder, or a list of spectra.
  void chart(const SceneKey& key, std::vector<Spectrum>& patches, int count);

  void integer(const SceneKey& key, std::optional<int>& value, std::int64_t least, std::int64_t most) {
    optional(key.name, value, [&](int& v) { integer(key, v, least, most); });
  }
  void number(const SceneKey& key, std::optional<double>& value, Range allowed) {
    optional(key.name, value, [&](double& v) { number(key, v, allowed); });
  }
  void rgb(const SceneKey& key, std::optional<Rgb>& value, Range allowed) {
    optional(key.name, value, [&](Rgb& v) { rgb(key, v, allowed); });
  }
  void vec3(const SceneKey& key, std::optional<Vec3>& value, Range allowed) {
    optional(key.name, value, [&](Vec3& v) { vec3(key, v, allowed); });
  }
  void spectrum(const SceneKey& key, std::optional<Spectrum>& value) {
    optional(key.name, value, [&](Spectrum& v) { spectrum(key, v); });
  }
  void text(const SceneKey& key, std::optional<std::string>& value) {
    optional(key.name, value, [&](std::string& v) { text(key, v); });
  }
  void file(const SceneKey& key, std::optional<std::string>& value) {
    optional(key.name, value, [&](std::string& v) { file(key, v); });
  }
  template <typename Value>
  void choice(const SceneKey& key, std::optional<Value>& value,
              const std::type_identity_t<Names<Value>>& names) {
    optional(key.name, value, [&](Value& v) { choice(key, v, names); });
  }

  template <typename Settings>
  void section(const char* key, const char* says, Settings& settings);
  template <typename Settings>
  void optional_section(const char* key, const char* says, Settings& settings) {
    section(key, says, settings);
  }
  /// The tables of the file follow those that are there.
  template <typename Settings>
  void list(const char* key, const char* says, std::vector<Settings>& settings);
  /// `effects = "auto"` with its `to`.
  void automatic(const SceneKey& key, const SceneKey& to, std::optional<double>& sigma, Range allowed);
  /// A section of flags, or the names of those that are true.
  void flags(const char* key, const char* says, EffectSettings& effects);

  void require(bool holds, const char* key, const std::string& rule) {
    if (!holds) refuse(key, rule, "change it");
  }
  template <typename Value>
  void require(const Result<Value>& checked, const char* key) {
    if (checked) return;
    const Error& e = checked.error();
    refuse(key, fmt::format("{}: {}: {}", e.what, e.where, e.why), e.remedy, e.kind);
  }

  /// Refuses the first key of the file that nobody asked for.
  void refuse_unknown_keys();

 private:
  static constexpr const char* kRemedy = "choose a value inside";

  const toml::node* find(const char* key);
  std::string numbered(const char* key, std::size_t i) const {
    return fmt::format("{}{}[{}]", path_, key, i + 1);
  }
  template <typename Settings>
  void read_table(const toml::table* table, const std::string& path, Settings& settings);
  template <typename Value, typename Read>
  void optional(const char* key, std::optional<Value>& value, const Read& read) {
    if (find(key) == nullptr && !value) return;
    if (!value) value.emplace();
    read(*value);
  }
  std::string absolute(const std::string& name) const;
  bool spectrum_in(const char* key, const toml::node& node, Spectrum& value);
  void check(const char* key, double value, Range allowed);
  void check(const char* key, const Spectrum& value);
  void refuse_type(const char* key, const std::string& expected);
  void refuse(const char* key, std::string why, std::string remedy, ErrorKind kind = ErrorKind::kBadData);
  void fail(Error error) {
    if (!source_->error) source_->error = std::move(error);
  }

  const toml::table* table_;
  std::string path_;
  SceneSource* source_;
  std::vector<std::string> known_;
};

template <typename Integer>
void SceneReader::integer(const SceneKey& key, Integer& value, std::int64_t least, std::int64_t most) {
  std::int64_t number = value;
  if (const toml::node* node = find(key.name)) {
    const std::optional<std::int64_t> integer = node->value_exact<std::int64_t>();
    if (!integer) refuse_type(key.name, "a whole number");
    number = integer.value_or(number);
  }
  if (number < least || number > most) {
    refuse(key.name, fmt::format("{} is not between {} and {}", number, least, most), kRemedy);
  } else {
    value = static_cast<Integer>(number);
  }
}

template <typename Value>
void SceneReader::choice(const SceneKey& key, Value& value, const std::type_identity_t<Names<Value>>& names) {
  std::string name;
  if (find(key.name) == nullptr) return;
  text(key, name);
  const auto named = std::find_if(names.begin(), names.end(), [&](const auto& n) { return name == n.first; });
  if (named != names.end()) {
    value = named->second;
    return;
  }
  std::string known;
  for (const auto& n : names) known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", n.first);
  refuse(key.name, fmt::format("\"{}\" is not one of {}", name, known), "choose one of them");
}

template <typename Settings>
void SceneReader::section(const char* key, const char* /*says*/, Settings& settings) {
  const toml::node* node = find(key);
  const toml::table* table = node == nullptr ? nullptr : node->as_table();
  if (node != nullptr && table == nullptr) refuse_type(key, fmt::format("a section [{}{}]", path_, key));
  read_table(table, path_ + key, settings);
}

template <typename Settings>
void SceneReader::list(const char* key, const char* /*says*/, std::vector<Settings>& settings) {
  for (std::size_t i = 0; i < settings.size(); ++i) read_table(nullptr, numbered(key, i), settings[i]);
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const toml::array* entries = node->as_array();
  if (entries == nullptr || entries->empty() || !entries->is_homogeneous(toml::node_type::table))
    return refuse_type(key, fmt::format("one or more sections [[{}{}]]", path_, key));
  for (std::size_t i = 0; i < entries->size(); ++i)
    read_table((*entries)[i].as_table(), numbered(key, i), settings.emplace_back());
}

template <typename Settings>
void SceneReader::read_table(const toml::table* table, const std::string& path, Settings& settings) {
  SceneReader reader(table, path + ".", *source_);
  walk(reader, settings);
  reader.refuse_unknown_keys();
}

}  // namespace weft::simulator
