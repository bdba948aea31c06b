// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/lights_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::calibration {
namespace {

double tilt_deg(const Pose& pose) {
  return angle_deg(normal_of(pose), {0, 0, 1});
}
double azimuth_deg(const Pose& pose) {
  const Vec3 n = normal_of(pose);
  return degrees(std::atan2(n.y, n.x));
}

// Mean departure of each reading over its channels, and its expected size.
double departure_of(const LightFit& fit, std::size_t i) {
  const auto& r = fit.residuals[i];
  return (r[0] + r[1] + r[2]) / 3;
}

// Root mean square of the residuals of the readings that `counts` chooses.
template <typename Counts>
double rms_of(const LightsEvidence& e, const Counts& counts) {
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < e.readings.size(); ++i) {
    if (!counts(e.readings[i])) continue;
    for (const double r : e.fit->residuals[i]) sum += r * r;
    n += 3;
  }
  return n > 0 ? std::sqrt(sum / n) : 0;
}
double rms_of_led(const LightsEvidence& e, std::size_t led) {
  return rms_of(e, [=](const PaperReading& r) { return r.led == led; });
}
double rms_of_sheet(const LightsEvidence& e, std::size_t sheet) {
  return rms_of(e, [=](const PaperReading& r) { return r.sheet == sheet; });
}

report::Section led_section(const LightsEvidence& e) {
  const LightFit& fit = *e.fit;
  report::Table table = {
      {"LED", "x mm", "y mm", "z mm", "sigma x, y, z mm", "from the tape mm", "aim off the centre deg", "mu",
       "flux of green", "red : green", "blue : green", "residual %"},
      {}};
  for (std::size_t k = 0; k < fit.scene.lights.leds.size(); ++k) {
    const NearLight& led = fit.scene.lights.leds[k];
    const Vec3 s = fit.position_sigma_mm[k];
    const double moved = length(led.position_mm - e.start.lights.leds[k].position_mm);
    table.rows.push_back({fmt::format("{}", k + 1), fmt::format("{:.2f}", led.position_mm.x),
                          fmt::format("{:.2f}", led.position_mm.y), fmt::format("{:.2f}", led.position_mm.z),
                          fmt::format("{:.2f}, {:.2f}, {:.2f}", s.x, s.y, s.z), fmt::format("{:.1f}", moved),
                          fmt::format("{:.1f}", angle_deg(led.aim, -1.0 * led.position_mm)),
                          fmt::format("{:.2f}", led.mu), fmt::format("{:.4g}", led.flux_rgb[1]),
                          fmt::format("{:.3f}", led.flux_rgb[0] / led.flux_rgb[1]),
                          fmt::format("{:.3f}", led.flux_rgb[2] / led.flux_rgb[1]),
                          fmt::format("{:.2f}", 100 * rms_of_led(e, k))});
  }
  report::Section section = {
      "LEDs",
      {fmt::format("Chi-square is {:.3f} for each of {:.0f} degrees of freedom, after {} iterations; from "
                   "{:.1f} on the photographs "
                   "contradict each other.",
                   fit.chi_square, fit.degrees_of_freedom, fit.iterations, kMisfitFrom),
       fit.leds_have_gains
           ? "The readings ask for a smooth gain of each LED's own: its light is not quite that of the model."
           : "No LED needs a gain of its own: the model of its light is enough.",
       fmt::format("From shot to shot LEDs flicker by {:.2f} percent, which is in all sigmas.",
                   100 * fit.flicker)},
      table,
      {}};
  if (const std::string lax = lax_gate(e); !lax.empty())
    section.paragraphs.insert(section.paragraphs.begin() + 1, lax + ".");
  return section;
}

