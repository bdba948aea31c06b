// SPDX-License-Identifier: Apache-2.0
#include "bench/calibration/calibration_studies.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <set>

#include "bench/oracles/oracle_rig.h"
#include "bench/oracles/paper_oracle.h"
#include "calibration/lights/per_pixel.h"
#include "calibration/lights/physical.h"
#include "calibration/lights/seed_iteration.h"
#include "calibration/run/calibrate_lights.h"
#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/base/temporary_folder.h"
#include "core/rig/calibration.h"
#include "core/rig/light_field.h"
#include "core/rig/session.h"
#include "report/plot_svg.h"
#include "simulator/simulate.h"
#include "solver/uncertainty/calibration_sigma.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;
using calibration::CellGrid;
using calibration::CellLight;
using calibration::LightFit;
using test::PaperCaptures;
using test::PaperRig;

constexpr double kSlope_deg = 20;
constexpr int kAzimuths = 8;
constexpr double kMinutesAPose = 2;  // laying the sheet and scanning it, an estimate

constexpr const char* kPredicted = "normals at 20 degrees over the frame, predicted";
constexpr const char* kTrue = "normals at 20 degrees over the frame, true";
constexpr const char* kMinutes = "minutes with photographs (2 a pose)";
constexpr const char* kTape = "method: the tape alone";
constexpr const char* kSeed = "method: the seed's iteration, one flat sheet";
constexpr const char* kByPixel = "method: by the pixel, five poses";
constexpr const char* kOurs = "method: ours, five poses";

Json row(const std::string& name, const std::string& quantity, const std::string& asked, double reached) {
  return {{"case", name}, {"quantity", quantity}, {"asked", asked}, {"reached", reached}};
}

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

PaperCaptures captures_of(const PaperRig& rig, int seed) {
  test::PaperErrors errors;
  errors.seed = static_cast<std::uint64_t>(seed);
  return test::captures_of(rig, errors);
}

Result<LightFit> fit(const PaperCaptures& captures, int threads, bool lambertian = false) {
  calibration::LightFitOptions how;
  how.threads = resolved_threads(threads);
  how.lambertian = lambertian;
  return fit_lights(captures.start, captures.readings, how);
}

Result<void> five_poses(const StudyOptions& options, double delta, Rows& rows) {
  PaperRig rig = test::common_rig();
  rig.delta = delta;
  std::vector<double> position, direction, delta_off;
  double iterations = 0, least = 1e9, most = 0, fired = 0;
  for (int seed = 1; seed <= options.runs; ++seed) {
    const PaperCaptures captures = captures_of(rig, seed);
    const Result<LightFit> found = fit(captures, options.threads);
    if (!found) return found.error();
    position.push_back(test::position_error_mm(found->scene.lights, rig.lights));
    direction.push_back(test::direction_error_deg(found->scene.lights, rig.lights));
    delta_off.push_back(found->scene.paper.delta - delta);
    iterations = std::max(iterations, static_cast<double>(found->iterations));
    least = std::min(least, found->chi_square);
    most = std::max(most, found->chi_square);
    if (delta == 0) continue;
    const Result<LightFit> locked = fit(captures, options.threads, true);
    if (!locked || locked->misfits()) ++fired;
  }
  const std::string name =
      delta == 0 ? "five poses, Lambertian paper" : "five poses, paper 5 percent off Lambert's law";
  rows.push_back(row(name, "position, mm an axis", "0.5", rms(position)));
  rows.push_back(row(name, "direction, degrees", "0.05", rms(direction)));
  rows.push_back(row(name, "delta", "0.01", rms(delta_off)));
  rows.push_back(row(name, "iterations, worst", "15", iterations));
  rows.push_back(row(name, "chi-square, least", "0.9", least));
  rows.push_back(row(name, "chi-square, most", "1.1", most));
  if (delta != 0)
    rows.push_back(row(name, "delta held at 0: share of fits refused", "1", fired / options.runs));
  return {};
}

