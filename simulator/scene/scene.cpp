// SPDX-License-Identifier: Apache-2.0
#include "simulator/scene/scene.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "core/files.h"
#include "simulator/geometry/weave.h"

namespace weft::simulator {
namespace {

struct Range {
  double least;
  double most;
  bool holds(double value) const { return value >= least && value <= most; }  // false for NaN
};

constexpr Range kReflectance = {0, 1};
constexpr Range kFlux = {0, 1e12};
constexpr Range kCoordinate_mm = {-1e4, 1e4};

template <typename Enum>
using Names = std::vector<std::pair<const char*, Enum>>;

// Every key of a scene, once: what reads, checks and writes scenes walks over these functions.

template <typename Visitor>
void visit(Visitor& v, CameraSettings& c) {
  v.integer("width", c.width, 2, 20000);
  v.require(c.width % 2 == 0, "width", "it must be even, as a mosaic has whole 2 x 2 cells");
  v.integer("height", c.height, 2, 20000);
  v.require(c.height % 2 == 0, "height", "it must be even, as a mosaic has whole 2 x 2 cells");
  v.number("mm_per_pixel", c.mm_per_pixel, {1e-4, 10});
  v.number("distance_mm", c.distance_mm, {10, 1e4});
  v.choice("body", c.body, {{"offset", Body::kOffset}, {"d5100", Body::kD5100}});
  v.integer("bits", c.bits, 12, 16);
  v.require(c.bits % 2 == 0, "bits", "it must be 12, 14 or 16");
  v.number("full_well_electrons", c.full_well_electrons, {100, 1e9});
  v.number("read_noise_electrons", c.read_noise_electrons, {0, 1000});
  v.number("iso", c.iso, {100, 25600});
  v.number("f_number", c.f_number, {0.5, 64});
  v.number("exposure_us", c.exposure_us, {1, 1e9});
  v.number("albedo_at_full", c.albedo_at_full, {1e-3, 1});
}

template <typename Visitor>
void visit(Visitor& v, GeometrySettings& g) {
  v.choice("kind", g.kind,
           {{"flat", GeometryKind::kFlat},
            {"tilted", GeometryKind::kTilted},
            {"plain", GeometryKind::kPlain},
            {"twill", GeometryKind::kTwill},
            {"satin", GeometryKind::kSatin}});
  v.number("cloth_height_mm", g.cloth_height_mm, {-100, 1000});
  if (g.kind == GeometryKind::kTilted) {
    v.number("tilt_deg", g.tilt_deg, {0, 85});
    v.number("azimuth_deg", g.azimuth_deg, {-360, 360});
  }
  if (!is_woven(g.kind)) return;
  v.number("warp_pitch_mm", g.warp_pitch_mm, {0.01, 100});
  v.number("weft_pitch_mm", g.weft_pitch_mm, {0.01, 100});
  if (g.kind != GeometryKind::kPlain) {
    v.integer("over", g.over, 1, 32);
    v.integer("under", g.under, 1, 32);
    v.integer("step", g.step, 1, 63);
    const Draft draft = draft_of(g);
    v.require(draft.step < draft.period(), "step", "it must be below \"over\" + \"under\"");
  }
  v.number("crimp", g.crimp, {0, 0.5});
  v.number("flank_deg", g.flank_deg, {5, 80});
  v.number("twist_relief", g.twist_relief, {0, 0.1});
  v.require(yarns_stay_beside_their_neighbours(g), "crimp",
            "a yarn on top would cover its neighbours: lower it or \"twist_relief\", or raise \"flank_deg\"");
}

template <typename Visitor>
void visit(Visitor& v, MaterialSettings& m) {
  v.rgb("albedo", m.albedo, kReflectance);
  v.rgb("warp_albedo", m.warp_albedo, kReflectance);
  v.rgb("weft_albedo", m.weft_albedo, kReflectance);
  v.integer("stripe_yarns", m.stripe_yarns, 0, 1000);
  v.number("yarn_variation", m.yarn_variation, {0, 0.5});
}

bool has_yarns(const MaterialSettings& m) {
  return m.warp_albedo || m.weft_albedo || m.stripe_yarns > 0 || m.yarn_variation > 0;
}

template <typename Visitor>
void visit(Visitor& v, LedRing& r) {
  v.integer("count", r.count, 1, 256);
  v.number("zenith_deg", r.zenith_deg, {0, 89});
  v.number("azimuth_deg", r.azimuth_deg, {-360, 360});
  v.number("distance_mm", r.distance_mm, {10, 1e4});
}

template <typename Visitor>
void visit(Visitor& v, LedSettings& l) {
  v.vec3("position_mm", l.position_mm, kCoordinate_mm);
  v.vec3("aim", l.aim, kCoordinate_mm);
  v.require(!l.aim || length(*l.aim) > 1e-6, "aim", "it must be longer than 0");
  v.number("mu", l.mu, {0, 100});
  v.rgb("flux_rgb", l.flux_rgb, kFlux);
}

template <typename Visitor>
void visit(Visitor& v, LightSettings& l) {
  v.number("flux", l.flux, kFlux);
  v.rgb("white_balance", l.white_balance, {1e-3, 100});
  v.number("mu", l.mu, {0, 100});
  v.number("led_radius_mm", l.led_radius_mm, {0, 100});
  v.number("drift", l.drift, {0, 0.5});
  v.number("flicker", l.flicker, {0, 0.1});
  v.number("stray", l.stray, {0, 1});
  v.number("ambient", l.ambient, {0, 1});
  v.list("ring", l.rings);
  v.list("led", l.leds);
}

template <typename Visitor>
void visit(Visitor& v, EffectSettings& e) {
  for (const EffectKey& effect : effect_keys()) v.flag(effect.name, e.*effect.on);
}

template <typename Visitor>
void visit(Visitor& v, Scene& s) {
  v.text("fabric", s.fabric);
  v.integer("seed", s.seed, 0, std::numeric_limits<std::int64_t>::max());
  v.section("camera", s.camera);
  v.section("geometry", s.geometry);
  v.section("material", s.material);
  v.require(is_woven(s.geometry.kind) || !has_yarns(s.material), "material",
            "it has colours for yarns, and this geometry has none");
  v.section("lights", s.lights);
  v.section("effects", s.effects);
}

/// Insertions, deletions and substitutions from one word to the other (Levenshtein 1966).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

/// Reads one table over the values that are there and checks what results. Without a table it only checks.
class Reader {
 public:
  Reader(const toml::table* table, std::string where, std::string path, std::optional<Error>& error)
      : table_(table), where_(std::move(where)), path_(std::move(path)), error_(&error) {}

