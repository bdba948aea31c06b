// SPDX-License-Identifier: Apache-2.0
#include "material/read/compared_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace weft::material {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWhat = "the maps cannot be compared";

using Places = std::vector<std::size_t>;

std::optional<Places> places_named(const FileMeaning& meaning, const std::vector<std::string>& names) {
  Places places;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(meaning.info.channels, name);
    if (found == meaning.info.channels.end()) return std::nullopt;
    places.push_back(static_cast<std::size_t>(found - meaning.info.channels.begin()));
  }
  return places;
}

std::optional<Places> first_three(const FileMeaning& meaning) {
  if (meaning.is_listed || meaning.channels.size() < 3) return std::nullopt;
  return Places{0, 1, 2};
}

std::optional<Places> normal_places(const FileMeaning& meaning) {
  if (const auto all = meaning.find({"normal.x", "normal.y", "normal.z"})) return all;
  if (const auto two = meaning.find({"normal.x", "normal.y"})) return two;
  return first_three(meaning);
}

std::optional<Places> color_places(const FileMeaning& meaning) {
  if (const auto listed = meaning.find({"albedo.r", "albedo.g", "albedo.b"})) return listed;
  if (meaning.is_listed) return std::nullopt;
  if (const auto named = places_named(meaning, {"R", "G", "B"})) return named;
  return first_three(meaning);
}

std::array<View<const float>, 3> views_at(const LoadedImage& image, const Places& places) {
  const auto view = [&](std::size_t i) { return image.planes.plane(static_cast<int>(places[i])); };
  return {view(0), view(1), view(2)};
}

// Words of a file's name, in small letters: "cloth_Normal-GL.png" has cloth, normal, gl.
std::vector<std::string> words_in(const fs::path& file) {
  std::vector<std::string> words(1);
  for (const char c : file.stem().string()) {
    const bool is_upper = c >= 'A' && c <= 'Z', is_letter = is_upper || (c >= 'a' && c <= 'z');
    const bool ends = !words.back().empty() && (!is_letter || (is_upper && words.back().size() > 2));
    if (ends) words.emplace_back();
    if (is_letter) words.back() += static_cast<char>(is_upper ? c - 'A' + 'a' : c);
  }
  return words;
}

bool is_named(const fs::path& file, std::initializer_list<const char*> names) {
  return std::ranges::any_of(
      words_in(file), [&](const std::string& word) { return std::ranges::find(names, word) != names.end(); });
}

bool says_normals(const fs::path& file) {
  return is_named(file, {"normal", "normals", "nrm", "nor", "norm"});
}
bool says_colors(const fs::path& file) {
  return is_named(file, {"albedo", "diffuse", "diff", "basecolor", "color", "colour", "col"});
}

// What the three channels of a file that nobody lists can be.
std::pair<Likely, Likely> normal_or_color(const ComparedMap& map, const Places& places) {
  const auto planes = views_at(map.image, places);
  const bool is_unit = are_unit_normals(planes, are_packed_normals(planes));
  const ColorSpace color = map.meaning.info.color;
  const bool is_tagged = color != ColorSpace::kData && map.meaning.info.format != "jpeg";
  const bool is_color = is_tagged || says_colors(map.file);
  using enum Likely;
  if (is_unit)
    return is_color && !says_normals(map.file) ? std::pair{kMaybe, kMaybe} : std::pair{kYes, kMaybe};
  if (says_normals(map.file)) return {kMaybe, kNo};
  return is_color ? std::pair{kNo, kYes} : std::pair{kMaybe, kMaybe};
}

Error has_none(const ComparedMap& map, const char* kind) {
  return {
      ErrorKind::kBadData, kWhat, map.file.string(),
      fmt::format("it holds no {}; its channels are {}", kind, fmt::join(map.meaning.info.channels, ", ")),
      "name two maps of one kind"};
}

std::function<bool(int, int)> zero_test(const LoadedImage& image, const Places& places) {
  return [&image, places](int x, int y) {
    return std::ranges::all_of(places,
                               [&](std::size_t p) { return image.planes(x, y, static_cast<int>(p)) == 0; });
  };
}

Error other_curve(const ComparedMap& map) {
  return {ErrorKind::kBadData, kWhat, map.file.string(),
          "its colours have a transfer function that is neither that of sRGB nor none",
          "export it in sRGB or linear"};
}

}  // namespace