report::Section sheet_section(const LightsEvidence& e) {
  const LightFit& fit = *e.fit;
  report::Table table = {{"session", "tilt deg by its tags", "after the fit", "towards deg",
                          "turned by the fit deg", "shifted mm", "residual %"},
                         {}};
  for (std::size_t j = 0; j < e.captures.size(); ++j) {
    const Pose &before = fit.sheets_before[j].rig_from_sheet, &after = fit.scene.sheets[j].rig_from_sheet;
    const double turned =
        std::max(angle_deg(normal_of(before), normal_of(after)), angle_deg(u_axis(before), u_axis(after)));
    table.rows.push_back({e.captures[j], fmt::format("{:.3f}", tilt_deg(before)),
                          fmt::format("{:.3f}", tilt_deg(after)), fmt::format("{:.1f}", azimuth_deg(after)),
                          fmt::format("{:.3f}", turned),
                          fmt::format("{:.3f}", length(after.translation_mm - before.translation_mm)),
                          fmt::format("{:.2f}", 100 * rms_of_sheet(e, j))});
  }
  return {"Sheets", {}, table, {}};
}

report::Section paper_section(const LightsEvidence& e) {
  const LightFit& fit = *e.fit;
  const auto& q = fit.scene.paper.log_albedo;
  report::Section section = {"Paper", {}, {}, {}};
  section.paragraphs.push_back(
      fmt::format("Departure from Lambert's law: 1 - delta (1 - n.l) with delta = {:.4f} +- {:.4f}.",
                  fit.scene.paper.delta, fit.delta_sigma));
  section.paragraphs.push_back(
      fmt::format("Its albedo changes by {:.2f} percent from left to right and {:.2f} from bottom to top.",
                  200 * q[0], 200 * q[1]));
  for (const PaperFault& fault : e.faults) {
    section.paragraphs.push_back(fmt::format(
        "Left out: a {} of {:.0f} mm^2 at u = {:.0f}, v = {:.0f} mm, {:.1f} percent.",
        fault.is_fold ? "fold" : "stain", fault.area_mm2, fault.u_mm, fault.v_mm, 100 * fault.departure));
  }
  return section;
}

report::Section error_section(const LightsEvidence& e) {
  const PredictedError& p = *e.predicted;
  const auto map_of = [&](const std::vector<double>& error_deg) {
    return report::FrameMap{p.grid.columns, p.grid.rows, error_deg, "deg", 0};
  };
  return {.title = "Predicted error of normals",
          .paragraphs = {fmt::format(
              "What the covariance of the lights makes of a solved normal: at a slope of 20 degrees {:.3f} "
              "degrees at the centre of the frame and {:.3f} in its worst corner.",
              p.centre_deg, p.corner_deg)},
          .figures = {{"Level cloth, degrees over the frame", map_of(p.level_deg)},
                      {"Slope of 20 degrees, degrees over the frame", map_of(p.slope_deg)}}};
}

// Mean departure of each LED over the frame, in percent.
report::Section residual_section(const LightsEvidence& e) {
  report::Section section = {"Residuals over the frame",
                             {"Mean over all sheets of measured over predicted, in percent. What is left "
                              "should be noise without shape."},
                             {},
                             {}};
  const CellGrid& grid = e.predicted->grid;
  for (std::size_t k = 0; k < e.start.lights.leds.size(); ++k) {
    std::vector<double> sum(grid.cells()), count(grid.cells());
    for (std::size_t i = 0; i < e.readings.size(); ++i) {
      const PaperReading& r = e.readings[i];
      if (r.led != k) continue;
      const std::size_t cell = grid.cell_of(r.x_px, r.y_px);
      sum[cell] += 100 * departure_of(*e.fit, i);
      ++count[cell];
    }
    for (std::size_t cell = 0; cell < grid.cells(); ++cell)
      sum[cell] = count[cell] > 0 ? sum[cell] / count[cell] : std::numeric_limits<double>::quiet_NaN();
    section.figures.push_back({fmt::format("LED {}", k + 1),
                               report::FrameMap{grid.columns, grid.rows, std::move(sum), "%", -0.5, 0.5}});
  }
  return section;
}