Result<void> flicker(const StudyOptions& options, double percent, Rows& rows) {
  PaperRig rig = test::common_rig();
  rig.delta = 0.05;
  std::vector<double> off, sigma, normalised, found;
  for (int seed = 1; seed <= options.runs; ++seed) {
    test::PaperErrors errors;
    errors.seed = static_cast<std::uint64_t>(seed);
    errors.flicker = percent / 100;
    const Result<LightFit> lights = fit(test::captures_of(rig, errors), options.threads);
    if (!lights) return lights.error();
    if (lights->misfits()) continue;
    found.push_back(100 * lights->flicker);
    for (std::size_t k = 0; k < rig.lights.leds.size(); ++k) {
      const Vec3 d = lights->scene.lights.leds[k].position_mm - rig.lights.leds[k].position_mm;
      const Vec3 s = lights->position_sigma_mm[k];
      off.insert(off.end(), {d.x, d.y, d.z});
      sigma.insert(sigma.end(), {s.x, s.y, s.z});
      normalised.insert(normalised.end(), {d.x / s.x, d.y / s.y, d.z / s.z});
    }
  }
  const std::string name = fmt::format("flicker of {:g} percent", percent);
  rows.push_back(row(name, "share of fits accepted", percent <= 0.3 ? "1" : "",
                     static_cast<double>(found.size()) / options.runs));
  rows.push_back(row(name, "position, mm an axis", "", rms(off)));
  rows.push_back(row(name, "position, predicted", "", rms(sigma)));
  rows.push_back(row(name, "position, error over sigma", "1.5", rms(normalised)));
  rows.push_back(row(name, "flicker found, percent", "", rms(found)));
  return {};
}

using LightOfCell = std::function<std::optional<CellLight>(std::size_t led, std::size_t cell)>;

LightOfCell light_of(const CellGrid& grid, const CameraModel& camera, const NearLights& lights) {
  return [&grid, &camera, &lights](std::size_t led, std::size_t cell) {
    const auto [x, y] = grid.centre_px(cell);
    return calibration::light_on_table(camera, lights, led, x, y);
  };
}
LightOfCell light_of(const std::vector<calibration::LightMap>& maps) {
  return [&maps](std::size_t led, std::size_t cell) -> std::optional<CellLight> {
    if (!(maps[led].intensity_rgb[cell][1] > 0)) return {};
    return CellLight{maps[led].direction[cell], maps[led].intensity_rgb[cell]};
  };
}

// What a slope of 20 degrees towards some azimuth is solved to, over all azimuths.
struct Slope {
  double bias_deg = 0;  // root mean square
  double gain = 0;      // mean
};

Slope slope_at(std::size_t cell, std::size_t leds, const LightOfCell& truth, const LightOfCell& found) {
  Slope slope;
  for (int i = 0; i < kAzimuths; ++i) {
    const double azimuth = 2 * kPi * i / kAzimuths;
    const Vec3 n = {std::sin(radians(kSlope_deg)) * std::cos(azimuth),
                    std::sin(radians(kSlope_deg)) * std::sin(azimuth), std::cos(radians(kSlope_deg))};
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < leds; ++k) {
      const auto light = truth(k, cell), taken = found(k, cell);
      if (!light || !taken || dot(n, light->direction) <= 0) continue;
      const Eigen::Vector3d l(taken->direction.x, taken->direction.y, taken->direction.z);
      normal += l * l.transpose();
      right += light->intensity_rgb[1] * dot(n, light->direction) / taken->intensity_rgb[1] * l;
    }
    const Eigen::Vector3d b = normal.ldlt().solve(right);
    const double bias = angle_deg({b[0], b[1], b[2]}, n);
    slope.bias_deg += bias * bias / kAzimuths;
    slope.gain += (b[0] * std::cos(azimuth) + b[1] * std::sin(azimuth)) / b[2] /
                  std::tan(radians(kSlope_deg)) / kAzimuths;
  }
  slope.bias_deg = std::sqrt(slope.bias_deg);
  return slope;
}

CellGrid grid_of(const CameraModel& camera) {
  return {camera.size, 26, 17};
}

