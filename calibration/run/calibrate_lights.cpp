// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/calibrate_lights.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "calibration/lights/poses_ahead.h"
#include "calibration/lights/sheet_stories.h"
#include "calibration/run/calibrate_patches.h"
#include "calibration/run/described.h"
#include "calibration/run/lights_report.h"
#include "calibration/run/sheet_captures.h"
#include "capture/rig.h"
#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/describe/field_check.h"
#include "core/image_io/image_io.h"
#include "core/rig/light_field.h"
#include "solver/uncertainty/calibration_sigma.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr int kCellsAcross = 26;      // blocks of the fit over the frame's width
constexpr double kUnevenness = 1e-3;  // of white paper over a few millimetres
constexpr double kSlope_deg = 20;
constexpr std::size_t kGoodPoses = 5;

Error bad(ErrorKind kind, std::string what, std::string where, std::string why, std::string remedy) {
  return {kind, std::move(what), std::move(where), std::move(why), std::move(remedy)};
}

class LightsCalibration {
 public:
  LightsCalibration(const CalibrateLightsOptions& options, const JobContext& context)
      : options_(options), context_(context) {}

  Result<CalibrateOutcome> run() {
    if (Result<void> ok = prepare(); !ok) return std::move(ok).error();
    if (Result<void> ok = read(); !ok) return std::move(ok).error();
    if (options_.method == LightsMethod::kSeed) {
      if (Result<void> ok = run_seed(); !ok) return std::move(ok).error();
    } else {
      if (Result<void> ok = fit_clean_paper(); !ok) return std::move(ok).error();
      if (Result<void> ok = judge(); !ok) return std::move(ok).error();
      if (Result<void> ok = predict(); !ok) return std::move(ok).error();
      if (options_.method == LightsMethod::kPerPixel) {
        if (Result<void> ok = run_per_pixel(); !ok) return std::move(ok).error();
      }
    }
    return write();
  }

  // What more poses would do to the fit's covariance: readings of them as the fit itself would have them.
  Result<PosesPrices> price() {
    if (Result<void> ok = prepare(); !ok) return std::move(ok).error();
    if (Result<void> ok = read(); !ok) return std::move(ok).error();
    if (Result<void> ok = fit_clean_paper(); !ok) return std::move(ok).error();
    const LightFit here = *evidence_.fit;
    const double scan_s = scan_seconds();
    PosesPrices prices = {"sheet", {}};
    for (const int more : kMorePoses) {
      Stopwatch watch;
      const PaperPhotographs all = with_more_poses(here.scene, evidence_.readings, sheet_.sheet, more);
      Result<LightFit> fit = fit_lights(all.scene, all.readings, fit_options());
      if (!fit) return std::move(fit).error();
      PosesPrice price = {.more = more, .poses = static_cast<int>(all.scene.sheets.size())};
      price.fit_s = watch.lap();
      price.rig_s = more * (kLaying_s + scan_s);
      price.position_mm = fit->worst_position_sigma_mm();
      evidence_.fit = std::move(*fit);
      if (Result<void> ok = predict(); !ok) return std::move(ok).error();
      double sum = 0;
      if (!evidence_.predicted) return too_few_lights();
      for (const double deg : evidence_.predicted->slope_deg) sum += deg * deg;
      price.predicted_deg = std::sqrt(sum / static_cast<double>(evidence_.predicted->slope_deg.size()));
      prices.rows.push_back(price);
    }
    if (Result<void> ok = choose_poses(prices, options_.wish); !ok) return std::move(ok).error();
    return prices;
  }

 private:
  Error too_few_lights() const {
    return bad(ErrorKind::kBadData, "nothing can be foretold", options_.input.string(),
               "fewer than three LEDs tell no normals", "calibrate more LEDs");
  }

  // Seconds that a pose is photographed for, by those that are there.
  double scan_seconds() const {
    std::vector<double> seconds;
    for (const SheetCapture& capture : captures_.captures) {
      const Result<Session> session = read_session(options_.input / capture.name);
      if (const auto spent = session ? seconds_taken(*session) : std::nullopt) seconds.push_back(*spent);
    }
    return seconds.empty() ? 0 : median(seconds);
  }

  Result<void> prepare();
  Result<void> read();
  Result<void> fit_clean_paper();
  Result<void> leave_out_faults(bool& any);
  Result<void> judge();
  std::string words_of_misfit() const;
  std::optional<Error> find_story() const;
  Result<void> predict();
  Result<void> run_per_pixel();
  Result<void> run_seed();
  Result<CalibrateOutcome> write();
  Result<std::vector<NamedFile>> maps() const;
  LightFitOptions fit_options() const;
  CellGrid cells() const;
  void take_readings();

