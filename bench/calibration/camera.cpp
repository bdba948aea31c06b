// SPDX-License-Identifier: Apache-2.0
#include "bench/calibration/calibration_studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/base/measured_rig.h"
#include "bench/oracles/board_views.h"
#include "calibration/camera/lens_fit.h"
#include "calibration/response/superposition.h"
#include "calibration/run/calibrate_camera.h"
#include "calibration/run/calibrate_response.h"
#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/base/temporary_folder.h"
#include "simulator/scene/scene_rig.h"
#include "simulator/simulate.h"
#include "simulator/targets/target.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;
using calibration::BoardView;
using calibration::LensFit;
using calibration::Pose;

constexpr double kMostOverBound = 1.3;
constexpr double kSigma_px = 0.1, kRenderedMegapixels = 2;
constexpr int kBoards = 15, kTimedBoards = 20, kDifferent = 5;

/// A number that a camera is measured by.
struct CameraQuantity {
  std::string name, unit;
  double asked;
  std::function<double(const CameraModel&)> of;
};

std::vector<CameraQuantity> quantities(const CameraModel& truth) {
  const auto sight = [](const CameraModel& c, std::size_t axis) {
    return degrees(std::asin(c.camera_from_rig_rotation[2][axis]));
  };
  return {
      {"focal length x", "percent", 0.02, [truth](const CameraModel& c) { return 100 * c.fx / truth.fx; }},
      {"focal length y", "percent", 0.02, [truth](const CameraModel& c) { return 100 * c.fy / truth.fy; }},
      {"principal point x", "px", 1, [](const CameraModel& c) { return c.cx; }},
      {"principal point y", "px", 1, [](const CameraModel& c) { return c.cy; }},
      {"height", "mm", 0.1, [](const CameraModel& c) { return centre_of(c).z; }},
      {"tilt along x", "deg", 0.02, [sight](const CameraModel& c) { return sight(c, 0); }},
      {"tilt along y", "deg", 0.02, [sight](const CameraModel& c) { return sight(c, 1); }}};
}

/// Root mean square over the frame of how far apart two cameras put a pixel on the table.
double table_error_mm(const CameraModel& camera, const CameraModel& truth) {
  constexpr int kPlaces = 20;
  double sum = 0;
  for (int j = 0; j <= kPlaces; ++j) {
    for (int i = 0; i <= kPlaces; ++i) {
      const double x = i * (truth.size.width - 1.0) / kPlaces, y = j * (truth.size.height - 1.0) / kPlaces;
      const Vec3 d = point_on_plane(camera, x, y, 0) - point_on_plane(truth, x, y, 0);
      sum += dot(d, d) / ((kPlaces + 1) * (kPlaces + 1));
    }
  }
  return std::sqrt(sum);
}

Json row(const std::string& of, const std::string& quantity, const std::string& unit,
         std::optional<double> asked, double reached) {
  return {{"case", of},         {"quantity", quantity},
          {"unit", unit},       {"asked", asked ? Json(*asked) : Json()},
          {"reached", reached}, {"bound", nullptr},
          {"ratio", nullptr},   {"ratio_asked", nullptr},
          {"bias", nullptr}};
}

Result<Rows> projected_rows(const StudyOptions& options) {
  test::BoardRig rig;
  rig.boards = kBoards;
  const std::vector<Pose> poses = poses_of(rig, 1);
  std::vector<Result<LensFit>> fits(static_cast<std::size_t>(options.runs), Error{});
  parallel_for(fits.size(), options.threads, [&](std::size_t i, int) {
    fits[i] = fit_lens(views_of(rig, poses, kSigma_px, static_cast<int>(i) + 1), rig.camera.size,
                       {.thickness_mm = rig.thickness_mm});
  });
  for (const auto& fit : fits) {
    if (!fit) return fit.error();
  }
  const auto n = static_cast<double>(fits.size());
  const std::string name =
      fmt::format("corners projected, {} boards, {} px, {} seeds", kBoards, kSigma_px, options.runs);
  const ParameterCovariance bound =
      calibration::lens_bound(rig.camera, poses, views_of(rig, poses, 0, 1), 0, {"k1", "k2"}, kSigma_px);
  Rows rows;
  for (const CameraQuantity& quantity : quantities(rig.camera)) {
    double mean = 0, variance = 0;
    for (const auto& fit : fits) mean += quantity.of(fit->camera) / n;
    for (const auto& fit : fits) variance += std::pow(quantity.of(fit->camera) - mean, 2) / (n - 1);
    const double least = calibration::propagated(rig.camera, bound, quantity.of);
    rows.push_back(row(name, quantity.name, quantity.unit, quantity.asked, std::sqrt(variance)));
    rows.back()["bound"] = least;
    rows.back()["ratio"] = std::sqrt(variance) / least;
    rows.back()["ratio_asked"] = kMostOverBound;
    rows.back()["bias"] = mean - quantity.of(rig.camera);
  }
  double squares = 0;
  for (const auto& fit : fits) squares += std::pow(table_error_mm(fit->camera, rig.camera), 2) / n;
  rows.push_back(row(name, "pixel to table, rms", "mm", 0.02, std::sqrt(squares)));
  return rows;
}

