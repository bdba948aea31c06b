// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/camera_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weft::calibration {
namespace {

constexpr int kColumns = 12, kRows = 8;     // of the coverage
constexpr double kLeastCoverage = 0.6;      // of these parts
constexpr double kMostFlatness_deg = 0.1;   // of the board in several photographs of the table
constexpr double kMostFrameShift_mm = 0.1;  // that lights survive
constexpr double kWidestSigma_mm = 0.05;    // of the pixel to table mapping

struct Measured {
  double value = 0, sigma = 0;
};

Json measured_json(Measured m) {
  return {{"value", m.value}, {"sigma", m.sigma}};
}

std::string words(Measured m, int digits) {
  return fmt::format("{:.{}f} ± {:.{}f}", m.value, digits, m.sigma, digits);
}

// Towards the table, rig frame.
Vec3 line_of_sight(const CameraModel& c) {
  const auto& r = c.camera_from_rig_rotation;
  return {r[2][0], r[2][1], r[2][2]};
}

double mm_per_pixel(const CameraModel& c) {
  const double x = (c.size.width - 1) / 2.0, y = (c.size.height - 1) / 2.0;
  const Vec3 o = point_on_plane(c, x, y, 0);
  return std::sqrt(length(cross(point_on_plane(c, x + 1, y, 0) - o, point_on_plane(c, x, y + 1, 0) - o)));
}

/// Predicted standard deviation of where a pixel is on the table, in mm, over the frame.
report::FrameMap table_sigma(const CameraFitFacts& facts) {
  report::FrameMap map = {kColumns, kRows, {}, "mm"};
  const Size size = facts.fit.camera.size;
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const double x = (i + 0.5) / kColumns * size.width - 0.5, y = (j + 0.5) / kRows * size.height - 0.5;
      const auto sigma = [&](double Vec3::*axis) {
        return propagated(facts.fit.camera, facts.fit.covariance,
                          [&](const CameraModel& c) { return point_on_plane(c, x, y, 0).*axis; });
      };
      map.values.push_back(std::hypot(sigma(&Vec3::x), sigma(&Vec3::y)));
    }
  }
  return map;
}

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// What the report says in numbers.
struct Figures {
  Measured fx, fy, cx, cy, height_mm, tilt_deg, scale_mm;
  report::FrameMap table_sigma_mm;
  std::vector<int> corners;  // of each part of the frame
  double coverage = 0;
};

Figures figures_of(const CameraFitFacts& facts) {
  const CameraModel& camera = facts.fit.camera;
  const auto measured = [&](const std::function<double(const CameraModel&)>& value) {
    return Measured{value(camera), propagated(camera, facts.fit.covariance, value)};
  };
  Figures f;
  f.fx = measured([](const CameraModel& c) { return c.fx; });
  f.fy = measured([](const CameraModel& c) { return c.fy; });
  f.cx = measured([](const CameraModel& c) { return c.cx; });
  f.cy = measured([](const CameraModel& c) { return c.cy; });
  f.height_mm = measured([](const CameraModel& c) { return centre_of(c).z; });
  f.scale_mm = measured(mm_per_pixel);
  const Vec3 sight = line_of_sight(camera);
  f.tilt_deg.value = angle_deg(sight, {0, 0, -1});
  // Along x and along y: where the camera looks straight down the angle itself has no slope.
  f.tilt_deg.sigma =
      degrees(std::max(measured([](const CameraModel& c) { return line_of_sight(c).x; }).sigma,
                       measured([](const CameraModel& c) { return line_of_sight(c).y; }).sigma));
  f.table_sigma_mm = table_sigma(facts);
  f.corners = corner_counts(facts.views, camera.size, kColumns, kRows);
  f.coverage =
      static_cast<double>(std::count_if(f.corners.begin(), f.corners.end(), [](int n) { return n > 0; })) /
      static_cast<double>(f.corners.size());
  return f;
}

double tilt_of(const BoardFit& board) {
  return angle_deg(board.rig_from_board.rotation * Vec3{0, 0, 1}, {0, 0, 1});
}

/// How far a pixel of the frame moved on the table since the earlier camera, at most, at centre and corners.
double moved_mm(const CameraModel& before, const CameraModel& now) {
  double most = 0;
  for (const double u : {0.0, 0.5, 1.0}) {
    for (const double v : {0.0, 0.5, 1.0}) {
      const double x = u * (now.size.width - 1), y = v * (now.size.height - 1);
      most = std::max(most, length(point_on_plane(now, x, y, 0) - point_on_plane(before, x, y, 0)));
    }
  }
  return std::max(most, length(centre_of(now) - centre_of(before)));
}

