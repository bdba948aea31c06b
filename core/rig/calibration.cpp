// SPDX-License-Identifier: Apache-2.0
#include "core/rig/calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "core/base/sha256.h"
#include "core/describe/field_json.h"
#include "core/rig/calibration_parts.h"
#include "core/rig/same_camera.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCalibrationSchema = "weft.calibration";
constexpr const char* kCameraFile = "camera.json";
constexpr const char* kResponseFile = "response.json";
constexpr const char* kColorFile = "color.json";
constexpr const char* kLightsFile = "lights.json";
constexpr const char* kHotFile = "hot.png";

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
                                   const char* schema) {
  if (!parts.contains(name)) return std::optional<T>();
  const fs::path file = folder / name;
  if (Result<void> same = check_digest(file, parts[name]); !same) return std::move(same).error();
  const Result<Json> json = read_json(file, schema, 1);
  if (!json) return json.error();
  Result<T> part = read_fields<T>(*json, file.string(), Naming::kFromOne);
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

using Digests = std::map<std::string, std::string>;

template <typename Part>
Result<void> write_part(const fs::path& folder, const char* name, const Part& part, Digests& digests) {
  Json document = {{"schema", schema_name(part)}};
  write_fields(document, part);
  if (Result<void> written = write_json(folder / name, document); !written) return written;
  Result<std::string> digest = sha256_of_file(folder / name);
  if (!digest) return std::move(digest).error();
  digests[name] = std::move(*digest);
  return {};
}

Result<void> copy_part(const fs::path& file, const fs::path& folder, const std::string& name,
                       Digests& digests) {
  const Result<std::string> bytes = read_text(file);
  if (!bytes) return bytes.error();
  digests[name] = sha256_of(*bytes);
  return write_file(folder / name, *bytes);
}

// Writes the parts that the calibration holds.
Result<void> write_parts(const fs::path& folder, const Calibration& c, Digests& digests) {
  Result<void> written;
  if (c.camera) {
    const CameraPart part = {*c.camera, c.camera_covariance, c.fiducials, c.spread, c.lateral};
    written = write_part(folder, kCameraFile, part, digests);
  }
  if (written && c.response) written = write_part(folder, kResponseFile, *c.response, digests);
  if (written && c.color) written = write_part(folder, kColorFile, *c.color, digests);
  if (written && c.lights) {
    const LightsPart part = {*c.lights, c.patches, c.light_covariance, c.points};
    written = write_part(folder, kLightsFile, part, digests);
  }
  if (written && c.hot_picture) written = copy_part(*c.hot_picture, folder, kHotFile, digests);
  return written;
}

// Copies the parts of the calibration `before` that have not been written.
Result<void> copy_other_parts(const fs::path& from, const Json& before, const fs::path& folder,
                              Digests& digests) {
  const Json parts = before.value("parts", Json::object());
  for (const auto& [name, digest] : parts.items()) {
    if (digests.contains(name)) continue;
    if (Result<void> copied = copy_part(from / name, folder, name, digests); !copied) return copied;
    if (digests[name] != digest) return check_digest(from / name, digest);
  }
  return {};
}

// Writes the reports of this step, and keeps those of earlier ones, but for maps of LEDs where it is the
// report of lights that they went with that is written anew.
Result<void> write_reports(const fs::path& from, const fs::path& folder, std::span<const NamedFile> reports) {
  std::error_code none;
  const bool lights_are_new = std::any_of(reports.begin(), reports.end(),
                                          [](const NamedFile& file) { return file.name == kLightsFile; });
  for (fs::directory_iterator entry(from / "report", none), end; !from.empty() && !none && entry != end;
       entry.increment(none)) {
    if (!entry->is_regular_file(none)) continue;
    if (lights_are_new && entry->path().filename().string().starts_with("led")) continue;
    fs::copy_file(entry->path(), folder / entry->path().filename(), none);
    if (none) return cannot_write(folder / entry->path().filename(), none.value());
  }
  for (const NamedFile& file : reports) {
    if (Result<void> written = write_file(folder / file.name, file.bytes); !written) return written;
  }
  return {};
}

// `before` is the calibration.json that this one derives from: what a newer version of weft said there stays.
Result<void> write_subject(const fs::path& folder, const CalibrationSubject& subject, const Digests& digests,
                           const Json& before) {
  const char* minor = subject.focal_length_mm > 0 ? ".2" : subject.measured.empty() ? "" : ".1";
  Json document = {{"schema", fmt::format("{}/1{}", kCalibrationSchema, minor)}};
  write_fields(document, subject);
  document["parts"] = digests;
  for (const auto& [name, value] : before.items()) {
    if (document.contains(name) || name == "measured" || name == "focal_length_mm") continue;
    document[name] = value;
    document["schema"] = before["schema"];
  }
  return write_json(folder / "calibration.json", document);
}

Error there_is_one(const fs::path& folder) {
  return {ErrorKind::kCannotCreate, "cannot write calibration", folder.string(),
          "there is one already, and calibrations are never changed", "name a new folder with -o"};
}

}  // namespace

bool CountLevels::are_of(const RawFrame& frame) const {
  constexpr double kSame = 0.5;  // counts
  bool same = std::abs(white - static_cast<double>(frame.white)) < kSame;
  for (std::size_t i = 0; i < 4; ++i)
    same = same && std::abs(black[i] - static_cast<double>(frame.black[i / 2][i % 2])) < kSame;
  return same;
}

