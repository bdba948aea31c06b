// SPDX-License-Identifier: Apache-2.0
#include "bench/calibration/calibration_studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "calibration/color/color_fit.h"
#include "calibration/run/calibrate_camera.h"
#include "calibration/run/calibrate_color.h"
#include "calibration/run/calibrate_lights.h"
#include "calibration/run/calibrate_response.h"
#include "calibration/run/check.h"
#include "core/base/temporary_folder.h"
#include "core/image_io/image_io.h"
#include "simulator/captures.h"
#include "simulator/scene/scene.h"
#include "simulator/simulate.h"
#include "solve/run/solve_session.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;
using simulator::Scene;

constexpr double kTilt_deg = 20, kGrey = 0.5;
constexpr double kAzimuths_deg[] = {0, 90, 180, 270};
constexpr int kSpot_px = 64, kChartSquare_px = 32;

/// The rig over a surface of its own, nothing else on the table.
Scene bare(Scene scene) {
  scene.targets.clear();
  return scene;
}

/// Normals of 20 degrees everywhere on the table's plane: light falls as on a cloth of that slope.
Scene sloped(Scene scene, double azimuth_deg) {
  scene = bare(std::move(scene));
  scene.geometry = {};
  scene.geometry.kind = simulator::GeometryKind::kTilted;
  scene.geometry.tilt_deg = kTilt_deg;
  scene.geometry.azimuth_deg = azimuth_deg;
  scene.material = {};
  scene.material.dye = simulator::flat_spectrum(kGrey);
  scene.effects.relief = false;
  return scene;
}

Vec3 sloped_normal(double azimuth_deg) {
  const double t = radians(kTilt_deg), a = radians(azimuth_deg);
  return {std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t)};
}

std::string plane_name(double azimuth_deg) {
  return fmt::format("plane{:03.0f}.weft", azimuth_deg);
}

/// A square of a map as its mean.
Vec3 mean_of(const Image<float>& map, int x0, int y0, int side) {
  Vec3 sum;
  int n = 0;
  for (int y = y0; y < std::min(y0 + side, map.height()); ++y) {
    for (int x = x0; x < std::min(x0 + side, map.width()); ++x) {
      const Vec3 value = {map(x, y, 0), map(x, y, 1), map(x, y, 2)};
      if (!std::isfinite(value.x + value.y + value.z)) continue;
      sum = sum + value;
      ++n;
    }
  }
  return n > 0 ? 1.0 / n * sum : Vec3{0, 0, 1};
}

/// Normals over a plane against what they are.
struct PlaneScore {
  double centre_deg = 0, corner_deg = 0, gain = 0;
};

PlaneScore score_of(const Image<float>& normals, Vec3 truth) {
  const int w = normals.width(), h = normals.height();
  const auto bias = [&](int x0, int y0) { return angle_deg(mean_of(normals, x0, y0, kSpot_px), truth); };
  PlaneScore score;
  score.centre_deg = bias((w - kSpot_px) / 2, (h - kSpot_px) / 2);
  for (const int x0 : {0, w - kSpot_px}) {
    for (const int y0 : {0, h - kSpot_px}) score.corner_deg = std::max(score.corner_deg, bias(x0, y0));
  }
  const Vec3 slope = {-truth.x / truth.z, -truth.y / truth.z, 0};
  int n = 0;
  for (int y = 0; y + kSpot_px <= h; y += kSpot_px) {
    for (int x = 0; x + kSpot_px <= w; x += kSpot_px, ++n) {
      const Vec3 m = mean_of(normals, x, y, kSpot_px);
      score.gain += dot({-m.x / m.z, -m.y / m.z, 0}, slope) / dot(slope, slope);
    }
  }
  score.gain /= n;
  return score;
}

struct ColorScore {
  double relative = 0, ciede2000 = 0;
};