  void number(const char* key, double& value, Range allowed) {
    if (const toml::node* node = find(key)) {
      const std::optional<double> number = number_in(*node);
      if (!number) refuse_type(key, "a number");
      value = number.value_or(value);
    }
    check(key, value, allowed);
  }
  template <typename Integer>
  void integer(const char* key, Integer& value, std::int64_t least, std::int64_t most) {
    std::int64_t number = value;
    if (const toml::node* node = find(key)) {
      const std::optional<std::int64_t> integer = node->value_exact<std::int64_t>();
      if (!integer) refuse_type(key, "a whole number");
      number = integer.value_or(number);
    }
    if (number < least || number > most) {
      refuse(key, fmt::format("{} is not between {} and {}", number, least, most), kRemedy);
    } else {
      value = static_cast<Integer>(number);
    }
  }
  void flag(const char* key, bool& value) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    if (!node->is_boolean()) refuse_type(key, "true or false");
    value = node->value_or(value);
  }
  void text(const char* key, std::string& value) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    if (!node->is_string()) refuse_type(key, "a text in quotes");
    value = node->value_or(value);
  }
  template <typename Enum>
  void choice(const char* key, Enum& value, const Names<Enum>& names) {
    std::string name;
    if (find(key) == nullptr) return;
    text(key, name);
    const auto named =
        std::find_if(names.begin(), names.end(), [&](const auto& n) { return name == n.first; });
    if (named != names.end()) {
      value = named->second;
      return;
    }
    std::string known;
    for (const auto& n : names) known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", n.first);
    refuse(key, fmt::format("\"{}\" is not one of {}", name, known), "choose one of them");
  }
  /// A colour: three numbers, or one for grey.
  void rgb(const char* key, Rgb& value, Range allowed) {
    if (const toml::node* node = find(key)) {
      if (const std::optional<double> grey = number_in(*node)) {
        value.fill(*grey);
      } else {
        three_numbers(key, *node, value, "a number or three numbers in brackets");
      }
    }
    for (const double v : value) check(key, v, allowed);
  }
  void vec3(const char* key, Vec3& value, Range allowed) {
    std::array<double, 3> v = {value.x, value.y, value.z};
    if (const toml::node* node = find(key)) three_numbers(key, *node, v, "three numbers in brackets");
    for (const double coordinate : v) check(key, coordinate, allowed);
    value = {v[0], v[1], v[2]};
  }
  void integer(const char* key, std::optional<int>& value, std::int64_t least, std::int64_t most) {
    optional(key, value, [&](int& v) { integer(key, v, least, most); });
  }
  void number(const char* key, std::optional<double>& value, Range allowed) {
    optional(key, value, [&](double& v) { number(key, v, allowed); });
  }
  void rgb(const char* key, std::optional<Rgb>& value, Range allowed) {
    optional(key, value, [&](Rgb& v) { rgb(key, v, allowed); });
  }
  void vec3(const char* key, std::optional<Vec3>& value, Range allowed) {
    optional(key, value, [&](Vec3& v) { vec3(key, v, allowed); });
  }
  template <typename Settings>
  void section(const char* key, Settings& settings) {
    const toml::node* node = find(key);
    const toml::table* table = node == nullptr ? nullptr : node->as_table();
    if (node != nullptr && table == nullptr) refuse_type(key, fmt::format("a section [{}]", key));
    read_table(table, path_ + key, settings);
  }
  template <typename Settings>
  void list(const char* key, std::vector<Settings>& settings) {
    const toml::node* node = find(key);
    if (node == nullptr) {
      for (std::size_t i = 0; i < settings.size(); ++i) read_table(nullptr, numbered(key, i), settings[i]);
      return;
    }
    const toml::array* entries = node->as_array();
    if (entries == nullptr || entries->empty() || !entries->is_homogeneous(toml::node_type::table)) {
      return refuse_type(key, fmt::format("one or more sections [[{}{}]]", path_, key));
    }
    settings.assign(entries->size(), {});
    for (std::size_t i = 0; i < settings.size(); ++i) {
      read_table((*entries)[i].as_table(), numbered(key, i), settings[i]);
    }
  }
  void require(bool holds, const char* key, const std::string& rule) {
    if (!holds) refuse(key, rule, "change it");
  }