simulator::CharucoSettings board_of_12_by_18() {
  return {18, 12, 9, 0.75, "DICT_5X5_250", 6};
}

/// The board in one of its poses, the first flat on the table.
simulator::Scene photograph_scene(double megapixels, int pose) {
  simulator::Scene scene;
  const Size size = bench_size(megapixels);
  scene.seed = pose + 1;
  scene.camera.width = size.width;
  scene.camera.height = size.height;
  scene.camera.mm_per_pixel = 200.0 / size.width;
  scene.camera.pose = {.tilt_deg = 1, .azimuth_deg = 30};
  scene.material.albedo = {0.2, 0.2, 0.2};
  scene.lights.leds.resize(1);
  scene.lights.leds[0].position_mm = {120, 90, 560};
  scene.targets.resize(1);
  simulator::TargetSettings& board = scene.targets[0];
  board.pattern = board_of_12_by_18();
  board.centre_mm = {0, 0, 2};
  if (pose > 0) {
    board.centre_mm = {8.0 * (pose % 3 - 1), 5.0 * (pose % 4 - 1.5), 45};
    board.tilt_deg = 22 + 6 * (pose % 4);
    board.azimuth_deg = std::fmod(137.5 * pose, 360);
    board.rotation_deg = 4.0 * (pose % 5) - 8;
  }
  scene.effects.near_light = scene.effects.distortion = scene.effects.defocus = scene.effects.noise = true;
  return scene;
}

Result<void> write_board_file(const fs::path& folder) {
  const simulator::CharucoSettings b = board_of_12_by_18();
  return write_file(
      folder / "board.toml",
      fmt::format("kind = \"charuco\"\nsquares_x = {}\nsquares_y = {}\nsquare_mm = {}\nmarker_share = {}\n"
                  "dictionary = \"{}\"\nthickness_mm = 2\n",
                  b.squares_x, b.squares_y, b.square_mm, b.marker_share, b.dictionary));
}

/// How far found corners are from where the simulator has them.
struct CornerErrors {
  double squares = 0, count = 0, x = 0, y = 0;
};

void add_errors(const simulator::Scene& scene, const CameraModel& camera, const BoardView& view,
                CornerErrors& errors) {
  const Result<simulator::Target> target = simulator::Target::make(scene.targets[0], scene.seed, 0);
  if (!target) return;
  for (const auto& corner : view.corners) {
    const Vec3 p = project(camera, target->place_mm(corner.u_mm, corner.v_mm));
    const double dx = corner.px.x - p.x, dy = corner.px.y - p.y;
    errors.squares += dx * dx + dy * dy;
    errors.x += dx;
    errors.y += dy;
    ++errors.count;
  }
}