// Root mean square over the frame.
double frame_bias_deg(const CellGrid& grid, std::size_t leds, const LightOfCell& truth,
                      const LightOfCell& found) {
  std::vector<double> bias;
  for (std::size_t cell = 0; cell < grid.cells(); ++cell)
    bias.push_back(slope_at(cell, leds, truth, found).bias_deg);
  return rms(bias);
}

constexpr std::array kPoses = {1, 2, 3, 5, 9};
std::string name_of(int poses) {
  return fmt::format("{} {}", poses, poses == 1 ? "pose" : "poses");
}

double minutes(int poses, double fit_seconds) {
  return kMinutesAPose * poses + fit_seconds / 60;
}

// Root mean square over the frame of what the covariance makes of normals.
Result<double> predicted_deg(const LightFit& fit, const CellGrid& grid) {
  std::vector<int> leds(fit.scene.lights.leds.size());
  std::iota(leds.begin(), leds.end(), 1);
  const Size size = fit.scene.camera.size;
  const Result<LightField> field = LightField::make(fit.scene.lights, fit.scene.camera, size, 0);
  if (!field) return field.error();
  const auto sigmas = solver::CalibrationSigmas::make(*field, size, leds, fit.covariance, std::nullopt);
  if (!sigmas) return sigmas.error();
  std::vector<double> all;
  for (std::size_t cell = 0; cell < grid.cells(); cell += 7) {
    const auto [x, y] = grid.centre_px(cell);
    for (int i = 0; i < 4; ++i) {
      const double s = std::sin(radians(kSlope_deg)), azimuth = kPi / 2 * i;
      const Vec3 n = {s * std::cos(azimuth), s * std::sin(azimuth), std::cos(radians(kSlope_deg))};
      all.push_back(sigmas->at(static_cast<int>(x), static_cast<int>(y), 1, n, 0.5).normal_deg);
    }
  }
  return rms(all);
}

Result<void> pose_curve(const StudyOptions& options, Rows& rows) {
  for (const int poses : kPoses) {
    PaperRig rig = test::common_rig();
    rig.delta = 0.05;
    rig.sheets = test::lies(poses);
    std::vector<double> predicted, real;
    double seconds = 0;
    for (int seed = 1; seed <= options.runs; ++seed) {
      const PaperCaptures captures = captures_of(rig, seed);
      Result<LightFit> found = Error{};
      seconds += least_seconds(1, [&] { found = fit(captures, options.threads); }) / options.runs;
      if (!found) return found.error();
      const CellGrid grid = grid_of(captures.start.camera);
      const Result<double> expected = predicted_deg(*found, grid);
      if (!expected) return expected.error();
      predicted.push_back(*expected);
      real.push_back(frame_bias_deg(grid, rig.lights.leds.size(),
                                    light_of(grid, captures.start.camera, rig.lights),
                                    light_of(grid, captures.start.camera, found->scene.lights)));
    }
    const std::string name = name_of(poses);
    rows.push_back(row(name, kPredicted, "", rms(predicted)));
    rows.push_back(row(name, kTrue, "", rms(real)));
    rows.push_back(row(name, "seconds of the fit", "", seconds));
    rows.push_back(row(name, kMinutes, "", minutes(poses, seconds)));
  }
  return {};
}