report::Section per_pixel_section(const LightsEvidence& e) {
  const PerPixelLights& p = *e.per_pixel;
  report::Section section = {"By the pixel", {}, report::Table{{"LED", "most apart deg", "rms deg"}, {}}, {}};
  section.paragraphs.push_back(
      fmt::format("Directions and intensities of {} x {} cells without a model of the LED, settled to {:.4f} "
                  "degrees in {} rounds. Where they "
                  "part from the model's, the LED is not what the model says.",
                  p.grid.columns, p.grid.rows, p.changes_deg.back(), p.changes_deg.size()));
  for (std::size_t k = 0; k < p.apart_deg.size(); ++k) {
    double sum = 0;
    for (const double a : p.apart_deg[k]) sum += a * a / static_cast<double>(p.apart_deg[k].size());
    section.table->rows.push_back(
        {fmt::format("{}", k + 1),
         fmt::format("{:.3f}", *std::max_element(p.apart_deg[k].begin(), p.apart_deg[k].end())),
         fmt::format("{:.3f}", std::sqrt(sum))});
    section.figures.push_back({fmt::format("LED {}: degrees between map and model", k + 1),
                               report::FrameMap{p.grid.columns, p.grid.rows, p.apart_deg[k], "deg", 0, {}}});
  }
  return section;
}

constexpr const char* kSeedSays =
    "One flat sheet gives one reading for two unknowns, intensity and direction: that the paper residual "
    "falls says nothing of the directions. The azimuth of every direction is never changed.";

report::Section seed_section(const LightsEvidence& e) {
  report::Section section = {"The seed's iteration",
                             {kSeedSays},
                             report::Table{{"iteration", "intensities changed by %",
                                            "directions changed by deg", "paper residual deg", ""},
                                           {}},
                             {}};
  section.is_answer = true;
  for (std::size_t i = 0; i < e.seed->steps.size(); ++i) {
    const SeedStep& step = e.seed->steps[i];
    section.table->rows.push_back(
        {fmt::format("{}", i), fmt::format("{:.4f}", 100 * step.intensity_change),
         fmt::format("{:.4f}", step.direction_change_deg), fmt::format("{:.4f}", step.paper_residual_deg),
         step.direction_change_deg < 1e-4 ? "directions not updated by this step" : ""});
  }
  return section;
}

Json numbers_of(const LightsEvidence& e) {
  Json numbers = {{"points", e.points}};
  for (const FittedSession& session : e.fitted)
    numbers["fitted"].push_back({{"session", session.name}, {"lit_sha256", session.lit_sha256}});
  if (e.fit) {
    const LightFit& fit = *e.fit;
    numbers["chi_square"] = fit.chi_square;
    numbers["degrees_of_freedom"] = fit.degrees_of_freedom;
    numbers["iterations"] = fit.iterations;
    numbers["leds_have_gains"] = fit.leds_have_gains;
    numbers["flicker"] = fit.flicker;
    numbers["worst_position_sigma_mm"] = fit.worst_position_sigma_mm();
    numbers["delta"] = fit.scene.paper.delta;
    numbers["delta_sigma"] = fit.delta_sigma;
    numbers["readings"] = e.readings.size();
    for (std::size_t k = 0; k < fit.scene.lights.leds.size(); ++k) {
      const Vec3 p = fit.scene.lights.leds[k].position_mm, s = fit.position_sigma_mm[k];
      numbers["leds"].push_back({{"led", k + 1},
                                 {"position_mm", {p.x, p.y, p.z}},
                                 {"sigma_mm", {s.x, s.y, s.z}},
                                 {"residual", rms_of_led(e, k)}});
    }
    for (std::size_t j = 0; j < e.captures.size(); ++j) {
      const Pose& pose = fit.scene.sheets[j].rig_from_sheet;
      numbers["sheets"].push_back({{"session", e.captures[j]},
                                   {"tilt_deg", tilt_deg(pose)},
                                   {"azimuth_deg", azimuth_deg(pose)},
                                   {"turn_deg", turn_deg(pose)},
                                   {"residual", rms_of_sheet(e, j)}});
    }
  }
  for (const PaperFault& f : e.faults) {
    numbers["faults"].push_back({{"kind", f.is_fold ? "fold" : "stain"},
                                 {"u_mm", f.u_mm},
                                 {"v_mm", f.v_mm},
                                 {"area_mm2", f.area_mm2},
                                 {"departure", f.departure}});
  }
  if (e.predicted) {
    numbers["predicted_normal_deg"] = {{"slope_deg", 20},
                                       {"centre", e.predicted->centre_deg},
                                       {"corner", e.predicted->corner_deg},
                                       {"columns", e.predicted->grid.columns},
                                       {"rows", e.predicted->grid.rows},
                                       {"grid", e.predicted->slope_deg}};
  }
  if (e.per_pixel)
    numbers["per_pixel"] = {{"rounds", e.per_pixel->changes_deg.size()},
                            {"change_deg", e.per_pixel->changes_deg.back()}};
  if (e.seed) {
    for (const SeedStep& step : e.seed->steps) {
      numbers["seed"].push_back({{"intensity_change", step.intensity_change},
                                 {"direction_change_deg", step.direction_change_deg},
                                 {"paper_residual_deg", step.paper_residual_deg}});
    }
  }
  return numbers;
}

}  // namespace

