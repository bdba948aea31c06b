// SPDX-License-Identifier: Apache-2.0
#include "core/calibration_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weft {
namespace {

bool is_numbers(const Json& list, std::size_t count) {
  return list.is_array() && list.size() == count &&
         std::all_of(list.begin(), list.end(), [](const Json& v) { return v.is_number(); });
}

Json json_of(Vec3 v) {
  return Json::array({v.x, v.y, v.z});
}

Json model_json(const CameraModel& c) {
  const Mat3& r = c.camera_from_rig_rotation;
  return {{"schema", "weft.camera/1"},
          {"width", c.size.width},
          {"height", c.size.height},
          {"fx", c.fx},
          {"fy", c.fy},
          {"cx", c.cx},
          {"cy", c.cy},
          {"k1", c.k1},
          {"k2", c.k2},
          {"k3", c.k3},
          {"p1", c.p1},
          {"p2", c.p2},
          {"camera_from_rig_rotation", Json::array({r[0], r[1], r[2]})},
          {"camera_from_rig_translation_mm", json_of(c.camera_from_rig_translation_mm)}};
}

// Orthonormal, and no mirror.
bool is_rotation(const Mat3& m) {
  const Vec3 x = m * Vec3{1, 0, 0}, y = m * Vec3{0, 1, 0}, z = m * Vec3{0, 0, 1};
  const auto near = [](Vec3 a, Vec3 b) { return length(a - b) < 1e-6; };
  return near(cross(x, y), z) && near(cross(y, z), x) && near(cross(z, x), y) &&
         std::abs(length(x) - 1) < 1e-6;
}

Result<CameraModel> model_from_json(const Json& json, const std::string& where) {
  JsonFields fields(json, where);
  CameraModel c;
  c.size = {fields.integer("width"), fields.integer("height")};
  c.fx = fields.number("fx");
  c.fy = fields.number("fy");
  c.cx = fields.number("cx");
  c.cy = fields.number("cy");
  c.k1 = fields.number("k1");
  c.k2 = fields.number("k2");
  c.k3 = fields.number("k3");
  c.p1 = fields.number("p1");
  c.p2 = fields.number("p2");
  c.camera_from_rig_rotation = fields.mat3("camera_from_rig_rotation");
  if (!is_rotation(c.camera_from_rig_rotation))
    fields.reject("camera_from_rig_rotation", "must be a rotation");
  c.camera_from_rig_translation_mm = fields.vec3("camera_from_rig_translation_mm");
  if (c.size.width < 1 || c.size.height < 1) fields.reject("width", "and \"height\" must be above 0");
  if (c.fx <= 0 || c.fy <= 0) fields.reject("fx", "and \"fy\" must be above 0");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return c;
}

Result<std::vector<ExposureRatio>> exposure_ratios_from_json(const Json& list, const std::string& where) {
  std::vector<ExposureRatio> ratios;
  for (std::size_t i = 0; i < list.size(); ++i) {
    JsonFields fields(list[i], fmt::format("{}: exposure_ratios {}", where, i));
    const ExposureRatio e = {fields.number("exposure_us"), fields.number("to_exposure_us"),
                             fields.number("ratio")};
    for (const auto& [key, value] : {std::pair{"exposure_us", e.exposure_us},
                                     {"to_exposure_us", e.to_exposure_us},
                                     {"ratio", e.ratio}}) {
      if (value <= 0) fields.reject(key, "must be above 0");
    }
    if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
    ratios.push_back(e);
  }
  return ratios;
}

Json model_json(const Lights& lights) {
  Json json = {{"schema", "weft.lights/1"}};
  if (const auto* near = std::get_if<NearLights>(&lights)) {
    json["kind"] = "near";
    Json leds = Json::array();
    for (const NearLight& led : near->leds) {
      leds.push_back({{"position_mm", json_of(led.position_mm)},
                      {"aim", json_of(led.aim)},
                      {"mu", led.mu},
                      {"flux_rgb", led.flux_rgb},
                      {"log_gain_quadratic", led.log_gain_quadratic}});
    }
    json["leds"] = std::move(leds);
    Json splines = Json::array();
    for (const GainSpline& s : near->log_gain_rgb) {
      splines.push_back({{"columns", s.columns}, {"rows", s.rows}, {"coefficients", s.coefficients}});
    }
    json["log_gain_rgb"] = std::move(splines);
    return json;
  }
  json["kind"] = "distant";
  Json distant = Json::array();
  for (const DistantLight& light : std::get<DistantLights>(lights).lights) {
    distant.push_back({{"direction", json_of(light.direction)}, {"irradiance_rgb", light.irradiance_rgb}});
  }
  json["lights"] = std::move(distant);
  return json;
}

Json covariance_json(const ParameterCovariance& covariance) {
  Json rows = Json::array();
  for (auto row = covariance.matrix.begin(); row != covariance.matrix.end();) {
    const auto end = row + static_cast<std::ptrdiff_t>(covariance.parameters.size());
    rows.push_back(std::vector<double>(row, end));
    row = end;
  }
  return {{"parameters", covariance.parameters}, {"matrix", std::move(rows)}};
}

Json patches_json(const std::vector<WhitePatch>& patches) {
  Json list = Json::array();
  for (const WhitePatch& patch : patches) {
    Json& record =
        list.emplace_back(Json{{"polygon_px", patch.polygon_px}, {"reflectance_rgb", patch.reflectance_rgb}});
    if (patch.delta != 0) record["delta"] = patch.delta;
    if (patch.height_mm) record["height_mm"] = *patch.height_mm;
  }
  return list;
}

Result<GainSpline> spline_from_json(const Json& json, const std::string& where) {
  JsonFields fields(json, where);
  GainSpline spline;
  spline.columns = fields.integer("columns");
  spline.rows = fields.integer("rows");
  const Json& coefficients = fields.list("coefficients");
  const bool fits = coefficients.empty() ||
                    (spline.columns >= 4 && spline.rows >= 4 &&
                     coefficients.size() ==
                         static_cast<std::size_t>(spline.columns) * static_cast<std::size_t>(spline.rows));
  if (!fits) fields.reject("coefficients", "must be none, or columns x rows numbers with at least 4 x 4");
  for (const Json& value : coefficients) {
    if (!value.is_number()) {
      fields.reject("coefficients", "must be numbers");
      break;
    }
    spline.coefficients.push_back(value.get<double>());
  }
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return spline;
}

void require_unit(JsonFields& fields, const char* key, Vec3 direction) {
  if (std::abs(length(direction) - 1) > 1e-6) fields.reject(key, "must have unit length");
}

void require_bright(JsonFields& fields, const char* key, const std::array<double, 3>& rgb) {
  for (const double v : rgb) {
    if (v <= 0) fields.reject(key, "must be above 0 in every channel");
  }
}

Result<Lights> lights_from_json(const Json& json, const std::string& where) {
  JsonFields fields(json, where);
  const std::string kind = fields.text("kind");
  if (kind == "near") {
    NearLights near;
    const Json& leds = fields.list("leds");
    for (std::size_t k = 0; k < leds.size(); ++k) {
      JsonFields led_fields(leds[k], fmt::format("{}: LED {}", where, k + 1));
      NearLight led;
      led.position_mm = led_fields.vec3("position_mm");
      led.aim = led_fields.vec3("aim");
      led.mu = led_fields.number("mu");
      led.flux_rgb = led_fields.rgb("flux_rgb");
      if (led_fields.has("log_gain_quadratic")) {
        const Json& q = led_fields.list("log_gain_quadratic");
        const bool six =
            q.size() == 6 && std::all_of(q.begin(), q.end(), [](const Json& v) { return v.is_number(); });
        if (six) {
          led.log_gain_quadratic = q.get<std::array<double, 6>>();
        } else {
          led_fields.reject("log_gain_quadratic", "must be six numbers");
        }
      }
      require_unit(led_fields, "aim", led.aim);
      require_bright(led_fields, "flux_rgb", led.flux_rgb);
      if (led.mu < 0) led_fields.reject("mu", "must not be negative");
      if (Result<void> ok = led_fields.status(); !ok) return std::move(ok).error();
      near.leds.push_back(led);
    }
    const Json& splines = fields.list("log_gain_rgb");
    if (splines.size() != 3) fields.reject("log_gain_rgb", "must be three splines");
    if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
    for (std::size_t c = 0; c < 3; ++c) {
      Result<GainSpline> spline = spline_from_json(splines[c], fmt::format("{}: log_gain_rgb {}", where, c));
      if (!spline) return std::move(spline).error();
      near.log_gain_rgb[c] = std::move(*spline);
    }
    return Lights(std::move(near));
  }
  DistantLights distant;
  if (kind != "distant") fields.reject("kind", "must be \"near\" or \"distant\"");
  const Json& list = fields.list("lights");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  for (std::size_t k = 0; k < list.size(); ++k) {
    JsonFields light_fields(list[k], fmt::format("{}: light {}", where, k + 1));
    const DistantLight light = {light_fields.vec3("direction"), light_fields.rgb("irradiance_rgb")};
    require_unit(light_fields, "direction", light.direction);
    require_bright(light_fields, "irradiance_rgb", light.irradiance_rgb);
    if (Result<void> ok = light_fields.status(); !ok) return std::move(ok).error();
    distant.lights.push_back(light);
  }
  return Lights(std::move(distant));
}

Result<std::vector<WhitePatch>> patches_from_json(const Json& list, const std::string& where) {
  std::vector<WhitePatch> patches;
  for (std::size_t i = 0; i < list.size(); ++i) {
    JsonFields fields(list[i], fmt::format("{}: patch {}", where, i + 1));
    WhitePatch patch;
    const Json& polygon = fields.list("polygon_px");
    for (const Json& corner : polygon) {
      if (!is_numbers(corner, 2)) {
        fields.reject("polygon_px", "must be pairs of numbers");
        break;
      }
      patch.polygon_px.push_back(corner.get<std::array<double, 2>>());
    }
    if (polygon.size() < 3) fields.reject("polygon_px", "must have three corners or more");
    patch.reflectance_rgb = fields.rgb("reflectance_rgb");
    require_bright(fields, "reflectance_rgb", patch.reflectance_rgb);
    patch.delta = fields.optional_number("delta").value_or(0);
    if (!(std::abs(patch.delta) < 1)) fields.reject("delta", "must be between -1 and 1");
    patch.height_mm = fields.optional_number("height_mm");
    if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
    patches.push_back(std::move(patch));
  }
  return patches;
}

Result<ParameterCovariance> covariance_from_json(const Json& json, const std::string& where) {
  JsonFields fields(json, where + ": covariance");
  ParameterCovariance covariance;
  for (const Json& name : fields.list("parameters")) {
    if (name.is_string()) {
      covariance.parameters.push_back(name.get<std::string>());
    } else {
      fields.reject("parameters", "must be names");
    }
  }
  const Json& rows = fields.list("matrix");
  const std::size_t n = covariance.parameters.size();
  bool good = rows.size() == n &&
              std::all_of(rows.begin(), rows.end(), [&](const Json& r) { return is_numbers(r, n); });
  for (std::size_t i = 0; good && i < n; ++i) {
    const auto at = [&](std::size_t row, std::size_t column) { return rows[row][column].get<double>(); };
    good = at(i, i) >= 0;
    for (std::size_t j = 0; good && j < n; ++j) {
      good = std::abs(at(i, j) - at(j, i)) <= 1e-9 * std::sqrt(at(i, i) * at(j, j));
      covariance.matrix.push_back(at(i, j));
    }
  }
  if (!good)
    fields.reject("matrix",
                  "must be symmetric, a row and a column for each parameter, none negative on its diagonal");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return covariance;
}

Json fiducials_json(const std::vector<Fiducial>& fiducials) {
  Json list = Json::array();
  for (const Fiducial& f : fiducials) {
    Json corners = Json::array();
    for (const Vec3& corner : f.corners_mm) corners.push_back(json_of(corner));
    list.push_back({{"dictionary", f.dictionary}, {"id", f.id}, {"corners_mm", std::move(corners)}});
  }
  return list;
}

Result<std::vector<Fiducial>> fiducials_from_json(const Json& list, const std::string& where) {
  std::vector<Fiducial> fiducials;
  for (std::size_t i = 0; i < list.size(); ++i) {
    JsonFields fields(list[i], fmt::format("{}: fiducial {}", where, i + 1));
    Fiducial fiducial = {fields.text("dictionary"), fields.integer("id"), {}};
    const Json& corners = fields.list("corners_mm");
    if (corners.size() != 4) fields.reject("corners_mm", "must be four points");
    for (std::size_t j = 0; j < 4 && fields.status(); ++j) {
      if (!is_numbers(corners[j], 3)) {
        fields.reject("corners_mm", "must be three numbers each");
        break;
      }
      const auto xyz = corners[j].get<std::array<double, 3>>();
      fiducial.corners_mm[j] = {xyz[0], xyz[1], xyz[2]};
    }
    if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
    fiducials.push_back(std::move(fiducial));
  }
  return fiducials;
}

// A part's optional list, read by `from_json`; empty where it is absent.
template <typename T>
Result<std::vector<T>> optional_list(const Json& json, const char* key, const std::string& where,
                                     Result<std::vector<T>> (*from_json)(const Json&, const std::string&)) {
  JsonFields fields(json, where);
  if (!fields.has(key)) return std::vector<T>();
  const Json& list = fields.list(key);
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return from_json(list, where);
}

Result<std::optional<ParameterCovariance>> optional_covariance(const Json& json, const std::string& where) {
  if (!JsonFields(json, where).has("covariance")) return std::optional<ParameterCovariance>();
  Result<ParameterCovariance> covariance = covariance_from_json(json["covariance"], where);
  if (!covariance) return std::move(covariance).error();
  return std::optional<ParameterCovariance>(std::move(*covariance));
}

// `key` of `json` as that many numbers.
template <std::size_t N>
std::array<double, N> numbers(JsonFields& fields, const Json& json, const char* key) {
  if (fields.has(key) && is_numbers(json[key], N)) return json[key].get<std::array<double, N>>();
  fields.reject(key, fmt::format("must be {} numbers", N));
  return {};
}

Result<std::optional<PointSpread>> optional_spread(const Json& json, const std::string& where) {
  if (!JsonFields(json, where).has("point_spread")) return std::optional<PointSpread>();
  JsonFields fields(json["point_spread"], where + ": point_spread");
  const PointSpread spread = {numbers<3>(fields, json["point_spread"], "sigma_px")};
  for (const double sigma_px : spread.sigma_px) {
    if (!(sigma_px >= 0 && sigma_px <= 10)) fields.reject("sigma_px", "must be 0 to 10");
  }
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return std::optional<PointSpread>(spread);
}

constexpr std::pair<const char*, RadialShift LateralColor::*> kShiftedColors[] = {
    {"red", &LateralColor::red}, {"blue", &LateralColor::blue}};

Json lateral_json(const LateralColor& lateral) {
  Json json = Json::object();
  for (const auto& [name, colour] : kShiftedColors) {
    const RadialShift& s = lateral.*colour;
    json[name] = {{"scale", s.scale},
                  {"cubic", s.cubic},
                  {"sigma_scale", s.sigma_scale},
                  {"sigma_cubic", s.sigma_cubic}};
  }
  return json;
}

Result<std::optional<LateralColor>> optional_lateral(const Json& json, const std::string& where) {
  JsonFields all(json, where);
  if (!all.has("lateral_color")) return std::optional<LateralColor>();
  const Json& colours = all.object("lateral_color");
  if (Result<void> ok = all.status(); !ok) return std::move(ok).error();
  LateralColor lateral;
  for (const auto& [name, colour] : kShiftedColors) {
    JsonFields both(colours, where + ": lateral_color");
    const Json& terms = both.object(name);
    if (Result<void> ok = both.status(); !ok) return std::move(ok).error();
    JsonFields fields(terms, fmt::format("{}: lateral_color: {}", where, name));
    const RadialShift shift = {fields.number("scale"), fields.number("cubic"), fields.number("sigma_scale"),
                               fields.number("sigma_cubic")};
    if (!(std::abs(shift.scale) <= 0.01)) fields.reject("scale", "must be -0.01 to 0.01");
    if (!(std::abs(shift.cubic) <= 1)) fields.reject("cubic", "must be -1 to 1");
    if (!(shift.sigma_scale >= 0)) fields.reject("sigma_scale", "must not be negative");
    if (!(shift.sigma_cubic >= 0)) fields.reject("sigma_cubic", "must not be negative");
    if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
    lateral.*colour = shift;
  }
  return std::optional<LateralColor>(lateral);
}

Result<std::optional<Veil>> optional_veil(const Json& json, const std::string& where) {
  if (!JsonFields(json, where).has("veil")) return std::optional<Veil>();
  JsonFields fields(json["veil"], where + ": veil");
  const Veil veil = {fields.number("share"), fields.number("sigma_share"), fields.number("spread")};
  if (!(veil.share >= 0 && veil.share <= 0.2)) fields.reject("share", "must be 0 to 0.2");
  if (!(veil.sigma_share >= 0)) fields.reject("sigma_share", "must not be negative");
  if (!(veil.spread >= 0.05 && veil.spread <= 10)) fields.reject("spread", "must be 0.05 to 10");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return std::optional<Veil>(veil);
}

}  // namespace