  const CalibrateLightsOptions& options_;
  const JobContext& context_;
  Calibration calibration_;
  TaggedSheet sheet_;
  SheetCaptures captures_;
  std::vector<std::vector<char>> left_out_;
  LightsEvidence evidence_;
  std::vector<Verdict> verdicts_;
};

Result<void> LightsCalibration::prepare() {
  if (options_.from.empty()) {
    return bad(ErrorKind::kUsage, "lights cannot be calibrated alone", "--from",
               "the camera says where each pixel looks, and the response what its counts mean",
               "name a calibration that has both with --from");
  }
  if (Result<void> fits = check_fields(options_); !fits) return fits;
  if (!options_.output.empty()) {
    if (Result<void> ok = check_new(options_.output); !ok) return ok;
  }
  Result<Calibration> from = read_calibration(options_.from);
  if (!from) return std::move(from).error();
  calibration_ = std::move(*from);
  if (!calibration_.camera || !calibration_.response) {
    return bad(ErrorKind::kBadData, "lights cannot be calibrated yet", options_.from.string(),
               fmt::format("it has no {}", calibration_.camera ? "response.json" : "camera.json"),
               fmt::format("run weft calibrate {} first", calibration_.camera ? "response" : "camera"));
  }
  Result<TaggedSheet> sheet = read_sheet_file(options_.input / "sheet.toml");
  if (!sheet) return std::move(sheet).error();
  sheet_ = std::move(*sheet);
  const fs::path rig_file = options_.input / "rig.toml";
  if (is_there(rig_file)) {
    const Result<capture::Rig> rig = capture::read_rig(rig_file);
    if (!rig) return rig.error();
    if (rig->lights) calibration_.lights = *rig->lights;
  }
  if (!calibration_.lights || !std::holds_alternative<NearLights>(*calibration_.lights)) {
    return bad(ErrorKind::kBadData, "nothing says where the LEDs are", rig_file.string(),
               "it has no [[led]], and the calibration of --from has no near lights",
               "measure the LEDs with a tape and write their positions to rig.toml");
  }
  return {};
}

Result<void> LightsCalibration::read() {
  Result<SheetCaptures> captures = read_sheet_captures({options_.input, calibration_, sheet_}, context_);
  if (!captures) return std::move(captures).error();
  captures_ = std::move(*captures);
  verdicts_ = captures_.warnings;
  const auto blocks = static_cast<std::size_t>(captures_.columns) * static_cast<std::size_t>(captures_.rows);
  left_out_.assign(captures_.captures.size(), std::vector<char>(blocks));

  PaperScene& start = evidence_.start;
  start.camera = *calibration_.camera;
  start.lights = std::get<NearLights>(*calibration_.lights);
  for (NearLight& led : start.lights.leds) led.log_gain_quadratic = {};
  start.lights.log_gain_rgb = {};
  start.paper.half_width_mm = sheet_.sheet.width_mm / 2;
  start.paper.half_height_mm = sheet_.sheet.height_mm / 2;
  start.paper.reflectance_rgb = sheet_.sheet.reflectance_rgb.value_or(std::array<double, 3>{1, 1, 1});
  for (const SheetCapture& capture : captures_.captures) {
    start.sheets.push_back(capture.pose);
    evidence_.captures.push_back(capture.name);
    evidence_.fitted.push_back({capture.name, capture.lit_sha256});
  }
  evidence_.rig = calibration_.subject.rig;
  evidence_.flatness_deg = options_.flatness_deg;
  take_readings();
  return {};
}

void LightsCalibration::take_readings() {
  evidence_.readings = merged_blocks(captures_, left_out_, cells());
}

CellGrid LightsCalibration::cells() const {
  const Size size = calibration_.camera->size;
  const int columns = std::min(kCellsAcross, captures_.columns);
  return {
      size, columns,
      std::clamp(static_cast<int>(std::lround(1.0 * columns * size.height / size.width)), 1, captures_.rows)};
}

LightFitOptions LightsCalibration::fit_options() const {
  LightFitOptions how;
  how.position_sigma_mm = options_.tape_sigma_mm;
  how.lambertian = options_.lambertian;
  how.unevenness = kUnevenness;
  how.flatness_deg = options_.flatness_deg;
  how.flicker = options_.flicker_percent / 100;
  how.threads = resolved_threads(context_.threads);
  return how;
}