Result<void> methods(const StudyOptions& options, Rows& rows) {
  PaperRig rig = test::common_rig();
  rig.delta = 0.05;
  struct Scores {
    int poses = 0;
    double seconds = 0;
    std::vector<double> centre = {}, corner = {}, frame = {}, gain = {};
  };
  const int poses = static_cast<int>(rig.sheets.size());
  std::vector<std::pair<std::string, Scores>> all = {
      {kTape, {}}, {kSeed, {.poses = 1}}, {kByPixel, {.poses = poses}}, {kOurs, {.poses = poses}}};
  for (int seed = 1; seed <= options.runs; ++seed) {
    const PaperCaptures captures = captures_of(rig, seed);
    const CameraModel& camera = captures.start.camera;
    const CellGrid grid = grid_of(camera);
    Result<LightFit> ours = Error{};
    Result<calibration::PerPixelLights> by_pixel = Error{};
    Result<calibration::SeedLights> by_seed = Error{};
    const double ours_s = least_seconds(1, [&] { ours = fit(captures, options.threads); });
    if (!ours) return ours.error();
    const double by_pixel_s = least_seconds(1, [&] {
      by_pixel = solve_per_pixel(ours->scene, captures.readings, grid, {.threads = options.threads});
    });
    if (!by_pixel) return by_pixel.error();
    const double by_seed_s =
        least_seconds(1, [&] { by_seed = iterate_seed(captures.start, captures.readings, grid); });
    if (!by_seed) return by_seed.error();
    const std::array<double, 4> seconds = {0, by_seed_s, ours_s + by_pixel_s, ours_s};
    const LightOfCell truth = light_of(grid, camera, rig.lights);
    const std::array<LightOfCell, 4> found = {light_of(grid, camera, captures.start.lights),
                                              light_of(by_seed->maps), light_of(by_pixel->maps),
                                              light_of(grid, camera, ours->scene.lights)};
    const auto columns = static_cast<std::size_t>(grid.columns);
    const std::size_t centre = grid.cell_of(camera.cx, camera.cy);
    for (std::size_t m = 0; m < all.size(); ++m) {
      const Slope at_centre = slope_at(centre, rig.lights.leds.size(), truth, found[m]);
      all[m].second.seconds += seconds[m] / options.runs;
      all[m].second.frame.push_back(frame_bias_deg(grid, rig.lights.leds.size(), truth, found[m]));
      all[m].second.centre.push_back(at_centre.bias_deg);
      all[m].second.gain.push_back(std::abs(at_centre.gain - 1));
      for (const std::size_t corner :
           {std::size_t{0}, columns - 1, grid.cells() - columns, grid.cells() - 1}) {
        const Slope slope = slope_at(corner, rig.lights.leds.size(), truth, found[m]);
        all[m].second.corner.push_back(slope.bias_deg);
        all[m].second.gain.push_back(std::abs(slope.gain - 1));
      }
    }
  }
  for (const auto& [name, scores] : all) {
    const bool asked = name == kOurs;
    rows.push_back(row(name, "normal bias at the centre, degrees", asked ? "0.25" : "", rms(scores.centre)));
    rows.push_back(row(name, "normal bias in the corners, degrees", asked ? "0.35" : "", rms(scores.corner)));
    rows.push_back(row(name, kTrue, "", rms(scores.frame)));
    rows.push_back(row(name, "gain of slopes off 1, worst", asked ? "0.01" : "",
                       *std::max_element(scores.gain.begin(), scores.gain.end())));
    rows.push_back(row(name, kMinutes, "", minutes(scores.poses, scores.seconds)));
  }
  return {};
}

constexpr std::array<std::array<double, 2>, 4> kTags_mm = {{{-70, 38}, {70, 38}, {-70, -38}, {70, -38}}};
constexpr double kSheetTag_mm = 15;
constexpr double kProductMegapixels = 0.15;
constexpr double kTape_mm = 10;
constexpr int kProductSeeds = 3;
constexpr int kRunsOfOne = 5;
constexpr double kAskedFlicker_percent = 0.3;