Result<Rows> rendered_rows(const StudyOptions& options) {
  const TemporaryFolder scratch;
  const fs::path input = scratch.path() / "camera";
  if (Result<void> ok = make_writable_folder(input); !ok) return ok.error();
  if (Result<void> ok = write_board_file(input); !ok) return ok.error();
  std::vector<simulator::Scene> scenes;
  for (int i = 0; i < kBoards; ++i) {
    scenes.push_back(photograph_scene(kRenderedMegapixels, i));
    simulator::SimulateOptions simulate;
    simulate.tiles.threads = options.threads;
    const std::string name = i == 0 ? "table01.dng" : fmt::format("board{:02}.dng", i);
    if (Result<void> ok = simulate_frame(scenes.back(), 1, input / name, simulate); !ok) return ok.error();
  }
  const Result<simulator::SceneRig> rig = rig_of(scenes.front());
  if (!rig) return rig.error();
  const JobContext context = {.threads = options.threads};
  calibration::CalibrateCameraOptions calibrate;
  calibrate.input = input;
  calibrate.output = scratch.path() / "calibration";
  const Result<calibration::CalibrateOutcome> outcome = calibrate_camera(calibrate, context);
  if (!outcome) return outcome.error();
  const Result<calibration::PrintedBoard> board = calibration::read_board_file(input / "board.toml", {});
  if (!board) return board.error();
  const Result<calibration::BoardPhotographs> found =
      calibration::read_board_photographs({.folder = input, .board = board->board}, context);
  if (!found) return found.error();

  const std::string name = fmt::format("photographs rendered, {} of {:.1f} megapixels", kBoards,
                                       static_cast<double>(rig->camera.size.pixels()) / 1e6);
  CornerErrors corners;
  int used = 0;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    // By name the table comes last.
    const calibration::BoardPhotograph& photograph = found->photographs[i == 0 ? scenes.size() - 1 : i - 1];
    if (!photograph.left_out.empty()) continue;
    ++used;
    add_errors(scenes[i], rig->camera, {photograph.name, photograph.sighting.corners}, corners);
  }
  Rows rows = {row(name, "photographs used", "", {}, used),
               row(name, "corner, rms", "px", {}, std::sqrt(corners.squares / corners.count)),
               row(name, "corner, mean along x", "px", {}, corners.x / corners.count),
               row(name, "corner, mean along y", "px", {}, corners.y / corners.count)};
  const CameraModel& camera = *outcome->calibration.camera;
  for (const CameraQuantity& q : quantities(rig->camera))
    rows.push_back(
        row(name, q.name + ", error", q.unit, q.asked, std::abs(q.of(camera) - q.of(rig->camera))));
  rows.push_back(row(name, "pixel to table, rms", "mm", 0.02, table_error_mm(camera, rig->camera)));
  return rows;
}

Result<Rows> time_rows(const StudyOptions& options) {
  const TemporaryFolder scratch;
  const fs::path input = scratch.path() / "camera";
  if (Result<void> ok = make_writable_folder(input); !ok) return ok.error();
  if (Result<void> ok = write_board_file(input); !ok) return ok.error();
  std::vector<fs::path> files;
  for (int i = 0; i < kTimedBoards; ++i) {
    const int pose = i % kDifferent;
    files.push_back(input / fmt::format("{}{:02}.dng", pose == 0 ? "table" : "board", i));
    if (i >= kDifferent) {
      std::error_code failure;
      fs::copy_file(files[static_cast<std::size_t>(pose)], files.back(), failure);
      if (failure) return cannot_write(files.back(), failure.value());
      continue;
    }
    simulator::SimulateOptions simulate;
    simulate.tiles.threads = options.threads;
    if (Result<void> ok =
            simulate_frame(photograph_scene(options.megapixels, pose), 1, files.back(), simulate);
        !ok)
      return ok.error();
  }
  const JobContext context = {.threads = options.threads};
  std::optional<Error> failure;
  const double decode_seconds = least_seconds(2, [&] {
    const Result<void> decoded = for_each_frame(files.size(), context, [&](std::size_t i) -> Result<void> {
      const Result<RawFrame> frame = capture::decode_raw(files[i]);
      return frame ? Result<void>() : Result<void>(frame.error());
    });
    if (!decoded) failure = decoded.error();
  });
  if (failure) return *failure;
  calibration::CalibrateCameraOptions calibrate;
  calibrate.input = input;
  calibrate.output = scratch.path() / "calibration";
  std::optional<Result<calibration::CalibrateOutcome>> outcome;
  const double seconds = least_seconds(1, [&] { outcome = calibrate_camera(calibrate, context); });
  if (!*outcome) return outcome->error();
  Rows rows = {row(fmt::format("time, {} photographs of {:.1f} megapixels", kTimedBoards,
                               static_cast<double>(bench_size(options.megapixels).pixels()) / 1e6),
                   fmt::format("calibrate camera, {} threads", resolved_threads(options.threads)), "s", 60,
                   seconds)};
  rows.back()["ratio"] = seconds / decode_seconds;
  rows.push_back(
      row(rows.front()["case"].get<std::string>(), "decoding the same files", "s", {}, decode_seconds));
  rows.push_back(row(rows.front()["case"].get<std::string>(), "memory held at most", "GB", 2,
                     static_cast<double>(peak_memory_bytes()) / 1e9));
  return rows;
}

}  // namespace