std::string lax_gate(const LightsEvidence& e) {
  if (!e.fit || e.fit->chi_square >= kLaxBelow) return "";
  std::string text = fmt::format(
      "Chi-square of {:.2f} says that light and paper agree better than was allowed for: the gate "
      "at {:.1f} is lax by a factor of {:.1f}",
      e.fit->chi_square, kMisfitFrom, 1 / e.fit->chi_square);
  if (e.flatness_deg > 0)
    text += fmt::format(", and --flatness below {:g} makes it as strict as it should be", e.flatness_deg);
  return text;
}

CalibrationReport lights_report(const LightsEvidence& e, std::vector<Verdict> verdicts) {
  CalibrationReport report;
  report.part = "lights";
  report.title = fmt::format("Lights of {}", e.rig);
  if (e.fit) {
    report.summary = fmt::format(
        "{} LEDs from {} photographed {}: positions to {:.2f} mm at worst, chi-square {:.2f}",
        e.start.lights.leds.size(), e.captures.size(), e.captures.size() == 1 ? "sheet" : "sheets",
        e.fit->worst_position_sigma_mm(), e.fit->chi_square);
    if (e.predicted)
      report.summary += fmt::format(
          ", normals at 20 degrees of slope to {:.2f} degrees at the centre and {:.2f} in the corner",
          e.predicted->centre_deg, e.predicted->corner_deg);
    report.summary += ".";
  } else {
    report.summary =
        fmt::format("{} LEDs by the seed's iteration on one flat sheet: directions are those of the tape.",
                    e.start.lights.leds.size());
  }
  report.summary += fmt::format(" {} fixed point{} beside the sheet.", e.points, e.points == 1 ? "" : "s");
  report.verdicts = std::move(verdicts);
  if (e.fit) {
    report.sections.push_back(led_section(e));
    report.sections.push_back(sheet_section(e));
    report.sections.push_back(paper_section(e));
    if (e.predicted) {
      report.sections.push_back(error_section(e));
      report.sections.push_back(residual_section(e));
    }
  }
  if (e.per_pixel) report.sections.push_back(per_pixel_section(e));
  if (e.seed) report.sections.push_back(seed_section(e));
  report.numbers = numbers_of(e);
  return report;
}

std::string worst_of(const LightsEvidence& e) {
  std::size_t sheet = 0, led = 0;
  for (std::size_t j = 1; j < e.captures.size(); ++j) {
    if (rms_of_sheet(e, j) > rms_of_sheet(e, sheet)) sheet = j;
  }
  for (std::size_t k = 1; k < e.start.lights.leds.size(); ++k) {
    if (rms_of_led(e, k) > rms_of_led(e, led)) led = k;
  }
  return fmt::format("{} ({:.2f} percent rms) and LED {} ({:.2f})", e.captures[sheet],
                     100 * rms_of_sheet(e, sheet), led + 1, 100 * rms_of_led(e, led));
}

}  // namespace weft::calibration