// A sheet that is larger than the frame.
simulator::Scene sheet_scene(const PaperRig::Lie& lie, double megapixels) {
  simulator::Scene scene;
  scene.camera.width = 2 * static_cast<int>(std::lround(std::sqrt(megapixels * 1e6 * 1.5) / 2));
  scene.camera.height = 2 * static_cast<int>(std::lround(std::sqrt(megapixels * 1e6 / 1.5) / 2));
  scene.camera.mm_per_pixel = 197.0 / scene.camera.width;
  scene.camera.exposure_us = 12000;
  scene.geometry.cloth_height_mm = -80;
  scene.effects.near_light = scene.effects.noise = true;
  const double a = radians(lie.azimuth_deg), t = radians(lie.tilt_deg);
  const auto add = [&](simulator::PatternSettings pattern, double u, double v, double above) {
    const double along = u * std::cos(a) + v * std::sin(a), beside = v * std::cos(a) - u * std::sin(a);
    const double out = along * std::cos(t) + above * std::sin(t);
    simulator::TargetSettings& target = scene.targets.emplace_back();
    target.pattern = std::move(pattern);
    target.tilt_deg = lie.tilt_deg;
    target.azimuth_deg = lie.azimuth_deg;
    target.centre_mm = {out * std::cos(a) - beside * std::sin(a), out * std::sin(a) + beside * std::cos(a),
                        above * std::cos(t) - along * std::sin(t)};
  };
  for (std::size_t i = 0; i < kTags_mm.size(); ++i)
    add(simulator::TagSettings{.id = static_cast<int>(i), .side_mm = kSheetTag_mm, .margin_mm = 3},
        kTags_mm[i][0], kTags_mm[i][1], 0.005);
  add(simulator::PaperSettings{300, 220}, 0, 0, 0);
  return scene;
}

// Five sessions of a sheet in `lights`, with sheet.toml; LEDs flicker by so many percent, and fade where they
// do.
Result<void> write_captures(const fs::path& lights, double megapixels, double flicker_percent, int seed,
                            int threads) {
  std::string text = "width_mm = 300\nheight_mm = 220\nreflectance = 0.9\n";
  for (std::size_t i = 0; i < kTags_mm.size(); ++i)
    text += fmt::format("[[tag]]\nid = {}\nside_mm = {}\ncentre_mm = [{}, {}]\n", i, kSheetTag_mm,
                        kTags_mm[i][0], kTags_mm[i][1]);
  fs::create_directories(lights);
  if (Result<void> ok = write_file(lights / "sheet.toml", text); !ok) return ok;
  const std::vector<PaperRig::Lie> lies = test::lies(5);
  for (std::size_t i = 0; i < lies.size(); ++i) {
    simulator::Scene scene = sheet_scene(lies[i], megapixels);
    scene.seed = 100 * seed + static_cast<int>(i);
    scene.effects.led_drift = flicker_percent > 0;
    scene.lights.flicker = flicker_percent / 100;
    simulator::SimulateOptions how;
    how.truth = false;
    how.tiles.threads = threads;
    const auto made = simulator::simulate_session(scene, lights / fmt::format("sheet{}.weft", i + 1), how);
    if (!made) return made.error();
  }
  const Result<Calibration> exact = read_calibration(lights / "sheet1.weft" / "calibration");
  if (!exact) return exact.error();
  std::string rig;
  test::Random random(static_cast<std::uint64_t>(seed));
  for (const NearLight& led : std::get<NearLights>(*exact->lights).leds) {
    const Vec3 p =
        led.position_mm + kTape_mm * normalized({random.normal(), random.normal(), random.normal()});
    rig += fmt::format("[[led]]\nposition_mm = [{:.1f}, {:.1f}, {:.1f}]\n", p.x, p.y, p.z);
  }
  return write_file(lights / "rig.toml", rig);
}

calibration::CalibrateLightsOptions job_on(const fs::path& lights) {
  calibration::CalibrateLightsOptions job;
  job.input = lights;
  job.from = lights / "sheet1.weft" / "calibration";
  job.output = lights.parent_path() / "new";
  return job;
}

// Errors of positions over what the calibration's covariance says of them.
std::vector<double> normalised_errors(const Calibration& found, const NearLights& truth) {
  const ParameterCovariance& covariance = *found.light_covariance;
  const NearLights& lights = std::get<NearLights>(*found.lights);
  std::vector<double> errors;
  for (std::size_t k = 0; k < truth.leds.size(); ++k) {
    const Vec3 off = lights.leds[k].position_mm - truth.leds[k].position_mm;
    const auto first = std::ranges::find(covariance.parameters, fmt::format("led{:02}.position_mm.x", k + 1));
    const auto at = static_cast<std::size_t>(first - covariance.parameters.begin());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t diagonal = (at + axis) * (covariance.parameters.size() + 1);
      errors.push_back(std::array{off.x, off.y, off.z}[axis] / std::sqrt(covariance.matrix[diagonal]));
    }
  }
  return errors;
}