  /// Refuses the first key of the file that nobody asked for.
  void refuse_unknown_keys() {
    if (table_ == nullptr) return;
    const toml::key* unknown = nullptr;
    for (const auto& [key, node] : *table_) {
      if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
      if (unknown == nullptr || key.source().begin.line < unknown->source().begin.line) unknown = &key;
    }
    if (unknown == nullptr) return;
    const auto nearest = std::min_element(known_.begin(), known_.end(), [&](const auto& a, const auto& b) {
      return edit_distance(unknown->str(), a) < edit_distance(unknown->str(), b);
    });
    fail({ErrorKind::kBadData, fmt::format("unknown key \"{}{}\"", path_, unknown->str()),
          fmt::format("{}:{}", where_, unknown->source().begin.line),
          fmt::format("the nearest key here is \"{}\"", *nearest),
          "correct or remove it; docs/scenes.md lists the keys of each kind of scene"});
  }

 private:
  static constexpr const char* kRemedy = "choose a value inside";

  /// Nothing for what is no number, and for whole numbers too large for a double to hold exactly.
  static std::optional<double> number_in(const toml::node& node) {
    return node.is_number() ? node.value<double>() : std::nullopt;
  }
  const toml::node* find(const char* key) {
    known_.emplace_back(key);
    return table_ == nullptr ? nullptr : table_->get(key);
  }
  std::string numbered(const char* key, std::size_t i) const {
    return fmt::format("{}{}[{}]", path_, key, i + 1);
  }
  template <typename Settings>
  void read_table(const toml::table* table, const std::string& path, Settings& settings) {
    Reader reader(table, where_, path + ".", *error_);
    visit(reader, settings);
    reader.refuse_unknown_keys();
  }
  template <typename Value, typename Read>
  void optional(const char* key, std::optional<Value>& value, const Read& read) {
    if (find(key) == nullptr && !value) return;
    if (!value) value.emplace();
    read(*value);
  }
  void three_numbers(const char* key, const toml::node& node, std::array<double, 3>& value,
                     const char* kind) {
    const toml::array* array = node.as_array();
    if (array == nullptr || array->size() != 3) return refuse_type(key, kind);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::optional<double> number = number_in((*array)[i]);
      if (!number) return refuse_type(key, kind);
      value[i] = *number;
    }
  }
  void check(const char* key, double value, Range allowed) {
    if (allowed.holds(value)) return;
    refuse(key, fmt::format("{} is not between {} and {}", value, allowed.least, allowed.most), kRemedy);
  }
  void refuse_type(const char* key, const std::string& expected) {
    refuse(key, fmt::format("{} was expected", expected), "correct it");
  }
  void refuse(const char* key, std::string why, const char* remedy) {
    std::string place = where_;
    if (const toml::node* node = table_ == nullptr ? nullptr : table_->get(key)) {
      place += fmt::format(":{}", node->source().begin.line);
    }
    fail({ErrorKind::kBadData, fmt::format("scene value \"{}{}\" cannot be used", path_, key),
          std::move(place), std::move(why), remedy});
  }
  void fail(Error error) {
    if (!*error_) *error_ = std::move(error);
  }

  const toml::table* table_;
  std::string where_;
  std::string path_;
  std::optional<Error>* error_;
  std::vector<std::string> known_;
};

