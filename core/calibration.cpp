// SPDX-License-Identifier: Apache-2.0
#include "core/calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/files.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSchema = "weft.calibration";
constexpr const char* kCameraFile = "camera.json";
constexpr const char* kResponseFile = "response.json";
constexpr const char* kLightsFile = "lights.json";
constexpr const char* kHotFile = "hot.png";

Json json_of(Vec3 v) {
  return Json::array({v.x, v.y, v.z});
}

Json to_json(const CameraModel& c) {
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

Result<CameraModel> camera_from_json(const Json& json, const std::string& where) {
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
  const Json& rotation = fields.list("camera_from_rig_rotation");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  for (std::size_t i = 0; i < 3; ++i) {
    const Json row = {{"row", i < rotation.size() ? rotation[i] : Json()}};
    JsonFields row_fields(row, where + ": camera_from_rig_rotation");
    c.camera_from_rig_rotation[i] = row_fields.rgb("row");
    if (Result<void> ok = row_fields.status(); !ok) return std::move(ok).error();
  }
  if (!is_rotation(c.camera_from_rig_rotation))
    fields.reject("camera_from_rig_rotation", "must be a rotation");
  c.camera_from_rig_translation_mm = fields.vec3("camera_from_rig_translation_mm");
  if (c.size.width < 1 || c.size.height < 1) fields.reject("width", "and \"height\" must be above 0");
  if (c.fx <= 0 || c.fy <= 0) fields.reject("fx", "and \"fy\" must be above 0");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return c;
}

Json to_json(const Response& r) {
  Json json = {{"schema", r.exposure_ratios.empty() ? "weft.response/1" : "weft.response/1.1"},
               {"electrons_per_count", r.electrons_per_count},
               {"read_noise_counts", r.read_noise_counts},
               {"linearity", r.linearity}};
  for (const ExposureRatio& e : r.exposure_ratios) {
    json["exposure_ratios"].push_back(
        {{"exposure_us", e.exposure_us}, {"to_exposure_us", e.to_exposure_us}, {"ratio", e.ratio}});
  }
  return json;
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
  const bool has_ratios = fields.has("exposure_ratios");
  const Json& ratios = has_ratios ? fields.list("exposure_ratios") : linearity;
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  if (has_ratios) {
    Result<std::vector<ExposureRatio>> read = exposure_ratios_from_json(ratios, where);
    if (!read) return std::move(read).error();
    r.exposure_ratios = std::move(*read);
  }
  return r;
}

// What lights.json holds.
struct LightsPart {
  Lights lights;
  std::vector<WhitePatch> patches;
  std::optional<LightCovariance> covariance;
};

Json to_json(const Lights& lights) {
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

Json lights_part_of(const Calibration& calibration) {
  Json json = to_json(*calibration.lights);
  if (!calibration.patches.empty() || calibration.light_covariance) json["schema"] = "weft.lights/1.1";
  for (const WhitePatch& patch : calibration.patches) {
    json["patches"].push_back({{"polygon_px", patch.polygon_px}, {"reflectance_rgb", patch.reflectance_rgb}});
  }
  if (calibration.light_covariance) {
    const auto& [parameters, matrix] = *calibration.light_covariance;
    Json rows = Json::array();
    for (auto row = matrix.begin(); row != matrix.end();) {
      const auto end = row + static_cast<std::ptrdiff_t>(parameters.size());
      rows.push_back(std::vector<double>(row, end));
      row = end;
    }
    json["covariance"] = {{"parameters", parameters}, {"matrix", std::move(rows)}};
  }
  return json;
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

bool is_numbers(const Json& list, std::size_t count) {
  return list.is_array() && list.size() == count &&
         std::all_of(list.begin(), list.end(), [](const Json& v) { return v.is_number(); });
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
    if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
    patches.push_back(std::move(patch));
  }
  return patches;
}

Result<LightCovariance> covariance_from_json(const Json& json, const std::string& where) {
  JsonFields fields(json, where + ": covariance");
  LightCovariance covariance;
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

Result<LightsPart> lights_part_from_json(const Json& json, const std::string& where) {
  Result<Lights> lights = lights_from_json(json, where);
  if (!lights) return std::move(lights).error();
  LightsPart part = {std::move(*lights), {}, {}};
  JsonFields fields(json, where);
  if (fields.has("patches")) {
    const Json& list = fields.list("patches");
    if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
    Result<std::vector<WhitePatch>> patches = patches_from_json(list, where);
    if (!patches) return std::move(patches).error();
    part.patches = std::move(*patches);
  }
  if (fields.has("covariance")) {
    Result<LightCovariance> covariance = covariance_from_json(json["covariance"], where);
    if (!covariance) return std::move(covariance).error();
    part.covariance = std::move(*covariance);
  }
  return part;
}

Result<void> check_digest(const fs::path& file, const Json& expected) {
  const Result<std::string> digest = sha256_of_file(file);
  if (!digest) return digest.error();
  if (expected == *digest) return {};
  return Error{ErrorKind::kBadData, "calibration part was changed after it was measured", file.string(),
               "its SHA-256 is not the one calibration.json names", "restore the folder, or calibrate again"};
}

// One part, if calibration.json names it, after its digest has been checked.
template <typename T>
Result<std::optional<T>> read_part(const fs::path& folder, const Json& parts, const char* name,
                                   const char* schema,
                                   Result<T> (*from_json)(const Json&, const std::string&)) {
  if (!parts.contains(name)) return std::optional<T>();
  const fs::path file = folder / name;
  if (Result<void> same = check_digest(file, parts[name]); !same) return std::move(same).error();
  const Result<Json> json = read_json(file, schema, 1);
  if (!json) return json.error();
  Result<T> part = from_json(*json, file.string());
  if (!part) return std::move(part).error();
  return std::optional<T>(std::move(*part));
}

Result<std::string> id_of(const fs::path& folder, std::map<std::string, std::string> digests) {
  const Result<std::string> own = sha256_of_file(folder / "calibration.json");
  if (!own) return own.error();
  digests["calibration.json"] = *own;
  std::string list;
  for (const auto& [name, digest] : digests) list += name + ' ' + digest + '\n';
  return sha256_of(list);
}

}  // namespace

std::optional<double> Response::exposure_ratio(double exposure_us, double to_exposure_us) const {
  const auto alike = [](double a, double b) { return std::abs(a - b) <= 1e-3 * b; };
  for (const ExposureRatio& e : exposure_ratios) {
    if (alike(e.exposure_us, exposure_us) && alike(e.to_exposure_us, to_exposure_us)) return e.ratio;
    if (alike(e.exposure_us, to_exposure_us) && alike(e.to_exposure_us, exposure_us)) return 1 / e.ratio;
  }
  return {};
}

Result<Calibration> read_calibration(const fs::path& folder) {
  const fs::path file = folder / "calibration.json";
  const Result<Json> document = read_json(file, kSchema, 1);
  if (!document) return document.error();
  JsonFields fields(*document, file.string());
  Calibration calibration;
  CalibrationSubject& subject = calibration.subject;
  subject.rig = fields.text("rig");
  subject.camera_model = fields.text("camera_model");
  subject.camera_serial = fields.text("camera_serial");
  subject.f_number = fields.number("f_number");
  subject.albedo_scale = fields.text("albedo_scale");
  const Json& parts = fields.object("parts");
  std::map<std::string, std::string> digests;
  for (const auto& [name, digest] : parts.items()) {
    if (digest.is_string()) {
      digests[name] = digest.get<std::string>();
    } else {
      fields.reject("parts", "must name a SHA-256 for each part");
    }
  }
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();

  auto camera = read_part<CameraModel>(folder, parts, kCameraFile, "weft.camera", camera_from_json);
  if (!camera) return std::move(camera).error();
  calibration.camera = *camera;
  auto response = read_part<Response>(folder, parts, kResponseFile, "weft.response", response_from_json);
  if (!response) return std::move(response).error();
  calibration.response = *response;
  auto lights = read_part<LightsPart>(folder, parts, kLightsFile, "weft.lights", lights_part_from_json);
  if (!lights) return std::move(lights).error();
  if (*lights) {
    calibration.lights = std::move((*lights)->lights);
    calibration.patches = std::move((*lights)->patches);
    calibration.light_covariance = std::move((*lights)->covariance);
  }
  if (parts.contains(kHotFile)) {
    calibration.hot_picture = folder / kHotFile;
    if (Result<void> same = check_digest(*calibration.hot_picture, parts[kHotFile]); !same) {
      return std::move(same).error();
    }
  }

  Result<std::string> id = id_of(folder, std::move(digests));
  if (!id) return std::move(id).error();
  calibration.id = std::move(*id);
  return calibration;
}

Result<Calibration> write_calibration(const fs::path& folder, Calibration calibration) {
  std::error_code failed;
  if (fs::exists(folder / "calibration.json", failed)) {
    return Error{ErrorKind::kCannotCreate, "cannot write calibration", folder.string(),
                 "there is one already, and calibrations are never changed", "name a new folder with -o"};
  }
  if (Result<void> made = make_writable_folder(folder); !made) return std::move(made).error();
  std::map<std::string, Json> files;
  if (calibration.camera) files[kCameraFile] = to_json(*calibration.camera);
  if (calibration.response) files[kResponseFile] = to_json(*calibration.response);
  if (calibration.lights) files[kLightsFile] = lights_part_of(calibration);

  std::map<std::string, std::string> digests;
  for (const auto& [name, json] : files) {
    if (Result<void> written = write_json(folder / name, json); !written) return std::move(written).error();
    Result<std::string> digest = sha256_of_file(folder / name);
    if (!digest) return std::move(digest).error();
    digests[name] = std::move(*digest);
  }
  if (calibration.hot_picture) {
    const Result<std::string> bytes = read_text(*calibration.hot_picture);
    if (!bytes) return bytes.error();
    calibration.hot_picture = folder / kHotFile;
    if (Result<void> copied = write_file(*calibration.hot_picture, *bytes); !copied) {
      return std::move(copied).error();
    }
    digests[kHotFile] = sha256_of(*bytes);
  }
  const CalibrationSubject& subject = calibration.subject;
  const Json document = {{"schema", std::string(kSchema) + "/1"},
                         {"rig", subject.rig},
                         {"camera_model", subject.camera_model},
                         {"camera_serial", subject.camera_serial},
                         {"f_number", subject.f_number},
                         {"albedo_scale", subject.albedo_scale},
                         {"parts", digests}};
  if (Result<void> written = write_json(folder / "calibration.json", document); !written) {
    return std::move(written).error();
  }
  Result<std::string> id = id_of(folder, std::move(digests));
  if (!id) return std::move(id).error();
  calibration.id = std::move(*id);
  return calibration;
}

}  // namespace weft