Likely ComparedMap::is(ComparedKind kind) const {
  if (kind == ComparedKind::kNumber) {
    const std::vector<std::string> all = numbers();
    return all.empty() ? Likely::kNo : Likely::kYes;
  }
  const bool has_normals = meaning.find({"normal.x", "normal.y"}).has_value();
  if (meaning.is_listed) {
    const bool is_it = kind == ComparedKind::kNormal
                           ? has_normals
                           : meaning.find({"albedo.r", "albedo.g", "albedo.b"}).has_value();
    return is_it ? Likely::kYes : Likely::kNo;
  }
  if (has_normals) {
    if (kind == ComparedKind::kNormal) return Likely::kYes;
    return places_named(meaning, {"R", "G", "B"}) ? Likely::kMaybe : Likely::kNo;
  }
  const std::optional<Places> places = color_places(meaning);
  if (!places) return Likely::kNo;
  const auto [normal, color] = normal_or_color(*this, *places);
  return kind == ComparedKind::kNormal ? normal : color;
}

Result<Triples> ComparedMap::normals() const {
  const std::optional<Places> places = normal_places(meaning);
  if (!places) return has_none(*this, "normals");
  const bool has_z = places->size() == 3;
  const bool is_integer = image.info.type == SampleType::kUint8 || image.info.type == SampleType::kUint16;
  const bool is_packed =
      !meaning.is_listed && (is_integer || (has_z && are_packed_normals(views_at(image, *places))));
  const bool is_down = meaning.direction == exchange::NormalDirection::kDirectX;
  const auto normal = [this, places = *places, has_z, is_packed, is_down](int x, int y) {
    std::array<double, 3> n = {};
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double sample = double{image.planes(x, y, static_cast<int>(places[i]))};
      n[i] = is_packed ? 2 * sample - 1 : meaning.channels[places[i]].in_range(sample);
    }
    if (!has_z) n[2] = std::sqrt(std::max(0.0, 1 - n[0] * n[0] - n[1] * n[1]));
    if (is_down) n[1] = -n[1];
    return n;
  };
  return Triples{normal, zero_test(image, *places)};
}

Result<Triples> ComparedMap::colors() const {
  const std::optional<Places> places = color_places(meaning);
  if (!places) return has_none(*this, "colours");
  if (!meaning.is_listed && meaning.info.color == ColorSpace::kOther) return other_curve(*this);
  std::array<ChannelMeaning, 3> of;
  for (std::size_t i = 0; i < 3; ++i) of[i] = meaning.channels[(*places)[i]];
  const auto color = [this, places = *places, of](int x, int y) {
    std::array<double, 3> rgb = {};
    for (std::size_t i = 0; i < 3; ++i)
      rgb[i] = of[i].value_of(double{image.planes(x, y, static_cast<int>(places[i]))});
    return rgb;
  };
  return Triples{color, zero_test(image, *places)};
}

double ComparedMap::number(std::size_t channel, int x, int y) const {
  const ChannelMeaning& of = meaning.channels[channel];
  const double value = of.in_range(double{image.planes(x, y, static_cast<int>(channel))});
  const bool is_roughness = meaning.is_listed && of.is.starts_with("roughness");
  return is_roughness ? std::sqrt(exchange::alpha_in(meaning.roughness, value)) : value;
}

std::vector<std::string> ComparedMap::numbers() const {
  std::vector<std::string> names;
  for (const ChannelMeaning& channel : meaning.channels) {
    const exchange::Channel* known = exchange::channel_named(channel.is);
    if (known != nullptr && known->kind == exchange::ChannelKind::kData && !known->planes.empty())
      names.push_back(channel.is);
  }
  if (names.empty() && !meaning.is_listed && meaning.channels.size() == 1) names.emplace_back();
  return names;
}

Result<ComparedMap> read_compared(const fs::path& file) {
  Result<FileMeaning> meaning = meaning_of(file);
  if (!meaning) return std::move(meaning).error();
  Result<LoadedImage> image = read_samples(file);
  if (!image) return std::move(image).error();
  return ComparedMap{file, std::move(*meaning), std::move(*image)};
}

Result<ComparedKind> kind_of_both(const ComparedMap& tested, const ComparedMap& truth) {
  std::vector<ComparedKind> sure, possible;
  for (const ComparedKind kind : {ComparedKind::kNormal, ComparedKind::kAlbedo, ComparedKind::kNumber}) {
    const Likely a = tested.is(kind), b = truth.is(kind);
    if (a == Likely::kNo || b == Likely::kNo) continue;
    possible.push_back(kind);
    if (a == Likely::kYes || b == Likely::kYes) sure.push_back(kind);
  }
  // What stands beside colours, as opacity does, is not what is asked about.
  if (sure.size() > 1 && sure.back() == ComparedKind::kNumber) sure.pop_back();
  if (sure.size() == 1) return sure.front();
  const std::string both = fmt::format("{} and {}", tested.file.string(), truth.file.string());
  if (possible.empty())
    return Error{ErrorKind::kUsage, kWhat, both, "they are maps of two kinds",
                 "compare two maps of one kind"};
  return Error{ErrorKind::kUsage, kWhat, both,
               "neither channels, tags nor names tell whether they hold normals or colours",
               "say --kind normal or --kind albedo"};
}

}  // namespace weft::material
