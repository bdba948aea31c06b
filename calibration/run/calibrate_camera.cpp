// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/calibrate_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "calibration/camera/guidance.h"
#include "calibration/camera/lateral_fit.h"
#include "calibration/camera/lens_fit.h"
#include "calibration/camera/spread.h"
#include "calibration/run/calibrate_patches.h"
#include "calibration/run/camera_report.h"
#include "calibration/run/described.h"
#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "core/describe/field_check.h"
#include "core/image_io/linear_image.h"
#include "core/rig/camera.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr double kMostScatter_px = 1;  // of a tag's corner over the photographs of the table

Result<void> check_options(const CalibrateCameraOptions& options) {
  const Result<void> fits = check_fields(options);
  return fits && !options.output.empty() ? check_new(options.output) : fits;
}

// The views to fit, the first of them on the table.
Result<std::vector<std::size_t>> views_of(const BoardPhotographs& all, const fs::path& folder) {
  std::vector<std::size_t> viewed;
  std::string why;
  for (std::size_t i = 0; i < all.photographs.size(); ++i) {
    const BoardPhotograph& p = all.photographs[i];
    if (p.left_out.empty()) viewed.push_back(i);
    if (p.of_table && !p.left_out.empty())
      why += fmt::format("{}{}: {}", why.empty() ? "" : "; ", p.name, p.left_out);
  }
  std::stable_partition(viewed.begin(), viewed.end(),
                        [&](std::size_t i) { return all.photographs[i].of_table; });
  if (!viewed.empty() && all.photographs[viewed.front()].of_table) return viewed;
  return Error{ErrorKind::kBadData, "no photograph shows the board on the table", folder.string(),
               why.empty() ? "none is named table..." : why,
               "lay the board flat on the table, photograph it and name the file table1 with its ending"};
}

// The error of a fit with the photographs that it had to do without.
Error with_names(Error error, const BoardPhotographs& all) {
  for (const BoardPhotograph& p : all.photographs) {
    if (!p.left_out.empty()) error.why += fmt::format("; {}: {}", p.name, p.left_out);
  }
  return error;
}

// Where each tag lies that the photographs of the table show: the mean over them, on the table. One that was
// moved between them is none.
std::vector<Fiducial> fiducials_of(const BoardPhotographs& all, const CameraModel& camera,
                                   std::vector<std::string>& warnings) {
  std::map<std::pair<std::string, int>, std::vector<TagSighting>> seen;
  for (const BoardPhotograph& p : all.photographs) {
    if (!p.left_out.empty()) continue;
    for (const TagSighting& tag : p.tags) seen[{tag.dictionary, tag.id}].push_back(tag);
  }
  std::vector<Fiducial> fiducials;
  for (const auto& [name, sightings] : seen) {
    const std::array<PixelPoint, 4>& first = sightings.front().corners_px;
    const bool was_moved = std::any_of(sightings.begin(), sightings.end(), [&](const TagSighting& tag) {
      return std::hypot(tag.corners_px[0].x - first[0].x, tag.corners_px[0].y - first[0].y) > kMostScatter_px;
    });
    if (was_moved) {
      warnings.push_back(
          fmt::format("tag {} of {} was left out: it moved between the photographs of the table", name.second,
                      name.first));
      continue;
    }
    Fiducial fiducial = {name.first, name.second, {}};
    for (std::size_t k = 0; k < 4; ++k) {
      for (const TagSighting& tag : sightings) {
        const Vec3 on_table = point_on_plane(camera, tag.corners_px[k].x, tag.corners_px[k].y, 0);
        fiducial.corners_mm[k] =
            fiducial.corners_mm[k] + 1.0 / static_cast<double>(sightings.size()) * on_table;
      }
    }
    fiducials.push_back(fiducial);
  }
  return fiducials;
}

