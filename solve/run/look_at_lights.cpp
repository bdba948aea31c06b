// SPDX-License-Identifier: Apache-2.0
#include "solve/run/look_at_lights.h"

#include <fmt/format.h>

#include <cmath>
#include <system_error>
#include <utility>

#include "core/base/files.h"
#include "report/hemisphere.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

Result<LightList> read_source(const LightsOptions& options) {
  std::error_code ignored;
  if (!fs::is_directory(options.source, ignored)) return read_light_list(options.source);
  const Result<fs::path> file = find_light_file(options.source);
  return file ? read_light_list(*file) : file.error();
}

// As an RTI light file.
std::string light_file_of(const LightList& list, const fs::path& folder) {
  std::string text = fmt::format("{}\n", list.lights.size());
  for (std::size_t k = 0; k < list.lights.size(); ++k) {
    const ListedLight& light = list.lights[k];
    const std::string name =
        !light.photograph.empty()
            ? fs::absolute(light.photograph).lexically_normal().lexically_relative(folder).string()
        : !light.name.empty() ? light.name
                              : fmt::format("{:03}", k + 1);
    text += fmt::format("{} {} {} {}", name, light.toward.x, light.toward.y, light.toward.z);
    const std::array<double, 3>& s = light.strength_rgb;
    if (list.have_strengths) text += fmt::format(" {} {} {}", s[0], s[1], s[2]);
    text += '\n';
  }
  return text;
}

Result<void> write_new(const fs::path& file, const std::string& text) {
  if (Result<void> ok = refuse_existing(file); !ok) return ok;
  return write_file(file, text);
}

}  // namespace

Result<void> refuse_existing(const fs::path& file) {
  if (!is_there(file)) return {};
  return Error{ErrorKind::kCannotCreate, "a file of that name is there", file.string(),
               "light files and pictures are never overwritten", "choose another name with -o, or remove it"};
}

Result<void> write_light_file(const LightList& list, const fs::path& file) {
  return write_new(file, light_file_of(list, fs::absolute(file).lexically_normal().parent_path()));
}

LightAngles angles_of(const ListedLight& light) {
  const Vec3 d = light.direction();
  return {degrees(std::atan2(d.y, d.x)), degrees(std::atan2(d.z, std::hypot(d.x, d.y)))};
}

std::string picture_of(const LightList& list) {
  report::Hemisphere drawing = {.title = fmt::format("{}: {} lights, x to the right, y up",
                                                     list.file.filename().string(), list.lights.size()),
                                .unit = ""};
  for (const ListedLight& light : list.lights) {
    const LightAngles angles = angles_of(light);
    drawing.leds.push_back({90 - angles.elevation_deg, angles.azimuth_deg, 0});
  }
  return report::hemisphere_svg(drawing);
}

Result<LightsReport> look_at_lights(const LightsOptions& options) {
  Result<LightList> list = read_source(options);
  if (!list) return std::move(list).error();
  LightsReport report = {.list = std::move(*list), .not_found = {}};
  std::error_code ignored;
  PhotographPlace place = {.folder = options.photographs};
  if (place.folder.empty() && fs::is_directory(options.source, ignored)) place.folder = options.source;
  if (const Result<void> found = find_photographs(place, report.list); !found)
    report.not_found = found.error().message();
  if (!options.output.empty()) {
    if (Result<void> ok = write_light_file(report.list, options.output); !ok) return std::move(ok).error();
  }
  if (!options.picture.empty()) {
    if (Result<void> ok = write_new(options.picture, picture_of(report.list)); !ok)
      return std::move(ok).error();
  }
  return report;
}

Json json_of(const LightsReport& report) {
  Json lights = Json::array();
  for (const ListedLight& light : report.list.lights) {
    const LightAngles angles = angles_of(light);
    const std::array<double, 3> toward = {light.toward.x, light.toward.y, light.toward.z};
    lights.push_back({{"name", light.name},
                      {"photograph", light.photograph.string()},
                      {report.list.are_positions ? "position" : "direction", toward},
                      {"azimuth_deg", angles.azimuth_deg},
                      {"elevation_deg", angles.elevation_deg},
                      {"strength_rgb", light.strength_rgb}});
  }
  return {{"file", report.list.file.string()},
          {"kind", report.list.kind},
          {"lights", std::move(lights)},
          {"assumed", report.list.assumed},
          {"not_found", report.not_found}};
}

}  // namespace weft::solve