std::string stretch_words(const PrintStretch& print) {
  return fmt::format(
      "The print is {:.2f} percent longer {} (sigma {:.2f}), and was taken so: square_mm is the mean of both",
      100 * std::abs(print.share), print.share > 0 ? "down than across" : "across than down",
      100 * print.sigma);
}

/// Whether photographs show a board that was drawn before OpenCV 4.6.
bool has_old_pattern(const CameraFitFacts& facts) {
  return std::ranges::any_of(
      facts.viewed, [&](std::size_t i) { return facts.photographs.photographs[i].sighting.old_pattern; });
}

std::vector<Verdict> verdicts_of(const CameraFitFacts& facts, const Figures& f) {
  std::vector<Verdict> verdicts;
  if (f.coverage < kLeastCoverage) {
    verdicts.push_back(
        {"WEAK_COVERAGE",
         fmt::format("Corners of boards were seen in {:.0f} percent of the frame only", 100 * f.coverage),
         "photograph the board in the corners of the frame too"});
  }
  if (const double sigma_mm = rms(f.table_sigma_mm.values); sigma_mm > kWidestSigma_mm) {
    verdicts.push_back(
        {"WEAK_MAPPING",
         fmt::format("A pixel's place on the table is known to {:.3f} mm only (predicted, rms)", sigma_mm),
         "take more photographs of the board, tilted by 20 to 40 degrees to all sides"});
  }
  if (facts.fit.print.is_used) {
    verdicts.push_back({"PRINT_STRETCHED", stretch_words(facts.fit.print),
                        "measure ten squares across and ten down, and say the mean of one as square_mm"});
  }
  for (std::size_t i = 0; i < facts.views.size(); ++i) {
    const BoardFit& board = facts.fit.boards[i];
    if (board.used && facts.photographs.photographs[facts.viewed[i]].of_table &&
        tilt_of(board) > kMostFlatness_deg) {
      verdicts.push_back(
          {"BOARD_NOT_FLAT",
           fmt::format("{}: the board is tilted by {:.2f} degrees to the first photograph of the table",
                       facts.views[i].name, tilt_of(board)),
           "lay the board flat, with nothing below it"});
    }
  }
  if (facts.from && facts.from->lights && facts.from->camera &&
      facts.from->camera->size == facts.fit.camera.size) {
    const double mm = moved_mm(*facts.from->camera, facts.fit.camera);
    if (mm > kMostFrameShift_mm) {
      verdicts.push_back(
          {"LIGHTS_OF_ANOTHER_FRAME",
           fmt::format("The lights were measured with a camera that this one differs from by up to {:.1f} "
                       "mm",
                       mm),
           "calibrate the lights again"});
    }
  }
  return verdicts;
}

