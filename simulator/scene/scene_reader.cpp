// SPDX-License-Identifier: Apache-2.0
#include "simulator/scene/scene_reader.h"

#include <array>
#include <charconv>

#include "core/base/text.h"
#include "simulator/scene/scene_keys.h"

namespace weft::simulator {
namespace {

/// Nothing for what is no number, and for whole numbers too large for a double to hold exactly.
std::optional<double> number_in(const toml::node& node) {
  return node.is_number() ? node.value<double>() : std::nullopt;
}

/// Nothing unless the node is a list of numbers alone.
std::optional<std::vector<double>> numbers_in(const toml::node& node) {
  const toml::array* array = node.as_array();
  if (array == nullptr) return std::nullopt;
  std::vector<double> numbers;
  for (const toml::node& each : *array) {
    const std::optional<double> number = number_in(each);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

/// The number of "0.25 sigma".
std::optional<double> sigma_in(std::string_view text) {
  double sigma = 0;
  const auto [rest, failed] = std::from_chars(text.data(), text.data() + text.size(), sigma);
  const std::string_view unit(rest, static_cast<std::size_t>(text.data() + text.size() - rest));
  if (failed != std::errc() || unit != " sigma") return std::nullopt;
  return sigma;
}

template <typename Names>
std::string nearest_to(std::string_view word, const Names& names) {
  return *std::min_element(names.begin(), names.end(), [&](const auto& a, const auto& b) {
    return edit_distance(word, a) < edit_distance(word, b);
  });
}

}  // namespace

void SceneReader::number(const SceneKey& key, double& value, Range allowed) {
  if (const toml::node* node = find(key.name)) {
    const std::optional<double> number = number_in(*node);
    if (!number) refuse_type(key.name, "a number");
    value = number.value_or(value);
  }
  check(key.name, value, allowed);
}

void SceneReader::flag(const SceneKey& key, bool& value) {
  const toml::node* node = find(key.name);
  if (node == nullptr) return;
  if (!node->is_boolean()) refuse_type(key.name, "true or false");
  value = node->value_or(value);
}

void SceneReader::text(const SceneKey& key, std::string& value) {
  const toml::node* node = find(key.name);
  if (node == nullptr) return;
  if (!node->is_string()) refuse_type(key.name, "a text in quotes");
  value = node->value_or(value);
}

void SceneReader::rgb(const SceneKey& key, Rgb& value, Range allowed) {
  if (const toml::node* node = find(key.name)) {
    const std::optional<std::vector<double>> numbers = numbers_in(*node);
    if (const std::optional<double> grey = number_in(*node)) {
      value.fill(*grey);
    } else if (numbers && numbers->size() == value.size()) {
      std::copy(numbers->begin(), numbers->end(), value.begin());
    } else {
      refuse_type(key.name, "a number or three numbers in brackets");
    }
  }
  for (const double v : value) check(key.name, v, allowed);
}

void SceneReader::vec3(const SceneKey& key, Vec3& value, Range allowed) {
  std::array<double, 3> v = {value.x, value.y, value.z};
  numbers(key, v, allowed);
  value = {v[0], v[1], v[2]};
}

void SceneReader::numbers(const SceneKey& key, std::span<double> values, Range allowed) {
  if (const toml::node* node = find(key.name)) {
    const std::optional<std::vector<double>> read = numbers_in(*node);
    if (!read || read->size() != values.size())
      return refuse_type(key.name,
                         fmt::format("{} numbers in brackets",
                                     values.size() == 3 ? "three" : fmt::format("{}", values.size())));
    std::copy(read->begin(), read->end(), values.begin());
  }
  for (const double v : values) check(key.name, v, allowed);
}

void SceneReader::numbers(const SceneKey& key, std::vector<double>& values, Range allowed) {
  if (const toml::node* node = find(key.name)) {
    std::optional<std::vector<double>> read = numbers_in(*node);
    if (!read || read->empty()) return refuse_type(key.name, "one or more numbers in brackets");
    values = *std::move(read);
  }
  for (const double v : values) check(key.name, v, allowed);
}

void SceneReader::file(const SceneKey& key, std::string& value) {
  if (find(key.name) == nullptr) return;
  std::string name;
  text(key, name);
  if (name.empty()) return refuse_type(key.name, "the name of a file");
  value = absolute(name);
}

void SceneReader::picture(const SceneKey& key, std::string& file_name,
                          std::shared_ptr<const Image<float>>& image) {
  file(key, file_name);
  if (file_name.empty() || !source_->read_picture || source_->error) return;
  Result<Image<float>> read = source_->read_picture(file_name);
  require(read, key.name);
  if (read) image = std::make_shared<const Image<float>>(*std::move(read));
}

void SceneReader::spectrum(const SceneKey& key, Spectrum& value) {
  if (const toml::node* node = find(key.name)) spectrum_in(key.name, *node, value);
  check(key.name, value);
}

void SceneReader::spectra(const SceneKey& key, std::span<Spectrum> values) {
  if (const toml::node* node = find(key.name)) {
    const toml::array* array = node->as_array();
    if (array == nullptr || array->size() != values.size())
      return refuse_type(key.name, fmt::format("{} spectra in brackets", values.size()));
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!spectrum_in(key.name, (*array)[i], values[i])) return;
    }
  }
  for (const Spectrum& v : values) check(key.name, v);
}

void SceneReader::chart(const SceneKey& key, std::vector<Spectrum>& patches, int count) {
  const toml::node* node = find(key.name);
  if (node != nullptr && node->is_string()) {
    Result<std::vector<Spectrum>> read = read_spectra(absolute(node->value_or(std::string())), count);
    require(read, key.name);
    if (read) patches = *std::move(read);
  } else if (node != nullptr) {
    patches.resize(static_cast<std::size_t>(count));
    spectra(key, patches);
  }
  for (const Spectrum& v : patches) check(key.name, v);
  if (patches.empty() || patches.size() == static_cast<std::size_t>(count)) return;
  refuse(key.name, fmt::format("it has {} patches, not {}", patches.size(), count),
         "give one spectrum a patch");
}

void SceneReader::automatic(const SceneKey& key, const SceneKey& to, std::optional<double>& sigma,
                            Range allowed) {
  const toml::node* effects = find(key.name);
  const toml::node* accuracy = find(to.name);
  if (effects != nullptr && effects->is_string()) {
    if (effects->value_or(std::string()) != "auto")
      return refuse(key.name, "the only text it may be is \"auto\"", "put the names of effects in brackets");
    sigma = kAutomaticSigma;
  }
  if (accuracy != nullptr) {
    if (!sigma)
      return refuse(to.name,
                    "it says how far effects = \"auto\" may be off, and this scene names its effects",
                    "remove it, or let the effects be \"auto\"");
    sigma = sigma_in(accuracy->value_or(std::string()));
    if (!sigma) return refuse_type(to.name, "a number of sigma in quotes, such as \"0.25 sigma\",");
  }
  if (sigma) check(to.name, *sigma, allowed);
}

void SceneReader::flags(const char* key, const char* says, EffectSettings& effects) {
  const toml::node* node = find(key);
  if (node == nullptr || node->is_table()) return section(key, says, effects);
  const toml::array* names = node->as_array();
  if (names == nullptr || (!names->empty() && !names->is_homogeneous(toml::node_type::string)))
    return refuse_type(key, "a section [effects], a list of names or \"auto\"");
  std::vector<std::string> known;
  for (const EffectKey& effect : effect_keys()) known.emplace_back(effect.name);
  for (const toml::node& each : *names) {
    const std::string name = each.value_or(std::string());
    const auto named = std::find(known.begin(), known.end(), name);
    if (named == known.end()) {
      return refuse(key,
                    fmt::format("\"{}\" is no effect; the nearest is \"{}\"", name, nearest_to(name, known)),
                    "correct or remove it; docs/reference/scenes.md lists the effects");
    }
    effects.*effect_keys()[static_cast<std::size_t>(named - known.begin())].on = true;
  }
}

void SceneReader::refuse_unknown_keys() {
  if (table_ == nullptr) return;
  const toml::key* unknown = nullptr;
  for (const auto& [key, node] : *table_) {
    if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
    if (unknown == nullptr || key.source().begin.line < unknown->source().begin.line) unknown = &key;
  }
  if (unknown == nullptr) return;
  const std::string why =
      known_.empty() ? "there are no keys here"
                     : fmt::format("the nearest key here is \"{}\"", nearest_to(unknown->str(), known_));
  fail({ErrorKind::kBadData, fmt::format("unknown key \"{}{}\"", path_, unknown->str()),
        fmt::format("{}:{}", source_->where, unknown->source().begin.line), why,
        "correct or remove it; docs/reference/scenes.md lists the keys of each kind of scene"});
}

const toml::node* SceneReader::find(const char* key) {
  known_.emplace_back(key);
  return table_ == nullptr ? nullptr : table_->get(key);
}

std::string SceneReader::absolute(const std::string& name) const {
  return std::filesystem::absolute(source_->folder / name).lexically_normal().string();
}

/// Whether it could be read; says so where not.
bool SceneReader::spectrum_in(const char* key, const toml::node& node, Spectrum& value) {
  const std::optional<std::vector<double>> numbers = numbers_in(node);
  if (!numbers && !node.is_string()) {
    refuse_type(key, fmt::format("the name of a file or {} numbers in brackets", Spectrum::kSamples));
    return false;
  }
  const Result<Spectrum> read =
      numbers ? spectrum_of(*numbers, path_ + key) : read_spectrum(absolute(node.value_or(std::string())));
  require(read, key);
  if (read) value = *read;
  return read.has_value();
}

void SceneReader::check(const char* key, double value, Range allowed) {
  if (value >= allowed.least && value <= allowed.most) return;  // false for NaN
  refuse(key, fmt::format("{} is not between {} and {}", value, allowed.least, allowed.most), kRemedy);
}

void SceneReader::check(const char* key, const Spectrum& value) {
  for (const double sample : value.samples) check(key, sample, {0, 1});
}

void SceneReader::refuse_type(const char* key, const std::string& expected) {
  refuse(key, fmt::format("{} was expected", expected), "correct it");
}

void SceneReader::refuse(const char* key, std::string why, std::string remedy, ErrorKind kind) {
  std::string place = source_->where;
  if (const toml::node* node = table_ == nullptr ? nullptr : table_->get(key)) {
    place += fmt::format(":{}", node->source().begin.line);
  }
  fail({kind, fmt::format("scene value \"{}{}\" cannot be used", path_, key), std::move(place),
        std::move(why), std::move(remedy)});
}

}  // namespace weft::simulator
