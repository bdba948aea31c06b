// SPDX-License-Identifier: Apache-2.0
#include "bench/calibration/studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/jobs/calibrate/camera.h"
#include "bench/base/rig.h"
#include "bench/oracles/board_views.h"
#include "calibration/camera/lens.h"
#include "capture/raw/decode.h"
#include "core/files.h"
#include "core/parallel.h"
#include "core/temporary_folder.h"
#include "simulator/scene/rig.h"
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
  app::CalibrateCameraOptions calibrate;
  calibrate.input = input;
  calibrate.output = scratch.path() / "calibration";
  const Result<app::CalibrateOutcome> outcome = calibrate_camera(calibrate, context);
  if (!outcome) return outcome.error();
  const Result<app::PrintedBoard> board = app::read_board_file(input / "board.toml", {});
  if (!board) return board.error();
  const Result<app::BoardPhotographs> found =
      app::read_board_photographs({.folder = input, .board = board->board}, context);
  if (!found) return found.error();

  const std::string name = fmt::format("photographs rendered, {} of {:.1f} megapixels", kBoards,
                                       static_cast<double>(rig->camera.size.pixels()) / 1e6);
  CornerErrors corners;
  int used = 0;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    // By name the table comes last.
    const app::BoardPhotograph& photograph = found->photographs[i == 0 ? scenes.size() - 1 : i - 1];
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
  app::CalibrateCameraOptions calibrate;
  calibrate.input = input;
  calibrate.output = scratch.path() / "calibration";
  std::optional<Result<app::CalibrateOutcome>> outcome;
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

}  // namespace weft::bench