/// How well the camera is calibrated. A row a case and quantity, `asked` being the bar:
///
/// - "corners projected": a board of 17 x 11 corners in fixed poses, noise on its corners; the standard
/// deviation
///   `reached` over seeds, the Cramer-Rao `bound`, their `ratio` (asked: 1.3) and the mean error as `bias`.
/// - "photographs rendered": a ChArUco board of 18 x 12 squares through lens, blur, mosaic and noise; errors
///   against the simulator's camera, and of the corners.
/// - "time": `weft calibrate camera` on a folder of 20 photographs, five different ones four times over:
///   seconds, and as `ratio` over decoding the same files by as many threads.
Result<Rows> calibration_camera_table(const StudyOptions& options) {
  Rows rows;
  const auto add = [&](Result<Rows> more) -> Result<void> {
    if (!more) return std::move(more).error();
    rows.insert(rows.end(), more->begin(), more->end());
    return {};
  };
  if (Result<void> ok = add(projected_rows(options)); !ok) return ok.error();
  if (Result<void> ok = add(rendered_rows(options)); !ok) return ok.error();
  if (Result<void> ok = add(time_rows(options)); !ok) return ok.error();
  return rows;
}

namespace {

constexpr std::array<double, 2> kBend = {0.017, 0.0085};
constexpr std::array<double, 7> kShares = {0.01, 0.03, 0.1, 0.25, 0.45, 0.9, 1.8};  // of the scene's exposure
constexpr int kFramesEach = 2, kDarkFrames = 4;

simulator::Scene scene_of(simulator::Body body, std::int64_t seed) {
  simulator::Scene scene;
  scene.seed = seed;
  scene.camera.body = body;
  scene.camera.width = 768;
  scene.camera.height = 512;
  scene.camera.mm_per_pixel = 0.2;
  scene.camera.linearity = kBend;
  scene.camera.retakes.shutter_error = 0.004;
  scene.camera.defects.dark_electrons_per_s = 5;
  scene.camera.defects.response_percent = 0.4;
  scene.camera.defects.column_counts = 0.3;
  scene.camera.defects.photosite_counts = 0.3;
  scene.lights.drift = 0.003;
  scene.lights.flicker = 0.001;
  scene.material.albedo = {0.4, 0.4, 0.4};
  simulator::TargetSettings paper;
  paper.pattern = simulator::PaperSettings{120, 80};
  paper.centre_mm.z = 1;
  scene.targets = {paper};
  simulator::EffectSettings& e = scene.effects;
  e.near_light = e.noise = e.nonlinearity = e.dark_current = e.uneven_response = e.led_drift = true;
  return scene;
}

Result<void> capture(const simulator::Scene& scene, double scene_exposure_us, const fs::path& folder,
                     int threads) {
  simulator::SimulateOptions options;
  options.tiles.threads = threads;
  int takes = 0;
  const auto take = [&](const std::vector<int>& leds, const std::string& name, double exposure_us,
                        int frames) -> Result<void> {
    if (Result<void> ok = make_writable_folder(folder / name); !ok) return ok;
    for (int i = 0; i < frames; ++i) {
      options.takes_before = takes;
      takes += static_cast<int>(scene.lights.leds.size()) + 11;
      const fs::path file = folder / name / fmt::format("{:09.0f}_{}.dng", exposure_us, i);
      if (Result<void> ok = simulate_photograph(scene, {leds, exposure_us}, file, options); !ok) return ok;
    }
    return {};
  };
  for (const double share : {kShares.front(), kShares.back()}) {
    if (Result<void> ok = take({}, "dark", std::round(share * scene_exposure_us), kDarkFrames); !ok)
      return ok;
  }
  for (const double share : kShares) {
    const double exposure_us = std::round(share * scene_exposure_us);
    for (const auto& [leds, name] :
         {std::pair<std::vector<int>, std::string>{{1}, "led01"}, {{2}, "led02"}, {{1, 2}, "led01+led02"}}) {
      if (Result<void> ok = take(leds, name, exposure_us, kFramesEach); !ok) return ok;
    }
  }
  return {};
}

// One quantity over the seeds.
struct ResponseQuantity {
  const char* name;
  double truth;
  double per_percent;  // error_percent is rms_error over this
  double bar_percent;  // 0: none was asked for
  double sum = 0, square = 0, sigma = 0;