// Fits, looks at the paper by that fit, and fits once more without what is wrong with it.
Result<void> LightsCalibration::fit_clean_paper() {
  for (bool again = true; again;) {
    if (context_.stop.stop_requested()) return interrupted();
    context_.progress("fit", evidence_.fit ? 0.5 : 0);
    Result<LightFit> fit = fit_lights(evidence_.start, evidence_.readings, fit_options());
    if (!fit) {
      if (const std::optional<Error> story = find_story()) return *story;
      Error error = std::move(fit).error();
      error.where = fmt::format("{}: {}", options_.input.string(), error.where);
      return error;
    }
    const bool was_cleaned = evidence_.fit.has_value();
    evidence_.fit = std::move(*fit);
    again = false;
    if (was_cleaned) break;
    if (Result<void> ok = leave_out_faults(again); !ok) return ok;
  }
  context_.progress("fit", 1);
  return {};
}

Result<void> LightsCalibration::leave_out_faults(bool& any) {
  const std::vector<PaperReading> blocks = single_blocks(captures_, left_out_);
  const std::vector<PaperSpot> spots = spots_of(evidence_.fit->scene, blocks);
  const CameraModel& camera = *calibration_.camera;
  const double spacing_mm = length(point_on_plane(camera, camera.cx + captures_.block_px, camera.cy, 0) -
                                   point_on_plane(camera, camera.cx, camera.cy, 0));
  evidence_.faults = find_faults(spots, spacing_mm);
  std::size_t faulty = 0;
  for (const PaperFault& fault : evidence_.faults) {
    std::vector<std::string> where;
    for (const std::size_t sheet : fault.sheets) where.push_back(evidence_.captures[sheet]);
    verdicts_.push_back(
        {"PAPER_FAULT",
         fmt::format("the paper has a {} of {:.0f} mm^2 at u = {:.0f} mm, v = {:.0f} mm from its centre "
                     "({:.1f} percent, in {}); it was left out",
                     fault.is_fold ? "fold" : "stain", fault.area_mm2, fault.u_mm, fault.v_mm,
                     100 * fault.departure, fmt::join(where, ", ")),
         "take a clean sheet that lies flat the next time"});
    faulty += fault.spots.size();
    for (const std::size_t i : fault.spots) {
      const auto column = static_cast<int>(spots[i].x_px / captures_.block_px),
                 row = static_cast<int>(spots[i].y_px / captures_.block_px);
      // Its neighbours have the rest of it.
      for (int y = std::max(row - 1, 0); y <= std::min(row + 1, captures_.rows - 1); ++y) {
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, captures_.columns - 1); ++x)
          left_out_[spots[i].sheet]
                   [static_cast<std::size_t>(y) * static_cast<std::size_t>(captures_.columns) +
                    static_cast<std::size_t>(x)] = 1;
      }
    }
  }
  any = faulty > 0;
  if (static_cast<double>(faulty) > kMostFaultyShare * static_cast<double>(spots.size()) &&
      !options_.accept_misfit) {
    if (const std::optional<Error> story = find_story()) return *story;
    const PaperFault& largest = evidence_.faults.front();
    return bad(ErrorKind::kBadData, "the paper is not an even, flat white", options_.input.string(),
               fmt::format("{:.0f} percent of it depart from the fit, most at u = {:.0f} mm, v = {:.0f} mm "
                           "from its centre, a {} of {:.0f} mm^2",
                           100.0 * static_cast<double>(faulty) / static_cast<double>(spots.size()),
                           largest.u_mm, largest.v_mm, largest.is_fold ? "fold" : "stain", largest.area_mm2),
               "photograph a clean sheet that lies flat");
  }
  if (any) take_readings();
  return {};
}