CalibrationSubject subject_of(const CalibrateCameraOptions& options, const std::optional<Calibration>& from,
                              const ShotMetadata& camera) {
  CalibrationSubject subject = from ? from->subject : CalibrationSubject();
  subject.measured.clear();
  if (subject.rig.empty() || !options.rig.empty()) subject.rig = rig_name(options.rig, options.input);
  if (subject.camera_model.empty()) subject.camera_model = camera.model;
  if (subject.camera_serial.empty()) subject.camera_serial = camera.serial;
  if (subject.f_number == 0) subject.f_number = camera.f_number;
  if (subject.focal_length_mm == 0) subject.focal_length_mm = camera.focal_mm;
  return subject;
}

// The edges of the board as each colour shows them, in the raw photographs that the lens was fitted to.
Result<std::vector<BoardEdge>> edges_of(const fs::path& folder, const Board& board,
                                        std::span<const BoardView> views, const LensFit& fit,
                                        const JobContext& context) {
  std::vector<std::vector<BoardEdge>> found(views.size());
  const auto look = [&](std::size_t i) -> Result<void> {
    const fs::path file = folder / views[i].name;
    if (!fit.boards[i].used || is_linear_image(file)) return {};
    const Result<RawFrame> frame = capture::decode_raw(file, {.size = fit.camera.size});
    if (!frame) return frame.error();
    found[i] = find_edges(*frame, fit.camera, fit.boards[i].rig_from_board, board);
    return {};
  };
  if (Result<void> ok = for_each_frame(views.size(), context, look); !ok) return std::move(ok).error();
  std::vector<BoardEdge> all;
  for (const std::vector<BoardEdge>& edges : found) all.insert(all.end(), edges.begin(), edges.end());
  return all;
}

// Photographs of a board, and the camera that they tell.
struct FittedBoards {
  PrintedBoard board;
  std::optional<Calibration> from;
  BoardPhotographs all;
  std::vector<std::size_t> viewed;
  std::vector<BoardView> views;
  LensFit fit;
};

Result<FittedBoards> fit_boards(const CalibrateCameraOptions& options, const JobContext& context) {
  if (!is_there(options.input)) {
    return Error{ErrorKind::kNoInput, "there are no photographs", options.input.string(),
                 "the folder is not there", "check the path"};
  }
  Result<PrintedBoard> board = read_board_file(options.input / "board.toml", options.board);
  if (!board) return std::move(board).error();
  std::optional<Calibration> from;
  if (!options.from.empty()) {
    Result<Calibration> read = read_calibration(options.from);
    if (!read) return std::move(read).error();
    from = std::move(*read);
  }
  BoardFolderOptions folder = {options.input, board->board, options.tag_dictionary};
  folder.limits.most_edge_px = options.most_blur_px;
  if (from) folder.subject = from->subject;
  if (from && from->camera) folder.size = from->camera->size;
  Result<BoardPhotographs> all = read_board_photographs(folder, context);
  if (!all) return std::move(all).error();
  Result<std::vector<std::size_t>> viewed = views_of(*all, options.input);
  if (!viewed) return std::move(viewed).error();
  std::vector<BoardView> views;
  for (const std::size_t i : *viewed)
    views.push_back({all->photographs[i].name, all->photographs[i].sighting.corners});
  Result<LensFit> fit = fit_lens(views, all->size,
                                 {.table = 0,
                                  .thickness_mm = board->thickness_mm,
                                  .least_boards = static_cast<std::size_t>(options.least_boards),
                                  .most_focal_sigma = options.most_focal_percent / 100});
  if (!fit) return with_names(std::move(fit).error(), *all);
  return FittedBoards{std::move(*board),  std::move(from),  std::move(*all),
                      std::move(*viewed), std::move(views), std::move(*fit)};
}

}  // namespace