/// Writes every value as a line of TOML.
class Writer {
 public:
  explicit Writer(std::string path = "") : path_(std::move(path)) {}
  std::string text() && { return std::move(text_); }

  template <typename Value>
  void number(const char* key, const Value& value, Range) {
    put(key, value);
  }
  template <typename Value>
  void integer(const char* key, const Value& value, std::int64_t, std::int64_t) {
    put(key, value);
  }
  void flag(const char* key, bool value) { put(key, value); }
  void text(const char* key, const std::string& value) { put(key, quoted(value)); }
  template <typename Enum>
  void choice(const char* key, Enum value, const Names<Enum>& names) {
    const auto named =
        std::find_if(names.begin(), names.end(), [&](const auto& n) { return value == n.second; });
    put(key, quoted(named->first));
  }
  template <typename Value>
  void rgb(const char* key, const Value& value, Range) {
    put(key, value);
  }
  template <typename Value>
  void vec3(const char* key, const Value& value, Range) {
    put(key, value);
  }
  template <typename Settings>
  void section(const char* key, Settings& settings) {
    append(fmt::format("\n[{}{}]\n", path_, key), key, settings);
  }
  template <typename Settings>
  void list(const char* key, std::vector<Settings>& settings) {
    for (Settings& each : settings) append(fmt::format("\n[[{}{}]]\n", path_, key), key, each);
  }
  void require(bool, const char*, const char*) {}

 private:
  template <typename Settings>
  void append(const std::string& heading, const char* key, Settings& settings) {
    Writer writer(path_ + key + ".");
    visit(writer, settings);
    text_ += heading + writer.text_;
  }
  template <typename Value>
  void put(const char* key, const Value& value) {
    text_ += fmt::format("{} = {}\n", key, value);
  }
  void put(const char* key, const Rgb& v) { put(key, fmt::format("[{}, {}, {}]", v[0], v[1], v[2])); }
  void put(const char* key, const Vec3& v) { put(key, Rgb{v.x, v.y, v.z}); }
  template <typename Value>
  void put(const char* key, const std::optional<Value>& value) {
    if (value) put(key, *value);
  }
  static std::string quoted(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
      if (c == '"' || c == '\\') quoted += '\\';
      quoted += c >= 0 && c < ' ' ? fmt::format("\\u{:04X}", static_cast<int>(c)) : std::string(1, c);
    }
    return quoted + "\"";
  }

  std::string path_;
  std::string text_;
};

Result<Scene> read_table(const toml::table* table, const std::string& where, Scene scene) {
  std::optional<Error> error;
  Reader reader(table, where, "", error);
  visit(reader, scene);
  reader.refuse_unknown_keys();
  if (error) return *std::move(error);
  return scene;
}

}  // namespace

std::span<const EffectKey> effect_keys() {
  using E = EffectSettings;
  static constexpr EffectKey kKeys[] = {
      {"near_light", &E::near_light},
      {"relief", &E::relief},
      {"finite_led", &E::finite_led},
      {"led_drift", &E::led_drift},
      {"stray", &E::stray},
      {"ambient", &E::ambient},
      {"cast_shadows", &E::cast_shadows},
      {"interreflection", &E::interreflection},
      {"reflectance", &E::reflectance},
      {"spectral", &E::spectral},
      {"distortion", &E::distortion},
      {"movement", &E::movement},
      {"vignetting", &E::vignetting},
      {"defocus", &E::defocus},
      {"bloom", &E::bloom},
      {"dark_current", &E::dark_current},
      {"uneven_response", &E::uneven_response},
      {"nonlinearity", &E::nonlinearity},
      {"noise", &E::noise},
  };
  return kKeys;
}

std::vector<LedRing> default_rings() {
  return {{4, 35, 0, 600}, {6, 62, 15, 600}};
}

Result<Scene> parse_scene(std::string_view text, const std::string& where) {
  toml::table table;
  try {
    table = toml::parse(text, where);
  } catch (const toml::parse_error& wrong) {
    return Error{ErrorKind::kBadData, "scene is not TOML",
                 fmt::format("{}:{}", where, wrong.source().begin.line), std::string(wrong.description()),
                 "correct that line"};
  }
  return read_table(&table, where, Scene());
}

Result<Scene> read_scene(const std::filesystem::path& file) {
  const Result<std::string> text = read_text(file, std::size_t{1} << 20);
  if (!text) return text.error();
  return parse_scene(*text, file.string());
}

Result<void> check_scene(const Scene& scene) {
  if (Result<Scene> checked = read_table(nullptr, "scene", scene); !checked)
    return std::move(checked).error();
  return {};
}

std::string to_toml(const Scene& scene) {
  Scene copy = scene;
  Writer writer;
  visit(writer, copy);
  return std::move(writer).text();
}

}  // namespace weft::simulator