std::string words_of(const ExchangedLeds& exchanged) {
  std::vector<std::string> words;
  for (std::size_t k = 0; k < exchanged.as.size(); ++k) {
    const std::size_t other = exchanged.as[k];
    const bool is_pair = exchanged.as[other] == k;
    if (other == k || (is_pair && other < k)) continue;
    words.push_back(is_pair ? fmt::format("the wires of LEDs {} and {} are exchanged", k + 1, other + 1)
                            : fmt::format("LED {} lights from where LED {} should", k + 1, other + 1));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

// What makes the sheets contradict each other, where one story explains them.
std::optional<Error> LightsCalibration::find_story() const {
  const auto told = [&](std::string what, std::string why, std::string remedy) {
    return bad(ErrorKind::kBadData, std::move(what), options_.input.string(), std::move(why),
               std::move(remedy));
  };
  if (const auto exchanged = find_exchanged(evidence_.start, evidence_.readings)) {
    return told(
        words_of(*exchanged),
        fmt::format(
            "by where the LEDs were measured to be the sheets read {:.0f} percent off, and {:.1f} with "
            "these exchanged",
            100 * exchanged->rms_before, 100 * exchanged->rms_after),
        "exchange the wires and photograph the sheets again, or exchange the LEDs' places in rig.toml");
  }
  if (!evidence_.fit) return std::nullopt;
  const auto room = find_room_light(evidence_.start, evidence_.readings, fit_options(), *evidence_.fit);
  if (!room) return std::nullopt;
  const bool in_dark = room->share < 0;
  return told(
      in_dark ? "the dark shots of the sheet have light that the others lack"
              : "there is light of the room that the dark shots of the sheet lack",
      fmt::format("it is about {:.0f} percent of the LEDs' mean light, alike under every LED; without it {}",
                  100 * std::abs(room->share),
                  room->agrees ? "the photographs agree" : "they contradict each other less"),
      in_dark ? "put out the lamp that was on for them, and photograph the sheets again"
              : "take the dark shots without the lens cap and in the same light, or darken the room, and "
                "photograph the sheets again");
}

std::string LightsCalibration::words_of_misfit() const {
  const LightFit& fit = *evidence_.fit;
  std::vector<std::string> why;
  if (fit.chi_square > kMisfitFrom) {
    why.push_back(fmt::format(
        "chi-square is {:.2f} for each of {:.0f} degrees of freedom, at most {:.1f} is consistent",
        fit.chi_square, fit.degrees_of_freedom, kMisfitFrom));
  }
  if (!fit.settled) why.emplace_back("the fit did not settle");
  if (fit.flickers_too_much)
    why.push_back(
        fmt::format("LEDs differ from shot to shot by more than {:.2g} times --flicker", kMostFlicker));
  if (fit.other_shot) {
    why.push_back(fmt::format("LED {} gave {:.3g} times the light in {} that it gave in the others",
                              fit.other_shot->led + 1, std::exp(fit.other_shot->log_gain),
                              evidence_.captures[fit.other_shot->sheet]));
  }
  return fmt::format("{}; what is off the most: {}", fmt::join(why, "; "), worst_of(evidence_));
}

// The gate: do the readings agree with the model, and do they say enough?
Result<void> LightsCalibration::judge() {
  const LightFit& fit = *evidence_.fit;
  if (fit.misfits()) {
    const std::string why = words_of_misfit();
    if (!options_.accept_misfit) {
      if (const std::optional<Error> story = find_story()) return *story;
      return bad(
          ErrorKind::kBadData, "the photographs of the sheet contradict each other", options_.input.string(),
          why,
          "see that nothing moves between them, that the sheet is flat and rig.toml right, and photograph it "
          "again, or take the result as it is with --accept-misfit");
    }
    verdicts_.push_back({"MISFIT",
                         "the photographs of the sheet contradict each other, which was accepted: " + why,
                         "trust these lights only as far as weft calibrate check does"});
  }
  std::vector<Pose> poses;
  for (const SheetPose& sheet : fit.scene.sheets) {
    const auto same = [&](const Pose& other) { return same_pose(other, sheet.rig_from_sheet); };
    if (std::none_of(poses.begin(), poses.end(), same)) poses.push_back(sheet.rig_from_sheet);
  }
  if (poses.size() < kGoodPoses || fit.is_weak()) {
    verdicts_.push_back(
        {"WEAK",
         fmt::format("the lights are weakly known, from {} {} of the sheet: positions to {:.1f} mm at worst",
                     poses.size(), poses.size() == 1 ? "pose" : "poses", fit.worst_position_sigma_mm()),
         "photograph it flat and tilted by 20 degrees to all four sides"});
  }
  return {};
}

// Worst over four azimuths at each cell of the frame.
Result<void> LightsCalibration::predict() {
  const LightFit& fit = *evidence_.fit;
  const Size size = calibration_.camera->size;
  std::vector<int> leds(fit.scene.lights.leds.size());
  std::iota(leds.begin(), leds.end(), 1);
  if (leds.size() < 3) return {};
  const Result<LightField> field = LightField::make(fit.scene.lights, calibration_.camera, size, 0);
  if (!field) return field.error();
  const auto sigmas = solver::CalibrationSigmas::make(*field, size, leds, fit.covariance, std::nullopt);
  if (!sigmas) return sigmas.error();
  PredictedError predicted;
  predicted.grid = cells();
  predicted.level_deg.resize(predicted.grid.cells());
  predicted.slope_deg.resize(predicted.grid.cells());
  parallel_for(predicted.grid.cells(), context_.threads, [&](std::size_t cell, int) {
    const auto [x, y] = predicted.grid.centre_px(cell);
    const int px = static_cast<int>(x), py = static_cast<int>(y);
    predicted.level_deg[cell] = sigmas->at(px, py, 1, {0, 0, 1}, 0.5).normal_deg;
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
      const double s = std::sin(radians(kSlope_deg)), azimuth = kPi / 2 * i;
      const Vec3 n = {s * std::cos(azimuth), s * std::sin(azimuth), std::cos(radians(kSlope_deg))};
      const double sigma = sigmas->at(px, py, 1, n, 0.5).normal_deg;
      sum += sigma * sigma / 4;
    }
    predicted.slope_deg[cell] = std::sqrt(sum);
  });
  const auto& slope = predicted.slope_deg;
  const auto columns = static_cast<std::size_t>(predicted.grid.columns);
  predicted.centre_deg = slope[predicted.grid.cell_of(size.width / 2.0, size.height / 2.0)];
  predicted.corner_deg =
      std::max({slope.front(), slope[columns - 1], slope[slope.size() - columns], slope.back()});
  evidence_.predicted = std::move(predicted);
  return {};
}

Result<void> LightsCalibration::run_per_pixel() {
  PerPixelOptions how;
  how.threads = context_.threads;
  context_.progress("per pixel", 0);
  auto solved = solve_per_pixel(evidence_.fit->scene, evidence_.readings, cells(), how);
  if (!solved) {
    Error error = std::move(solved).error();
    error.where = fmt::format("{}: {}", options_.input.string(), error.where);
    return error;
  }
  for (const std::size_t led : solved->parted()) {
    verdicts_.push_back(
        {"NOT_A_POINT",
         fmt::format("the light of LED {} is not that of a point: its directions part from the model's by up "
                     "to {:.2f} degrees",
                     led + 1,
                     *std::max_element(solved->apart_deg[led].begin(), solved->apart_deg[led].end())),
         "look whether something reflects or shades it"});
  }
  evidence_.per_pixel = std::move(*solved);
  return {};
}

// On the sheet that lies flattest, as if it alone had been photographed.
Result<void> LightsCalibration::run_seed() {
  std::size_t flattest = 0;
  const auto tilt = [&](std::size_t j) {
    return angle_deg(normal_of(captures_.captures[j].pose.rig_from_sheet), {0, 0, 1});
  };
  for (std::size_t j = 1; j < captures_.captures.size(); ++j) {
    if (tilt(j) < tilt(flattest)) flattest = j;
  }
  std::vector<PaperReading> readings;
  for (PaperReading r : evidence_.readings) {
    if (r.sheet != flattest) continue;
    r.sheet = 0;
    readings.push_back(r);
  }
  auto seed = iterate_seed(evidence_.start, readings, cells());
  if (!seed) return std::move(seed).error();
  evidence_.seed = std::move(*seed);
  evidence_.fitted = {evidence_.fitted[flattest]};
  verdicts_.push_back(
      {"NO_DIRECTIONS",
       fmt::format("the seed's iteration on {} finds no directions: the paper solves flatter by every step "
                   "whether they are right or not",
                   evidence_.captures[flattest]),
       "use it to compare"});
  return {};
}

Result<std::vector<NamedFile>> LightsCalibration::maps() const {
  const std::vector<LightMap>* all = evidence_.per_pixel ? &evidence_.per_pixel->maps
                                     : evidence_.seed    ? &evidence_.seed->maps
                                                         : nullptr;
  std::vector<NamedFile> files;
  if (all == nullptr) return files;
  const CellGrid& grid = evidence_.per_pixel ? evidence_.per_pixel->grid : evidence_.seed->grid;
  const PartialFolder aside(options_.output);
  if (Result<void> made = make_writable_folder(aside.path()); !made) return std::move(made).error();
  for (std::size_t k = 0; k < all->size(); ++k) {
    Image<float> planes({grid.columns, grid.rows}, 6);
    for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
      const int x = static_cast<int>(cell) % grid.columns, y = static_cast<int>(cell) / grid.columns;
      const Vec3 l = (*all)[k].direction[cell];
      const auto& intensity = (*all)[k].intensity_rgb[cell];
      const std::array<double, 6> values = {l.x, l.y, l.z, intensity[0], intensity[1], intensity[2]};
      for (int p = 0; p < 6; ++p) planes(x, y, p) = static_cast<float>(values[static_cast<std::size_t>(p)]);
    }
    for (const bool direction : {true, false}) {
      const std::string name = fmt::format("led{:02}_{}.exr", k + 1, direction ? "direction" : "intensity");
      const int first = direction ? 0 : 3;
      const std::array<View<const float>, 3> views = {std::as_const(planes).plane(first),
                                                      std::as_const(planes).plane(first + 1),
                                                      std::as_const(planes).plane(first + 2)};
      const std::vector<std::string> channels =
          direction ? std::vector<std::string>{"X", "Y", "Z"} : std::vector<std::string>{"R", "G", "B"};
      if (Result<void> ok = write_image(aside.path() / name, views, channels, {}); !ok)
        return std::move(ok).error();
      Result<std::string> bytes = read_text(aside.path() / name);
      if (!bytes) return std::move(bytes).error();
      files.push_back({name, std::move(*bytes)});
    }
  }
  return files;
}

