// SPDX-License-Identifier: Apache-2.0
#include "solve/run/look_at_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"

namespace weft::app {
namespace {

std::string name_of_light(const solve::ListedLight& light) {
  return light.photograph.empty() ? light.name : light.photograph.filename().string();
}

void print_lights(const solve::LightsReport& report, const solve::LightsOptions& a) {
  const solve::LightList& list = report.list;
  print(fmt::format("{}: {}", list.file.string(), solve::words_of(list)));
  std::size_t width = 10;
  for (const solve::ListedLight& light : list.lights) width = std::max(width, name_of_light(light).size());
  std::string head =
      fmt::format("  {:>4}  {:{}}  {:>8}  {:>9}", "no.", "photograph", width, "azimuth", "elevation");
  if (list.are_positions) head += fmt::format("  {:>27}", "position");
  if (list.have_strengths) head += fmt::format("  {:>23}", "strength R G B");
  print(head);
  for (std::size_t k = 0; k < list.lights.size(); ++k) {
    const solve::ListedLight& light = list.lights[k];
    const solve::LightAngles angles = solve::angles_of(light);
    std::string line = fmt::format("  {:>4}  {:{}}  {:>8.2f}  {:>9.2f}", k + 1, name_of_light(light), width,
                                   angles.azimuth_deg, angles.elevation_deg);
    if (list.are_positions)
      line += fmt::format("  {:>9.5g}{:>9.5g}{:>9.5g}", light.toward.x, light.toward.y, light.toward.z);
    const std::array<double, 3>& s = light.strength_rgb;
    if (list.have_strengths) line += fmt::format("  {:>7.4g} {:>7.4g} {:>7.4g}", s[0], s[1], s[2]);
    print(line);
  }
  if (!report.not_found.empty()) print("warning: " + report.not_found);
  if (!a.output.empty()) print(a.output.string());
  if (!a.picture.empty()) print(a.picture.string());
}

Result<int> look_at(const solve::LightsOptions& a, const CommonArguments& common) {
  const Result<solve::LightsReport> report = solve::look_at_lights(a);
  if (!report) return report.error();
  if (common.json) {
    print_json(json_of(*report));
  } else {
    print_lights(*report, a);
  }
  return kDone;
}

Run add_lights(Options& options) {
  const auto a = std::make_shared<solve::LightsOptions>();
  options
      .add(
          "source", &a->source,
          "Light file (.lp, light_directions.txt, CSV, .npy, .dome, .relight, JSON of Meshroom), or a folder "
          "that has one")
      .required();
  options.add("--photos", &a->photographs, "Folder of the photographs, where the light file does not say it");
  options.add("-o,--output", &a->output, "Light file to write: .lp, names relative to it");
  options.add("--picture", &a->picture, "SVG to draw: each light in the hemisphere above the table");
  return [a](const CommonArguments& common) { return look_at(*a, common); };
}

}  // namespace

Verb lights_verb() {
  return {"lights", "Show the lights of photographs, as any light file has them, and write an .lp",
          add_lights};
}

}  // namespace weft::app