/// Albedo in squares that show many yarns each, so that noise and demosaicing say nothing; `truth_at` gives
/// what the square from (x0, y0) on should be.
template <typename TruthAt>
ColorScore color_score_of(const Image<float>& albedo, const TruthAt& truth_at) {
  ColorScore score;
  int n = 0;
  for (int y = 0; y + kChartSquare_px <= albedo.height(); y += kChartSquare_px) {
    for (int x = 0; x + kChartSquare_px <= albedo.width(); x += kChartSquare_px, ++n) {
      const Vec3 a = mean_of(albedo, x, y, kChartSquare_px), b = truth_at(x, y);
      score.relative += (std::abs(a.x / b.x - 1) + std::abs(a.y / b.y - 1) + std::abs(a.z / b.z - 1)) / 3;
      score.ciede2000 += calibration::ciede2000_of({a.x, a.y, a.z}, {b.x, b.y, b.z});
    }
  }
  score.relative /= n;
  score.ciede2000 /= n;
  return score;
}

class Walkthrough {
 public:
  Walkthrough(Scene scene, const StudyOptions& options)
      : scene_(std::move(scene)), context_{options.threads} {
    simulate_.tiles.threads = options.threads;
  }

  Result<Rows> run() {
    if (Result<void> ok = photograph(); !ok) return ok.error();
    if (Result<void> ok = calibrate(); !ok) return ok.error();
    Rows rows;
    for (const auto& [name, folder] : contenders_) {
      if (Result<void> ok = add_row(rows, score(name, folder)); !ok) return ok.error();
    }
    rows.push_back({{"calibration", "asked of ours"},
                    {"chi-square", "0.9 to 1.1"},
                    {"centre, degrees", 0.25},
                    {"corner, degrees", 0.35},
                    {"slope gain", "1 +- 0.01"},
                    {"gain farthest off 1", 0.01},
                    {"sheet rms, degrees", 0.15},
                    {"sheet slope gain", "1 +- 0.01"},
                    {"grey albedo error, percent", 2},
                    {"albedo error, percent", 2},
                    {"CIEDE2000", 1.5}});
    return rows;
  }

 private:
  fs::path at(const std::string& name) const { return scratch_.path() / name; }

  Result<void> photograph() {
    simulator::CapturesOptions options;
    options.simulate = simulate_;
    const auto captures = simulator::simulate_captures(scene_, scratch_.path(), options);
    if (!captures) return captures.error();
    for (const double azimuth : kAzimuths_deg) {
      const auto plane = simulate_session(sloped(scene_, azimuth), at(plane_name(azimuth)), simulate_);
      if (!plane) return plane.error();
    }
    const auto cloth = simulate_session(bare(scene_), at("cloth.weft"), simulate_);
    return cloth ? Result<void>() : cloth.error();
  }

  Result<void> calibrate() {
    calibration::CalibrateCameraOptions boards;
    boards.input = at("camera");
    boards.output = at("c1");
    boards.rig = "virtual rig";
    const auto camera = calibrate_camera(boards, context_);
    if (!camera) return camera.error();
    const auto response = calibration::calibrate_response({at("response"), at("c1"), at("c2"), {}}, context_);
    if (!response) return response.error();
    contenders_.push_back({"none: tape and data sheets", at("start")});
    constexpr std::pair<const char*, calibration::LightsMethod> kMethods[] = {
        {"seed", calibration::LightsMethod::kSeed},
        {"per pixel", calibration::LightsMethod::kPerPixel},
        {"ours", calibration::LightsMethod::kPhysical}};
    for (const auto& [name, method] : kMethods) {
      calibration::CalibrateLightsOptions lights = {at("lights"), at("c2"),
                                                    at(fmt::format("lights {}", name))};
      lights.method = method;
      lights.accept_misfit = true;  // the row says it
      const auto lit = calibrate_lights(lights, context_);
      if (!lit) return lit.error();
      chi_square_[name] = lit->report.numbers.value("chi_square", 0.0);
      if (method == calibration::LightsMethod::kPhysical) delta_ = lit->report.numbers.value("delta", 0.0);
      const fs::path whole = at(fmt::format("whole {}", name));
      const auto color =
          calibration::calibrate_color({at("color"), lights.output, whole, {}, {}, false}, context_);
      if (!color) return color.error();
      contenders_.push_back({name, whole});
    }
    // What is left when lens, sensor and lights are known exactly, and only the colours are measured.
    const fs::path exact = at("cloth.weft") / "calibration";
    const auto color =
        calibration::calibrate_color({at("color"), exact, at("exact"), {}, {}, false}, context_);
    if (!color) return color.error();
    contenders_.push_back({"exact, and its colours by the chart", at("exact")});
    return {};
  }