Result<void> product_flicker(const StudyOptions& options, double percent, Rows& rows) {
  std::vector<double> errors;
  const int seeds = std::min(options.runs, kProductSeeds);
  double accepted = 0;
  std::set<std::string> ids;
  for (int seed = 1; seed <= seeds; ++seed) {
    const TemporaryFolder scratch;
    const calibration::CalibrateLightsOptions job = job_on(scratch.path() / "lights");
    if (Result<void> ok = write_captures(job.input, kProductMegapixels, percent, seed, options.threads); !ok)
      return ok;
    const auto truth = read_calibration(job.from);
    if (!truth) return truth.error();
    const int runs = percent == kAskedFlicker_percent && seed == 1 ? kRunsOfOne : 1;
    for (int run = 0; run < runs; ++run) {
      fs::remove_all(job.output);
      const auto outcome = calibrate_lights(job, {.threads = options.threads});
      if (!outcome) {
        if (outcome.error().kind != ErrorKind::kBadData) return outcome.error();
        break;
      }
      if (runs > 1) {
        const auto id = sha256_of_file(job.output / "lights.json");
        if (!id) return id.error();
        ids.insert(*id);
      }
      if (run > 0) continue;
      ++accepted;
      const auto of_seed = normalised_errors(outcome->calibration, std::get<NearLights>(*truth->lights));
      errors.insert(errors.end(), of_seed.begin(), of_seed.end());
    }
  }
  const bool asked = percent <= kAskedFlicker_percent;
  const std::string name = fmt::format("weft calibrate lights, flicker of {:g} percent", percent);
  rows.push_back(row(name, "share accepted", asked ? "1" : "", accepted / seeds));
  rows.push_back(row(name, "position, error over sigma", asked ? "1.5" : "", rms(errors)));
  if (!ids.empty()) {
    rows.push_back(row(fmt::format("{}, one input {} times", name, kRunsOfOne), "different lights.json", "1",
                       static_cast<double>(ids.size())));
  }
  return {};
}

Result<void> time_job(const StudyOptions& options, Rows& rows) {
  const TemporaryFolder scratch;
  const calibration::CalibrateLightsOptions job = job_on(scratch.path() / "lights");
  if (Result<void> ok = write_captures(job.input, options.megapixels, 0, 1, options.threads); !ok) return ok;
  std::vector<fs::path> files;
  for (int sheet = 1; sheet <= 5; ++sheet) {
    const Result<Session> session = read_session(job.input / fmt::format("sheet{}.weft", sheet));
    if (!session) return session.error();
    for (const Shot& shot : session->shots) files.push_back(session->path_of(shot));
  }
  const int threads = std::min(resolved_threads(options.threads), 2);
  const double decode = least_seconds(1, [&] {
    parallel_for(files.size(), threads, [&](std::size_t i, int) { (void)capture::decode_raw(files[i]); });
  });
  Result<calibration::CalibrateOutcome> outcome = Error{};
  const double seconds =
      least_seconds(1, [&] { outcome = calibrate_lights(job, {.threads = options.threads}); });
  if (!outcome) return outcome.error();
  const std::string name =
      fmt::format("time, {} photographs of {:.3g} megapixels", files.size(), options.megapixels);
  rows.push_back(row(name, "seconds", "180", seconds));
  rows.push_back(row(name, "over decoding the files", "", seconds / decode));
  rows.push_back(row(name, "peak of memory, GB", "2", static_cast<double>(peak_memory_bytes()) / 1e9));
  return {};
}