Json json_of(const CameraPart& part) {
  Json json = model_json(part.model);
  if (part.covariance || !part.fiducials.empty()) json["schema"] = "weft.camera/1.1";
  if (!part.fiducials.empty()) json["fiducials"] = fiducials_json(part.fiducials);
  if (part.covariance) json["covariance"] = covariance_json(*part.covariance);
  if (part.spread) {
    json["schema"] = "weft.camera/1.2";
    json["point_spread"] = {{"sigma_px", part.spread->sigma_px}};
  }
  if (part.lateral) {
    json["schema"] = "weft.camera/1.3";
    json["lateral_color"] = lateral_json(*part.lateral);
  }
  return json;
}

Result<CameraPart> camera_part_from_json(const Json& json, const std::string& where) {
  Result<CameraModel> model = model_from_json(json, where);
  if (!model) return std::move(model).error();
  Result<std::optional<ParameterCovariance>> covariance = optional_covariance(json, where);
  if (!covariance) return std::move(covariance).error();
  Result<std::vector<Fiducial>> fiducials = optional_list(json, "fiducials", where, fiducials_from_json);
  if (!fiducials) return std::move(fiducials).error();
  Result<std::optional<PointSpread>> spread = optional_spread(json, where);
  if (!spread) return std::move(spread).error();
  Result<std::optional<LateralColor>> lateral = optional_lateral(json, where);
  if (!lateral) return std::move(lateral).error();
  return CameraPart{*model, std::move(*covariance), std::move(*fiducials), *spread, *lateral};
}