Result<CalibrateOutcome> LightsCalibration::write() {
  Calibration change;
  change.subject = calibration_.subject;
  change.subject.measured.clear();
  change.subject.albedo_scale =
      sheet_.sheet.reflectance_rgb ? AlbedoScale::kAbsolute : AlbedoScale::kRelative;
  if (evidence_.seed) {
    change.lights = lights_of(*evidence_.seed, evidence_.start);
  } else if (evidence_.per_pixel) {
    change.lights = evidence_.per_pixel->model;
  } else {
    change.lights = evidence_.fit->scene.lights;
    change.light_covariance = evidence_.fit->covariance;
  }
  change.points = captures_.points;
  evidence_.points = static_cast<int>(captures_.points.size());
  CalibrateOutcome outcome;
  if (!calibration_.patches.empty()) outcome.warnings.push_back(patches_left_out("lights"));
  if (std::string lax = lax_gate(evidence_); !lax.empty()) outcome.warnings.push_back(std::move(lax));
  outcome.report = lights_report(evidence_, std::move(verdicts_));
  if (options_.output.empty()) return outcome;
  std::vector<NamedFile> files = report_files(outcome.report);
  Result<std::vector<NamedFile>> pictures = maps();
  if (!pictures) return std::move(pictures).error();
  files.insert(files.end(), pictures->begin(), pictures->end());
  Result<Calibration> written = derive_calibration(options_.from, std::move(change), options_.output, files);
  if (!written) return std::move(written).error();
  outcome.folder = options_.output;
  outcome.calibration = std::move(*written);
  return outcome;
}

}  // namespace