// The error of normals in these rows against the minutes: predicted and true from one pose to nine, and the
// other methods.
report::Plot calibration_poses_plot(const Rows& rows) {
  // By name of the case: what it reached.
  const auto reached = [&](const std::string& name, const std::string& quantity) {
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const Json& each) {
      return each["case"] == name && each["quantity"] == quantity;
    });
    return found == rows.end() ? 0 : (*found)["reached"].get<double>();
  };
  report::PlotSeries predicted = {"ours, predicted", {}, true}, real = {"ours, true", {}, true},
                     methods = {"other methods"};
  for (const int poses : kPoses) {
    const std::string name = name_of(poses);
    const double x = reached(name, kMinutes);
    predicted.points.push_back({x, reached(name, kPredicted), ""});
    real.points.push_back({x, reached(name, kTrue), name});
  }
  for (const auto& [name, label] : {std::pair{kSeed, "the seed's iteration"}, {kByPixel, "by the pixel"}})
    methods.points.push_back({reached(name, kMinutes), reached(name, kTrue), label});
  // No photographs take no minutes, which a logarithmic axis does not have: a line across all of it.
  const double without = reached(kTape, kTrue);
  report::PlotSeries tape = {"no calibration: the tape alone",
                             {{real.points.front().x, without, ""}, {real.points.back().x, without, ""}},
                             true};
  return {.title = "Lights of a calibration: error of normals against time at the rig",
          .x_label = "minutes at the rig and of the fit (2 a pose, estimated)",
          .y_label = "error of normals at a slope of 20 degrees, rms over the frame, degrees",
          .series = {predicted, real, methods, tape},
          .log_x = true,
          .log_y = true};
}

}  // namespace

/// How well the lights are found from averages of white paper (26 x 17 blocks, 0.2 percent noise, tape 10 mm
/// wrong, poses off by 0.05 degrees and 0.1 mm; ten LEDs of differing aim and lobe, a vignette, uneven
/// paper), made by formulas of their own (bench/oracles/paper_oracle.h). A row a quantity, `asked` being the
/// bar, root mean square over the seeds, or the worst where it says so:
///
/// - "five poses", the paper Lambertian or not: positions, directions, iterations, chi-square, delta; and
///   in how many seeds the gate fires where delta is held at 0.
/// - "flicker": LEDs that differ from shot to shot: how many seeds are accepted, the error of positions, what
///   it is predicted to be, the error over its sigma, and the flicker that was found.
/// - "weft calibrate lights, flicker": the program on simulated sessions of five poses whose LEDs flicker and
///   fade, up to three seeds: how many are accepted, the error of positions over their sigma, and how many
///   different lights.json one input makes in five runs.
/// - "method": what lights by the tape alone, by the seed, by the pixel and by ours make of a slope of 20
///   degrees at the centre, in the corners and over the frame, the gain of slopes, and the minutes they take:
///   two a pose at the rig (an estimate), and the fit.
/// - "N poses": normals at a slope of 20 degrees over the frame, as the covariance predicts them and as they
///   are, and the minutes. Both of the paper that is not Lambertian.
/// - "time": `weft calibrate lights` on five sessions of ten LEDs: seconds, as ratio to decoding the same
///   files, and the peak of memory.
Result<Rows> calibration_lights_table(const StudyOptions& options) {
  Rows rows;
  for (const double delta : {0.0, 0.05}) {
    if (Result<void> ok = five_poses(options, delta, rows); !ok) return std::move(ok).error();
  }
  for (const double percent : {0.0, 0.03, 0.1, 0.2, 0.3, 0.5}) {
    if (Result<void> ok = flicker(options, percent, rows); !ok) return std::move(ok).error();
  }
  for (const double percent : {0.0, 0.1, 0.3, 0.5}) {
    if (Result<void> ok = product_flicker(options, percent, rows); !ok) return std::move(ok).error();
  }
  if (Result<void> ok = methods(options, rows); !ok) return std::move(ok).error();
  if (Result<void> ok = pose_curve(options, rows); !ok) return std::move(ok).error();
  if (options.megapixels > 0) {
    if (Result<void> ok = time_job(options, rows); !ok) return std::move(ok).error();
  }
  return rows;
}

Result<void> write_calibration_docs(const fs::path& folder, const Rows& rows) {
  const fs::path pictures = folder / "pictures";
  if (Result<void> made = make_writable_folder(pictures); !made) return made;
  return write_file(pictures / "calibration_poses.svg", plot_svg(calibration_poses_plot(rows)));
}

}  // namespace weft::bench