Json json_of(const Response& r) {
  const char* version = r.veil                      ? "1.4"
                        : r.iso                     ? "1.3"
                        : r.black_counts            ? "1.2"
                        : r.exposure_ratios.empty() ? "1"
                                                    : "1.1";
  Json json = {{"schema", std::string("weft.response/") + version},
               {"electrons_per_count", r.electrons_per_count},
               {"read_noise_counts", r.read_noise_counts},
               {"linearity", r.linearity}};
  for (const ExposureRatio& e : r.exposure_ratios) {
    json["exposure_ratios"].push_back(
        {{"exposure_us", e.exposure_us}, {"to_exposure_us", e.to_exposure_us}, {"ratio", e.ratio}});
  }
  if (r.black_counts) json["black_counts"] = *r.black_counts;
  if (r.iso) json["iso"] = *r.iso;
  if (r.veil) {
    json["veil"] = {
        {"share", r.veil->share}, {"sigma_share", r.veil->sigma_share}, {"spread", r.veil->spread}};
  }
  return json;
}

Result<Response> response_from_json(const Json& json, const std::string& where) {
  JsonFields fields(json, where);
  Response r;
  r.electrons_per_count = fields.number("electrons_per_count");
  r.read_noise_counts = fields.number("read_noise_counts");
  const Json& linearity = fields.list("linearity");
  for (std::size_t c = 0; c < 3; ++c) {
    const bool good = c < linearity.size() && linearity[c].is_array() && linearity[c].size() == 2 &&
                      linearity[c][0].is_number() && linearity[c][1].is_number();
    if (!good) {
      fields.reject("linearity", "must be three pairs of numbers");
      break;
    }
    r.linearity[c] = linearity[c].get<std::array<double, 2>>();
  }
  if (r.electrons_per_count <= 0) fields.reject("electrons_per_count", "must be above 0");
  if (r.read_noise_counts < 0) fields.reject("read_noise_counts", "must not be negative");
  r.black_counts = fields.optional_number("black_counts");
  r.iso = fields.optional_number("iso");
  if (r.iso && *r.iso <= 0) fields.reject("iso", "must be above 0");
  const bool has_ratios = fields.has("exposure_ratios");
  const Json& ratios = has_ratios ? fields.list("exposure_ratios") : linearity;
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  if (has_ratios) {
    Result<std::vector<ExposureRatio>> read = exposure_ratios_from_json(ratios, where);
    if (!read) return std::move(read).error();
    r.exposure_ratios = std::move(*read);
  }
  Result<std::optional<Veil>> veil = optional_veil(json, where);
  if (!veil) return std::move(veil).error();
  r.veil = *veil;
  return r;
}