void describe(Fields& fields, CalibrateCameraOptions& o) {
  describe_input(
      fields, o.input,
      "Folder of photographs of one board in many poses; those named table... show it flat on the table");
  describe_kept(fields, o.from);
  describe_wanted_calibration(fields, o.output);
  describe_rig(fields, o.rig);
  describe(fields, o.board);
  fields.value({"tags", "Dictionary of the tags on the table"}, o.tag_dictionary);
  fields.value({"most_blur_px", "Photographs with wider edges are left out, pixels", {1, 100}},
               o.most_blur_px);
  fields.value({"least_boards", "Fewer usable photographs are refused", {3, 1000}}, o.least_boards);
  fields.value({.name = "most_focal_percent",
                .says = "Boards too alike are refused: predicted sigma of the focal length, percent",
                .range = {0.001, 10},
                .option = "--most-focal-percent"},
               o.most_focal_percent);
  describe(fields, o.wish);
}

Result<CalibrateOutcome> calibrate_camera(const CalibrateCameraOptions& options, const JobContext& context) {
  if (const Result<void> ok = check_options(options); !ok) return ok.error();
  const Result<FittedBoards> fitted = fit_boards(options, context);
  if (!fitted) return fitted.error();
  const auto& [board, from, all, viewed, views, fit] = *fitted;
  Board printed = board.board;
  if (fit.print.is_used) printed.stretch = 1 + fit.print.share;
  const Result<std::vector<BoardEdge>> edges = edges_of(options.input, printed, views, fit, context);
  if (!edges) return edges.error();
  if (context.stop.stop_requested()) return interrupted();

  CalibrateOutcome outcome;
  Calibration change;
  change.subject = subject_of(options, from, all.camera);
  change.camera = fit.camera;
  change.camera_covariance = fit.covariance;
  change.spread = median_spread(*edges);
  const std::optional<LateralFit> lateral = fit_lateral_color(*edges, fit.camera);
  if (lateral) change.lateral = lateral->color;
  change.fiducials = fiducials_of(all, fit.camera, outcome.warnings);
  if (from && !(from->patches.empty() && from->points.empty())) {
    change.lights = from->lights;
    change.light_covariance = from->light_covariance;
    if (!from->patches.empty()) outcome.warnings.push_back(patches_left_out("camera"));
    if (!from->points.empty())
      outcome.warnings.emplace_back(
          "the fixed points were left out, as the camera may stand elsewhere: weft calibrate lights finds "
          "them "
          "again");
  }
  const CameraFitFacts facts = {
      all, viewed, views, fit, change.fiducials, change.spread, lateral, from, change.subject.rig};
  outcome.report = camera_report(facts);
  for (std::string& warning : left_out(facts)) outcome.warnings.push_back(std::move(warning));
  if (options.output.empty()) return outcome;
  Result<Calibration> written =
      derive_calibration(options.from, std::move(change), options.output, report_files(outcome.report));
  if (!written) return std::move(written).error();
  outcome.folder = options.output;
  outcome.calibration = std::move(*written);
  return outcome;
}

Result<PosesPrices> price_camera(const CalibrateCameraOptions& options, const JobContext& context) {
  if (const Result<void> fits = check_fields(options); !fits) return fits.error();
  Stopwatch watch;
  const Result<FittedBoards> fitted = fit_boards(options, context);
  if (!fitted) return fitted.error();
  const double fit_s = watch.lap();
  const std::size_t there = fitted->views.size();
  const std::vector<LensForecast> ahead =
      forecasts_ahead(fitted->board.board, fitted->board.thickness_mm, fitted->fit.camera, fitted->views, 0,
                      kMorePoses.back());
  PosesPrices prices = {"board", {}};
  for (const int more : kMorePoses) {
    if (more >= static_cast<int>(ahead.size())) break;
    const LensForecast& forecast = ahead[static_cast<std::size_t>(more)];
    PosesPrice price = {.more = more, .poses = static_cast<int>(there) + more, .rig_s = kLaying_s * more};
    price.fit_s = fit_s * price.poses / static_cast<double>(there);
    price.focal_percent = forecast.focal_percent;
    price.place_mm = forecast.place_mm;
    price.predicted_deg = degrees(std::atan2(forecast.place_mm, centre_of(fitted->fit.camera).z));
    prices.rows.push_back(price);
  }
  if (Result<void> ok = choose_poses(prices, options.wish); !ok) return std::move(ok).error();
  return prices;
}

}  // namespace weft::calibration
