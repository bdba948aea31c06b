// SPDX-License-Identifier: Apache-2.0
#include "solve/run/look_at_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "calibration/run/balls.h"
#include "core/base/number.h"

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

// "X,Y,R", pixels.
Result<calibration::Circle> circle_of(const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find(',', from), text.size());
    if (const std::optional<double> number = as_number(text.substr(from, end - from)))
      numbers.push_back(*number);
    from = end + 1;
  }
  if (numbers.size() == 3 && numbers[2] > 0 && std::ranges::count(text, ',') == 2)
    return calibration::Circle{numbers[0], numbers[1], numbers[2]};
  return Error{ErrorKind::kUsage, "a ball cannot be placed so", "--ball", fmt::format("\"{}\"", text),
               "give centre and radius in pixels, as in --ball 812,640,95; name the folder before --ball"};
}

// What an option needs besides --ball.
struct BallArguments {
  calibration::BallsOptions options;
  std::vector<std::string> places;
  std::optional<Option> ball, ball_folder;

  bool are_given() const { return ball->is_given() || ball_folder->is_given(); }
};

void print_balls(const calibration::BallsReport& report) {
  for (const calibration::FoundBall& ball : report.lights.balls) {
    const calibration::Circle& c = ball.outline.circle;
    print(fmt::format("{} ball at {:.1f}, {:.1f}, radius {:.1f} pixels, +- {:.2f}", name_of(ball.kind), c.x,
                      c.y, c.radius, ball.outline.sigma_px));
  }
  std::size_t width = 10;
  for (const solve::ListedLight& light : report.list.lights) width = std::max(width, light.name.size());
  const auto& lamps = report.lights.lamps;
  const bool placed =
      std::ranges::any_of(lamps, [](const auto& lamp) { return lamp.position_mm.has_value(); });
  std::string head = fmt::format("  {:>4}  {:{}}  {:>8}  {:>9}  {:>7}", "no.", "photograph", width, "azimuth",
                                 "elevation", "+- deg");
  if (placed) head += fmt::format("  {:>24}  {:>6}", "position mm", "+- mm");
  print(lamps.front().strength ? head + fmt::format("  {:>8}", "strength") : head);
  for (std::size_t k = 0; k < lamps.size(); ++k) {
    const solve::ListedLight& light = report.list.lights[k];
    const solve::LightAngles angles = solve::angles_of(light);
    std::string line = fmt::format("  {:>4}  {:{}}  {:>8.2f}  {:>9.2f}  {:>7.2f}", k + 1, light.name, width,
                                   angles.azimuth_deg, angles.elevation_deg, lamps[k].sigma_deg);
    if (const auto& p = lamps[k].position_mm) {
      line +=
          fmt::format("  {:>8.0f}{:>8.0f}{:>8.0f}  {:>6.0f}", p->x, p->y, p->z, lamps[k].position_sigma_mm);
    } else if (placed) {
      line += fmt::format("  {:>32}", "not known");
    }
    if (lamps[k].strength) line += fmt::format("  {:>8.4f}", *lamps[k].strength);
    print(line);
  }
  for (const std::string& note : report.notes) print("note: " + note);
  for (const auto& file : {report.list.file, report.picture, report.mask})
    if (!file.empty()) print(file.string());
}

Result<int> look_at_balls(const solve::LightsOptions& a, BallArguments b, const CommonArguments& common) {
  if (!a.picture.empty()) {
    return Error{ErrorKind::kUsage, "options do not go together", "--picture, --ball",
                 "a ball has a picture of its own, balls.png", "give one of them"};
  }
  b.options.photographs = a.source;
  b.options.output = a.output;
  std::erase(b.places, "");  // --ball alone
  for (const std::string& place : b.places) {
    const Result<calibration::Circle> circle = circle_of(place);
    if (!circle) return circle.error();
    b.options.ball.told.push_back(*circle);
  }
  const Result<calibration::BallsReport> report = calibration::lights_by_balls(b.options);
  if (!report) return report.error();
  if (common.json) {
    print_json(json_of(*report));
  } else {
    print_balls(*report);
  }
  return kDone;
}

void add_ball(Options& options, BallArguments& b) {
  b.ball = options
               .add("--ball", &b.places,
                    "Tell the lights from a chrome, glossy or matt ball in the photographs: found by itself, "
                    "or about X,Y,R in pixels. Writes lights.lp, balls.png and mask.png into the folder")
               .takes(0, 16);
  b.ball_folder =
      options.add("--ball-folder", &b.options.ball_folder,
                  "Photographs of the ball alone under the same lamps, by name or in the same order");
  options.add_word(
      "--ball-kind", {"auto", "chrome", "glossy", "matt"}, 0,
      [&b](std::size_t chosen) {
        if (chosen > 0) b.options.ball.kind = static_cast<calibration::BallKind>(chosen - 1);
      },
      "What the ball is. Strengths of a mirror need it");
  options.add("--ball-mm", &b.options.ball.ball_mm, "Diameter of the balls: two of them tell where lamps are")
      .above_zero();
  options
      .add("--fov", &b.options.ball.fov_deg,
           "Field of view of the photographs' width, degrees; without it the camera is far away")
      .in_range(0.1, 150.0);
  options.add_choice("--transfer", &b.options.transfer, kTransferNames,
                     "How values of photographs follow light");
}

Run add_lights(Options& options) {
  const auto a = std::make_shared<solve::LightsOptions>();
  const auto b = std::make_shared<BallArguments>();
  options
      .add(
          "source", &a->source,
          "Light file (.lp, light_directions.txt, CSV, .npy, .dome, .relight, JSON of Meshroom), or a folder "
          "that has one")
      .required();
  options.add("--photos", &a->photographs, "Folder of the photographs, where the light file does not say it");
  options.add("-o,--output", &a->output, "Light file to write: .lp, names relative to it");
  options.add("--picture", &a->picture, "SVG to draw: each light in the hemisphere above the table");
  add_ball(options, *b);
  return [a, b](const CommonArguments& common) {
    return b->are_given() ? look_at_balls(*a, *b, common) : look_at(*a, common);
  };
}

}  // namespace

Verb lights_verb() {
  return {"lights", "Show the lights of photographs, from a light file or a ball, and write an .lp",
          add_lights};
}

}  // namespace weft::app