report::Table board_table(const CameraFitFacts& facts) {
  report::Table table = {{"photograph", "corners", "edges, pixels", "tilt, degrees", "residual, pixels", ""},
                         {}};
  for (std::size_t p = 0; p < facts.photographs.photographs.size(); ++p) {
    const BoardPhotograph& photograph = facts.photographs.photographs[p];
    const auto view = std::find(facts.viewed.begin(), facts.viewed.end(), p);
    std::vector<std::string> row = {photograph.name, "", "", "", "", photograph.left_out};
    if (!photograph.sighting.corners.empty()) {
      row[1] = fmt::format("{}", photograph.sighting.corners.size());
      row[2] = fmt::format("{:.1f}", photograph.sighting.edge_px);
    }
    if (view != facts.viewed.end()) {
      const BoardFit& fit = facts.fit.boards[static_cast<std::size_t>(view - facts.viewed.begin())];
      row[3] = fmt::format("{:.2f}", tilt_of(fit));
      row[4] = fmt::format("{:.3f}", fit.rms_px);
      row[5] = !fit.used ? "does not fit the others" : photograph.of_table ? "table" : "";
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Table covariance_table(const ParameterCovariance& covariance) {
  const std::size_t n = covariance.parameters.size();
  const auto sigma = [&](std::size_t i) { return std::sqrt(covariance.matrix[i * n + i]); };
  report::Table table = {{"parameter", "standard deviation"}, {}};
  for (std::size_t j = 0; j < n; ++j) table.header.push_back(fmt::format("{}", j + 1));
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<std::string> row = {fmt::format("{} {}", i + 1, covariance.parameters[i]),
                                    fmt::format("{:.3g}", sigma(i))};
    for (std::size_t j = 0; j < n; ++j)
      row.push_back(j > i ? "" : fmt::format("{:.2f}", covariance.matrix[i * n + j] / (sigma(i) * sigma(j))));
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Table trial_table(const std::vector<LensTrial>& trials) {
  report::Table table = {{"terms", "held-out error, pixels", "better by, standard errors", "than", ""}, {}};
  for (const LensTrial& t : trials) {
    table.rows.push_back({t.terms, fmt::format("{:.4f}", t.held_out_px),
                          t.than.empty() ? "" : fmt::format("{:.1f}", t.better_by), t.than,
                          t.chosen ? "chosen" : ""});
  }
  return table;
}

report::Figure residual_arrows(const CameraFitFacts& facts) {
  std::vector<report::Arrow> arrows;
  for (std::size_t i = 0; i < facts.views.size(); ++i) {
    if (!facts.fit.boards[i].used) continue;
    for (std::size_t k = 0; k < facts.views[i].corners.size(); ++k) {
      const auto at = facts.views[i].corners[k].px;
      const auto by = facts.fit.boards[i].residual_px[k];
      arrows.push_back({at.x, at.y, by.x, by.y});
    }
  }
  const double longest = 0.03 * facts.fit.camera.size.width;
  const double magnification =
      std::pow(10, std::floor(std::log10(longest / std::max(facts.fit.rms_px, 1e-6))));
  return {
      fmt::format(
          "Where corners were seen against where they are predicted, {:g} times as long; rms {:.3f} pixels",
          magnification, facts.fit.rms_px),
      report::Arrows{facts.fit.camera.size, std::move(arrows), magnification}};
}

Json numbers_of(const CameraFitFacts& facts, const Figures& f) {
  const CameraModel& c = facts.fit.camera;
  Json boards = Json::array(), trials = Json::array();
  for (std::size_t p = 0; p < facts.photographs.photographs.size(); ++p) {
    const BoardPhotograph& photograph = facts.photographs.photographs[p];
    const auto view = std::find(facts.viewed.begin(), facts.viewed.end(), p);
    Json board = {{"file", photograph.name},
                  {"of_table", photograph.of_table},
                  {"corners", photograph.sighting.corners.size()},
                  {"edge_px", photograph.sighting.edge_px},
                  {"used", false},
                  {"left_out", photograph.left_out}};
    if (view != facts.viewed.end()) {
      const BoardFit& fit = facts.fit.boards[static_cast<std::size_t>(view - facts.viewed.begin())];
      board["used"] = fit.used;
      board["rms_px"] = fit.rms_px;
      board["tilt_deg"] = tilt_of(fit);
    }
    boards.push_back(std::move(board));
  }
  for (const LensTrial& t : facts.fit.trials) {
    trials.push_back({{"terms", t.terms},
                      {"held_out_px", t.held_out_px},
                      {"better_by", t.better_by},
                      {"chosen", t.chosen}});
  }
  return {{"focal_px", {measured_json(f.fx), measured_json(f.fy)}},
          {"principal_point_px", {measured_json(f.cx), measured_json(f.cy)}},
          {"distortion", {{"k1", c.k1}, {"k2", c.k2}, {"k3", c.k3}, {"p1", c.p1}, {"p2", c.p2}}},
          {"height_mm", measured_json(f.height_mm)},
          {"tilt_deg", measured_json(f.tilt_deg)},
          {"mm_per_pixel", measured_json(f.scale_mm)},
          {"table_sigma_mm", rms(f.table_sigma_mm.values)},
          {"rms_px", facts.fit.rms_px},
          {"corner_sigma_px", facts.fit.corner_sigma_px},
          {"coverage", f.coverage},
          {"print_stretch_percent",
           std::isfinite(facts.fit.print.sigma)
               ? measured_json({100 * facts.fit.print.share, 100 * facts.fit.print.sigma})
               : Json()},
          {"print_stretch_used", facts.fit.print.is_used},
          {"old_pattern", has_old_pattern(facts)},
          {"tags", facts.fiducials.size()},
          {"photographs", std::move(boards)},
          {"trials", std::move(trials)},
          {"covariance",
           {{"parameters", facts.fit.covariance.parameters}, {"matrix", facts.fit.covariance.matrix}}}};
}

}  // namespace

std::vector<std::string> left_out(const CameraFitFacts& facts) {
  std::vector<std::string> sentences;
  for (const BoardPhotograph& p : facts.photographs.photographs) {
    if (!p.left_out.empty()) sentences.push_back(fmt::format("{} is left out: {}", p.name, p.left_out));
  }
  for (std::size_t i = 0; i < facts.views.size(); ++i) {
    if (facts.fit.boards[i].used) continue;
    sentences.push_back(
        fmt::format("{} is left out: its corners miss by {:.2f} pixels, those of the others by {:.2f}",
                    facts.views[i].name, facts.fit.boards[i].rms_px, facts.fit.rms_px));
  }
  return sentences;
}

CalibrationReport camera_report(const CameraFitFacts& facts) {
  const Figures f = figures_of(facts);
  const CameraModel& c = facts.fit.camera;
  const auto used =
      std::count_if(facts.fit.boards.begin(), facts.fit.boards.end(), [](const auto& b) { return b.used; });
  CalibrationReport report;
  report.part = "camera";
  report.title = fmt::format("Camera of {}", facts.rig);
  report.summary = fmt::format(
      "{} of {} photographs used; corners fit to {:.3f} pixels; a pixel is {:.5f} mm on the table and its "
      "place is known "
      "to {:.3f} mm (predicted, rms).",
      used, facts.photographs.photographs.size(), facts.fit.rms_px, f.scale_mm.value,
      rms(f.table_sigma_mm.values));
  if (facts.lateral && facts.lateral->color) {
    report.summary +=
        fmt::format(" In the corner red looks {:+.2f} and blue {:+.2f} pixels farther out than green.",
                    facts.lateral->corner_px[0], facts.lateral->corner_px[1]);
  }
  if (has_old_pattern(facts))
    report.summary += " This board has the pattern of before OpenCV 4.6, and was read so.";
  report.verdicts = verdicts_of(facts, f);
  report.numbers = numbers_of(facts, f);

  const PrintStretch& print = facts.fit.print;
  report::Table numbers = {{"", "value"}, {}};
  numbers.rows = {
      {"focal length along x, pixels", words(f.fx, 2)},
      {"focal length along y, pixels", words(f.fy, 2)},
      {"principal point x, pixels", words(f.cx, 2)},
      {"principal point y, pixels", words(f.cy, 2)},
      {"k1, k2, k3", fmt::format("{:.5f}, {:.5f}, {:.5f}", c.k1, c.k2, c.k3)},
      {"p1, p2", fmt::format("{:.6f}, {:.6f}", c.p1, c.p2)},
      {"height of the camera above the table, mm", words(f.height_mm, 3)},
      {"tilt of the camera, degrees", words(f.tilt_deg, 4)},
      {"mm a pixel at the frame's centre", words(f.scale_mm, 6)},
      {"noise of a corner along x or y, pixels", fmt::format("{:.3f}", facts.fit.corner_sigma_px)},
      {"the print is longer down than across by, percent",
       std::isfinite(print.sigma)
           ? words({100 * print.share, 100 * print.sigma}, 3) + (print.is_used ? "" : ", not used")
           : "not known"},
      {"tags on the table", fmt::format("{}", facts.fiducials.size())}};
  if (const auto& spread = facts.spread) {
    numbers.rows.push_back(
        {"spread of the lens, R, G, B, pixels", fmt::format("{:.3f}, {:.3f}, {:.3f}", spread->sigma_px[0],
                                                            spread->sigma_px[1], spread->sigma_px[2])});
    report.numbers["point_spread_px"] = spread->sigma_px;
  }
  if (const auto& lateral = facts.lateral) {
    for (const auto& [i, colour] : {std::pair{0U, "red"}, {1U, "blue"}}) {
      const Measured corner = {lateral->corner_px[i], lateral->sigma_corner_px[i]};
      numbers.rows.push_back({fmt::format("{} looks farther out than green in the corner by, pixels", colour),
                              words(corner, 3)});
      report.numbers["lateral_corner_px"][colour] = measured_json(corner);
    }
  }
  report.sections.push_back(
      {"Numbers", {"Each with its standard deviation, by the noise that the corners show."}, numbers});

  report.sections.push_back({"Reprojection", {}, {}, {residual_arrows(facts)}});
  report::FrameMap coverage = {kColumns, kRows, {f.corners.begin(), f.corners.end()}, "corners"};
  report.sections.push_back(
      {"Coverage of the frame",
       {fmt::format("{:.0f} percent of the frame's parts have corners in them.", 100 * f.coverage)},
       {},
       {{"Corners seen", std::move(coverage)},
        {"Predicted standard deviation of a pixel's place on the table", f.table_sigma_mm}}});
  report.sections.push_back({"Photographs", {}, board_table(facts)});
  report.sections.push_back({"Distortion terms",
                             {"Error on boards that were not fitted to, five folds. Terms beyond k1 and k2 "
                              "are taken where they are better "
                              "by over two standard errors."},
                             trial_table(facts.fit.trials)});
  report.sections.push_back(
      {"Covariance", {"Standard deviations and correlations."}, covariance_table(facts.fit.covariance)});
  return report;
}

}  // namespace weft::calibration