void describe(Fields& fields, CalibrationSubject& s) {
  fields.value({"rig", "Its name", {}, kMustSay}, s.rig);
  fields.value({"camera_model", "As the camera names itself", {}, kMustSay}, s.camera_model);
  fields.value({"camera_serial", "Its serial number", {}, kMustSay}, s.camera_serial);
  fields.value({"f_number", "Aperture", {}, kMustSay}, s.f_number);
  fields.choice({"albedo_scale", "Whether albedo is a reflectance", {}, kMustSay}, s.albedo_scale,
                kAlbedoScaleNames);
  fields.value({"measured", "When, ISO 8601; since 1.1", {}, kUnlessEmpty}, s.measured);
  fields.value({"focal_length_mm", "That the lens was set to; since 1.2", kAboveZero, kUnlessEmpty},
               s.focal_length_mm);
}

std::optional<double> Response::exposure_ratio(double exposure_us, double to_exposure_us) const {
  for (const ExposureRatio& e : exposure_ratios) {
    const auto is_of = [&e](double a, double b) {
      return same_setting(e.exposure_us, a) && same_setting(e.to_exposure_us, b);
    };
    if (is_of(exposure_us, to_exposure_us)) return e.ratio;
    if (is_of(to_exposure_us, exposure_us)) return 1 / e.ratio;
  }
  return {};
}

std::vector<double> Response::exposures_beside(double exposure_us) const {
  std::vector<double> times_us;
  for (const ExposureRatio& e : exposure_ratios) {
    if (same_setting(e.exposure_us, exposure_us)) times_us.push_back(e.to_exposure_us);
    if (same_setting(e.to_exposure_us, exposure_us)) times_us.push_back(e.exposure_us);
  }
  std::ranges::sort(times_us);
  return times_us;
}

Result<Calibration> read_calibration(const fs::path& folder) {
  const fs::path file = folder / "calibration.json";
  const Result<Json> document = read_json(file, kCalibrationSchema, 1);
  if (!document) return document.error();
  JsonFields fields(*document, file.string());
  Calibration calibration;
  Result<CalibrationSubject> subject = read_fields<CalibrationSubject>(*document, file.string());
  if (!subject) return std::move(subject).error();
  calibration.subject = std::move(*subject);
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

  auto camera = read_part<CameraPart>(folder, parts, kCameraFile, "weft.camera");
  if (!camera) return std::move(camera).error();
  if (*camera) {
    calibration.camera = (*camera)->model;
    calibration.camera_covariance = std::move((*camera)->covariance);
    calibration.fiducials = std::move((*camera)->fiducials);
    calibration.spread = (*camera)->spread;
    calibration.lateral = (*camera)->lateral;
  }
  auto response = read_part<Response>(folder, parts, kResponseFile, "weft.response");
  if (!response) return std::move(response).error();
  calibration.response = *response;
  auto color = read_part<ColorTransform>(folder, parts, kColorFile, "weft.color");
  if (!color) return std::move(color).error();
  calibration.color = std::move(*color);
  auto lights = read_part<LightsPart>(folder, parts, kLightsFile, "weft.lights");
  if (!lights) return std::move(lights).error();
  if (*lights) {
    calibration.lights = std::move((*lights)->lights);
    calibration.patches = std::move((*lights)->patches);
    calibration.points = std::move((*lights)->points);
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
  if (is_there(folder / "calibration.json")) return there_is_one(folder);
  if (Result<void> made = make_writable_folder(folder); !made) return std::move(made).error();
  Digests digests;
  if (Result<void> ok = write_parts(folder, calibration, digests); !ok) return std::move(ok).error();
  if (calibration.hot_picture) calibration.hot_picture = folder / kHotFile;
  if (Result<void> ok = write_subject(folder, calibration.subject, digests, Json::object()); !ok)
    return std::move(ok).error();
  Result<std::string> id = id_of(folder, std::move(digests));
  if (!id) return std::move(id).error();
  calibration.id = std::move(*id);
  return calibration;
}

Result<Calibration> derive_calibration(const fs::path& from, Calibration change, const fs::path& folder,
                                       std::span<const NamedFile> report) {
  if (is_there(folder)) return there_is_one(folder);
  Json before = Json::object();
  if (!from.empty()) {
    Result<Json> document = read_json(from / "calibration.json", kCalibrationSchema, 1);
    if (!document) return std::move(document).error();
    before = std::move(*document);
  }
  PartialFolder partial(folder);
  if (Result<void> made = make_writable_folder(partial.path() / "report"); !made)
    return std::move(made).error();
  Digests digests;
  Result<void> written = write_parts(partial.path(), change, digests);
  if (written) written = copy_other_parts(from, before, partial.path(), digests);
  if (change.subject.measured.empty()) {
    change.subject.measured = iso_time_now();
  }
  if (written) written = write_subject(partial.path(), change.subject, digests, before);
  if (written) written = write_reports(from, partial.path() / "report", report);
  if (written) written = partial.publish();
  if (!written) return std::move(written).error();
  return read_calibration(folder);
}

}  // namespace weft