  Result<Image<float>> solved(const std::string& session, const fs::path& calibration, const char* map) {
    const fs::path folder = at(fmt::format("solve {} {}", session, calibration.filename().string()));
    const auto report =
        solve::solve_session({at(session), calibration, {}}, {.output = folder, .previews = false}, context_);
    if (!report) return report.error();
    auto image = read_image(folder / map);
    if (!image) return std::move(image).error();
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    return std::move(image->planes);
  }

  Result<Json> score(const std::string& name, const fs::path& calibration) {
    PlaneScore worst;
    double farthest = 0;
    for (const double azimuth : kAzimuths_deg) {
      const auto normals = solved(plane_name(azimuth), calibration, "normal.exr");
      if (!normals) return normals.error();
      const PlaneScore one = score_of(*normals, sloped_normal(azimuth));
      worst.centre_deg = std::max(worst.centre_deg, one.centre_deg);
      worst.corner_deg = std::max(worst.corner_deg, one.corner_deg);
      worst.gain += one.gain / std::size(kAzimuths_deg);
      farthest = std::max(farthest, std::abs(one.gain - 1));
    }
    const auto check = calibration::calibrate_check(
        {.input = at("check"), .from = calibration, .paper_delta = delta_}, context_);
    if (!check) return check.error();
    double sheet_deg = 0, sheet_gain = 0;
    for (const Json& sheet : check->report.numbers["sheets"]) {
      if (sheet.contains("slope_gain"))
        sheet_gain = sheet["slope_gain"];
      else
        sheet_deg = std::max(sheet_deg, sheet["rms_deg"].get<double>());
    }
    const auto albedo = solved("cloth.weft", calibration, "albedo.exr");
    if (!albedo) return albedo.error();
    const auto truth = read_image(at("cloth.weft") / "truth" / "albedo.exr");
    if (!truth) return truth.error();
    const ColorScore color = color_score_of(
        *albedo, [&](int x0, int y0) { return mean_of(truth->planes, x0, y0, kChartSquare_px); });
    const auto grey = solved(plane_name(kAzimuths_deg[0]), calibration, "albedo.exr");
    if (!grey) return grey.error();
    return Json{{"calibration", name},
                {"chi-square", chi_square_.contains(name) ? Json(chi_square_.at(name)) : Json()},
                {"centre, degrees", worst.centre_deg},
                {"corner, degrees", worst.corner_deg},
                {"slope gain", worst.gain},
                {"gain farthest off 1", farthest},
                {"sheet rms, degrees", sheet_deg},
                {"sheet slope gain", sheet_gain},
                {"grey albedo error, percent", 100 * color_score_of(*grey,
                                                                    [](int, int) {
                                                                      return Vec3{kGrey, kGrey, kGrey};
                                                                    })
                                                         .relative},
                {"albedo error, percent", 100 * color.relative},
                {"CIEDE2000", color.ciede2000}};
  }

  Scene scene_;
  JobContext context_;
  simulator::SimulateOptions simulate_;
  TemporaryFolder scratch_;
  std::vector<std::pair<std::string, fs::path>> contenders_;
  std::map<std::string, double> chi_square_;  ///< of the fits of lights
  double delta_ = 0;                          ///< of the paper, as our fit found it
};

}  // namespace

/// A rig calibrated from its own captures (simulator/captures.h): camera, response, lights and colour, one
/// after the other. Then, with no calibration but the tape measure, with lights by the seed's iteration, by
/// the pixel and by ours (misfits accepted, their chi-square told), and with the rig's truth but for colours:
/// grey planes of 20 degrees towards four sides are solved, and a cloth, and sheets that lights were not
/// fitted to are checked. Columns: the worst bias of normals at the centre and in the corners of the frame
/// (means of 64 pixels), slope gain over the frame, rms of a flat sheet and the slope gain of a tilted one,
/// and in squares of 32 pixels the mean relative error of a plane's albedo and the cloth's, and its
/// CIEDE2000. The last row says what is asked. About 600 MB of disk, and minutes.
Result<Rows> calibration_end_to_end_table(const StudyOptions& options) {
  Result<Scene> scene = simulator::read_scene(options.scenes / "rig.toml");
  if (!scene) return std::move(scene).error();
  return Walkthrough(std::move(*scene), options).run();
}

}  // namespace weft::bench