void describe(Fields& fields, CalibrateLightsOptions& o) {
  describe_input(
      fields, o.input,
      "Folder of sessions (*.weft) of a sheet with tags, sheet.toml and, where measured anew, rig.toml");
  describe_kept(fields, o.from);
  describe_wanted_calibration(fields, o.output);
  fields.choice({"method",
                 "physical (a model of each LED), per-pixel (directions cell by cell), seed (the iteration "
                 "of the paper "
                 "that this scanner follows, on one flat sheet)"},
                o.method, kLightsMethodNames);
  fields.value({"tape_sigma_mm", "How well positions were measured, mm an axis", {0.1, 1000}},
               o.tape_sigma_mm);
  fields.value({"flatness_deg", "Rms waviness of the sheet, degrees", {0, 2}}, o.flatness_deg);
  fields.value(
      {"flicker_percent", "Flicker of LEDs from shot to shot, percent, where sheets do not tell", {0.01, 5}},
      o.flicker_percent);
  fields.value({"lambertian", "Take the paper to follow Lambert's law"}, o.lambertian);
  fields.value({"accept_misfit", "Write the calibration although readings and model contradict each other"},
               o.accept_misfit);
  describe(fields, o.wish);
}

Result<CalibrateOutcome> calibrate_lights(const CalibrateLightsOptions& options, const JobContext& context) {
  return LightsCalibration(options, context).run();
}

Result<PosesPrices> price_lights(const CalibrateLightsOptions& options, const JobContext& context) {
  return LightsCalibration(options, context).price();
}

}  // namespace weft::calibration