Json json_of(const ColorTransform& color) {
  Json json = {{"schema", "weft.color/1"},
               {"rec709_from_camera", color.rec709_from_camera},
               {"covariance", color.covariance}};
  if (color.curve) {
    json["curve"] = {
        {"before", color.curve->before}, {"cubic", color.curve->cubic}, {"after", color.curve->after}};
  }
  return json;
}

Result<ColorTransform> color_from_json(const Json& json, const std::string& where) {
  JsonFields fields(json, where);
  ColorTransform color;
  color.rec709_from_camera = fields.mat3("rec709_from_camera");
  for (const auto& row : color.rec709_from_camera) {
    if (std::abs(row[0] + row[1] + row[2] - 1) > 1e-6)
      fields.reject("rec709_from_camera", "must be three rows of three numbers that sum to 1");
  }
  const Json& covariance = fields.list("covariance");
  if (!covariance.empty() && !is_numbers(covariance, 81))
    fields.reject("covariance", "must be 81 numbers, or none");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  color.covariance = covariance.get<std::vector<double>>();
  if (fields.has("curve")) {
    const Json& curve = fields.object("curve");
    JsonFields curve_fields(curve, where + ": curve");
    color.curve =
        ColorCurve{numbers<12>(curve_fields, curve, "before"), numbers<12>(curve_fields, curve, "cubic"),
                   numbers<12>(curve_fields, curve, "after")};
    if (Result<void> ok = curve_fields.status(); !ok) return std::move(ok).error();
  }
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return color;
}

Json json_of(const LightsPart& part) {
  Json json = model_json(part.lights);
  if (!part.patches.empty() || part.covariance) json["schema"] = "weft.lights/1.1";
  const bool is_newer = std::any_of(part.patches.begin(), part.patches.end(), [](const WhitePatch& patch) {
    return patch.delta != 0 || patch.height_mm;
  });
  if (is_newer) json["schema"] = "weft.lights/1.2";
  if (!part.patches.empty()) json["patches"] = patches_json(part.patches);
  if (part.covariance) json["covariance"] = covariance_json(*part.covariance);
  return json;
}

Result<LightsPart> lights_part_from_json(const Json& json, const std::string& where) {
  Result<Lights> lights = lights_from_json(json, where);
  if (!lights) return std::move(lights).error();
  Result<std::vector<WhitePatch>> patches = optional_list(json, "patches", where, patches_from_json);
  if (!patches) return std::move(patches).error();
  Result<std::optional<ParameterCovariance>> covariance = optional_covariance(json, where);
  if (!covariance) return std::move(covariance).error();
  return LightsPart{std::move(*lights), std::move(*patches), std::move(*covariance)};
}

}  // namespace weft