  void add(double measured, double predicted_sigma) {
    sum += measured;
    square += (measured - truth) * (measured - truth);
    sigma += predicted_sigma;
  }
  Json row(const char* body, int seeds) const {
    const double rms = std::sqrt(square / seeds);
    return {{"body", body},
            {"quantity", name},
            {"truth", truth},
            {"measured", sum / seeds},
            {"rms_error", rms},
            {"sigma", sigma / seeds},
            {"error_percent", rms / per_percent},
            {"bar_percent", bar_percent > 0 ? Json(bar_percent) : Json()}};
  }
};

Result<void> measure(const char* name, simulator::Body body, const StudyOptions& options, Rows& rows) {
  const Result<simulator::SceneRig> rig = rig_of(scene_of(body, 1));
  if (!rig) return rig.error();
  const Response truth = response_of(rig->sensor);
  const double full = rig->sensor.white - rig->sensor.black;
  const double noise_bar = body == simulator::Body::kOffset ? 1 : 5;
  const double departure = calibration::departure_from_line(kBend);
  ResponseQuantity gain = {"electrons a count", truth.electrons_per_count, truth.electrons_per_count / 100,
                           noise_bar};
  ResponseQuantity read = {"read noise, counts", truth.read_noise_counts, truth.read_noise_counts / 100,
                           noise_bar};
  ResponseQuantity black = {"black level, counts", rig->sensor.black, full / 100, 0.01};
  ResponseQuantity bend = {"non-linearity, of full scale", departure, 0.01, 0.1};
  ResponseQuantity left = {"non-linearity left, of full scale", 0, 0.01, 0.1};
  ResponseQuantity ratio = {"light at 1.8 over light at 0.45", 4, 0.04, 0};
  JobContext context;
  context.threads = options.threads;
  for (int seed = 1; seed <= options.runs; ++seed) {
    const TemporaryFolder scratch;
    const fs::path input = scratch.path() / "response";
    if (Result<void> ok = capture(scene_of(body, seed), rig->exposure_us, input, options.threads); !ok)
      return ok;
    calibration::CalibrateResponseOptions job;
    job.input = input;
    job.output = scratch.path() / "calibration";
    job.rig = "bench";
    const Result<calibration::CalibrateOutcome> done = calibrate_response(job, context);
    if (!done) return done.error();
    const Json& n = done->report.numbers;
    const Response& measured = *done->calibration.response;
    gain.add(measured.electrons_per_count, n["sigma_electrons_per_count"]);
    read.add(measured.read_noise_counts, n["sigma_read_noise_counts"]);
    black.add(n["black_counts"], n["sigma_black_counts"]);
    double worst = 0, sigma = 0;
    std::size_t worst_channel = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [a, b] = measured.linearity[c];
      const double off = calibration::departure_from_line({a - kBend[0], b - kBend[1]});
      if (off > worst) worst_channel = c;
      worst = std::max(worst, off);
      sigma = std::max(sigma, n["sigma_departure"][c].get<double>());
    }
    bend.add(n["departure"][worst_channel], sigma);
    left.add(worst, sigma);
    const double scene_us = rig->exposure_us;
    ratio.add(*measured.exposure_ratio(std::round(1.8 * scene_us), std::round(0.45 * scene_us)), 0);
  }
  for (const ResponseQuantity* q : {&gain, &read, &black, &bend, &left, &ratio})
    rows.push_back(q->row(name, options.runs));
  return {};
}

}  // namespace

/// `weft calibrate response` on simulated captures: a sheet of paper by LED 1, LED 2 and both at seven
/// exposures, two frames of each, and dark frames, as DNG files, by both bodies of the simulator. The sensor
/// is bent by half a percent, uneven, warm and noisy, its LEDs drift, its shutter is off by 0.4 percent. A
/// row a body and quantity: `truth`, `measured` (mean over seeds), `rms_error` and the `sigma` that the
/// calibration predicts for itself, `error_percent` (of the truth; of full scale for black level and
/// linearity) and the `bar_percent` asked for.
Result<Rows> calibration_response_table(const StudyOptions& options) {
  Rows rows;
  for (const auto& [name, body] :
       {std::pair{"offset", simulator::Body::kOffset}, std::pair{"d5100", simulator::Body::kD5100}}) {
    if (Result<void> ok = measure(name, body, options, rows); !ok) return std::move(ok).error();
  }
  return rows;
}

}  // namespace weft::bench
