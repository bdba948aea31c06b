// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/image/image.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_key.h"

// Writes scenes. Internal to simulator/scene.

namespace weft::simulator {

/// Writes every value of one table as a line of TOML; its functions are those of SceneReader.
class SceneWriter {
 public:
  explicit SceneWriter(std::string path = "") : path_(std::move(path)) {}
  std::string text() && { return std::move(text_); }

  template <typename Value>
  void number(const SceneKey& key, const Value& value, Range) {
    put(key.name, value);
  }
  template <typename Value>
  void integer(const SceneKey& key, const Value& value, std::int64_t, std::int64_t) {
    put(key.name, value);
  }
  template <typename Value>
  void rgb(const SceneKey& key, const Value& value, Range) {
    put(key.name, value);
  }
  template <typename Value>
  void vec3(const SceneKey& key, const Value& value, Range) {
    put(key.name, value);
  }
  template <typename Values>
  void numbers(const SceneKey& key, const Values& values, Range) {
    put(key.name, values);
  }
  template <typename Value>
  void spectrum(const SceneKey& key, const Value& value) {
    put(key.name, value);
  }
  void spectra(const SceneKey& key, std::span<const Spectrum> values) { put(key.name, values); }
  void chart(const SceneKey& key, const std::vector<Spectrum>& patches, int) {
    if (!patches.empty()) put(key.name, patches);
  }
  template <typename Value>
  void text(const SceneKey& key, const Value& value) {
    put(key.name, value);
  }
  template <typename Value>
  void file(const SceneKey& key, const Value& value) {
    put(key.name, value);
  }
  void picture(const SceneKey& key, const std::string& file_name,
               const std::shared_ptr<const Image<float>>&) {
    if (!file_name.empty()) put(key.name, file_name);
  }
  void flag(const SceneKey& key, bool value) { put(key.name, value); }
  template <typename Value>
  void choice(const SceneKey& key, const Value& value, const std::type_identity_t<Names<Value>>& names) {
    const auto named =
        std::find_if(names.begin(), names.end(), [&](const auto& n) { return value == n.second; });
    put(key.name, std::string(named->first));
  }
  template <typename Value>
  void choice(const SceneKey& key, const std::optional<Value>& value,
              const std::type_identity_t<Names<Value>>& names) {
    if (value) choice(key, *value, names);
  }
  template <typename Value>
  void kind(const SceneKey& key, const Value& value, const std::type_identity_t<Names<Value>>& names) {
    choice(key, value, names);
  }
  template <typename Settings>
  void section(const char* key, const char*, Settings& settings) {
    append(fmt::format("\n[{}{}]\n", path_, key), key, settings);
  }
  /// Nothing where all is as by default.
  template <typename Settings>
  void optional_section(const char* key, const char* says, Settings& settings) {
    if (!(settings == Settings())) section(key, says, settings);
  }
  template <typename Settings>
  void list(const char* key, const char*, std::vector<Settings>& settings) {
    for (Settings& each : settings) append(fmt::format("\n[[{}{}]]\n", path_, key), key, each);
  }
  void automatic(const SceneKey& key, const SceneKey& to, const std::optional<double>& sigma, Range) {
    if (!sigma) return;
    put(key.name, std::string("auto"));
    put(to.name, fmt::format("{} sigma", *sigma));
  }
  void flags(const char* key, const char* says, EffectSettings& effects) { section(key, says, effects); }
  void require(bool, const char*, const char*) {}
  template <typename Value>
  void require(const Result<Value>&, const char*) {}

 private:
  template <typename Settings>
  void append(const std::string& heading, const char* key, Settings& settings) {
    SceneWriter writer(path_ + key + ".");
    walk(writer, settings);
    text_ += heading + writer.text_;
  }
  template <typename Value>
  void put(const char* key, const Value& value) {
    text_ += fmt::format("{} = {}\n", key, toml_of(value));
  }
  template <typename Value>
  void put(const char* key, const std::optional<Value>& value) {
    if (value) put(key, *value);
  }

  template <typename Number>
  static std::string toml_of(const Number& value) {
    return fmt::format("{}", value);
  }
  static std::string toml_of(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
      if (c == '"' || c == '\\') quoted += '\\';
      quoted += (c >= 0 && c < ' ') || c == 0x7f ? fmt::format("\\u{:04X}", static_cast<int>(c))
                                                 : std::string(1, c);
    }
    return quoted + "\"";
  }
  static std::string toml_of(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }
  static std::string toml_of(const Spectrum& spectrum) { return list_of(spectrum.samples); }
  template <typename Value, std::size_t N>
  static std::string toml_of(const std::array<Value, N>& values) {
    return list_of(values);
  }
  template <typename Value>
  static std::string toml_of(const std::vector<Value>& values) {
    return list_of(values);
  }
  static std::string toml_of(const std::span<const Spectrum>& values) { return list_of(values); }
  template <typename Values>
  static std::string list_of(const Values& values) {
    std::string list;
    for (const auto& each : values) list += (list.empty() ? "" : ", ") + toml_of(each);
    return "[" + list + "]";
  }

  std::string path_;
  std::string text_;
};

}  // namespace weft::simulator
