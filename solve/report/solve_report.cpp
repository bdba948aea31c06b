// SPDX-License-Identifier: Apache-2.0
#include "solve/report/solve_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "core/base/files.h"
#include "core/base/percent.h"
#include "core/base/statistics.h"
#include "core/describe/field_json.h"
#include "solve/photographs/diagnosis_pixels.h"
#include "solve/report/left_out_report.h"
#include "solve/report/report_page.h"
#include "solver/diagnosis/highlights.h"
#include "solver/method.h"
#include "solver/uncertainty/model_sigma.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;
using solver::Fault;
using solver::FaultKind;

// Without those that moved there must be more lights than the three that always fit.
constexpr std::size_t kLeastOfMoved = 4;
// A gain that turns the normals by less is in the report, but nobody is warned of it.
constexpr double kLeastWarned_deg = 0.05;
constexpr int kGridSide = 32;
// Bins of the logarithm of sigma, from 1e-4 to 180 degrees, 1 percent each.
constexpr double kLeastSigma = 1e-4, kBinRatio = 1.01;
constexpr std::size_t kBins = 1450;

// JSON has no infinity; enough digits to read, few enough to compare.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

double percent(double share) {
  return 100 * share;
}

// "3", "3 and 4", "3, 4 and 8".
std::string listed(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0) text += i + 1 == numbers.size() ? " and " : ", ";
    text += std::to_string(numbers[i]);
  }
  return text;
}

std::string joined(const std::vector<int>& numbers) {
  std::string text;
  for (const int n : numbers) text += (text.empty() ? "" : ",") + std::to_string(n);
  return text;
}

// Speaks of the lights of one solve.
struct Speaker {
  const PhotographsSummary& photographs;

  std::vector<int> numbers(const std::vector<std::size_t>& lights) const {
    std::vector<int> all;
    for (const std::size_t k : lights) all.push_back(photographs.numbers[k]);
    return all;
  }
  std::string name(const std::vector<std::size_t>& lights) const {
    const char* noun = photographs.of_session ? "LED" : "Light";
    return fmt::format("{}{} {}", noun, lights.size() > 1 ? "s" : "", listed(numbers(lights)));
  }
  // What solves without these lights, where enough are left: ", or ...".
  std::string or_without(const std::vector<std::size_t>& lights) const {
    if (photographs.numbers.size() < lights.size() + 3) return "";
    if (!photographs.session.empty()) return ", or " + leave_out(lights) + " and solve again";
    if (photographs.numbers.size() > 16) return ", or solve with the other lights (--lights)";
    std::vector<int> rest;
    for (std::size_t k = 0; k < photographs.numbers.size(); ++k) {
      if (std::find(lights.begin(), lights.end(), k) == lights.end()) rest.push_back(photographs.numbers[k]);
    }
    return ", or solve with --lights " + joined(rest);
  }
  // So that no later solve has them either.
  std::string leave_out(const std::vector<std::size_t>& lights) const {
    std::vector<int> shots = photographs.left_out;
    for (const int led : numbers(lights)) {
      const auto shot = photographs.shot_of_led.find(led);
      if (shot != photographs.shot_of_led.end()) shots.push_back(shot->second);
    }
    return fmt::format("leave {} out with weft library tag {} --set left_out={}",
                       lights.size() > 1 ? "them" : "it", photographs.session, joined(shots));
  }
  // What turns a residual before and after into words.
  static std::string falls(const Fault& fault) {
    return fmt::format("the residual of their readings falls from {:.1f} to {:.1f} percent",
                       percent(fault.residual_before), percent(fault.residual_after));
  }

  Verdict exchanged(const Fault& fault) const {
    const char* place = photographs.of_session ? "session.json" : "the list of lights";
    const char* first = photographs.of_session ? "check the wiring; for these photographs " : "";
    if (fault.lights.size() == 2) {
      return {"LEDS_EXCHANGED",
              fmt::format("{} look swapped: with them exchanged {}", name(fault.lights), falls(fault)),
              fmt::format("{}exchange the numbers {} in {} and solve again{}", first,
                          listed(numbers(fault.lights)), place, or_without(fault.lights))};
    }
    std::string order;
    for (std::size_t i = 0; i < fault.lights.size(); ++i) {
      order += fmt::format("{}{} is seen in photograph {}", order.empty() ? "" : ", ",
                           photographs.numbers[fault.lights[i]], photographs.numbers[fault.shown_by[i]]);
    }
    return {"LEDS_EXCHANGED",
            fmt::format("{} look out of order: {}; with them in order {}", name(fault.lights), order,
                        falls(fault)),
            fmt::format("{}put the numbers in {} in order and solve again{}", first, place,
                        or_without(fault.lights))};
  }
  Verdict dead(const Fault& fault) const {
    return {"LED_DEAD",
            fmt::format("{} looks dead: its photograph shows {:.1f} percent of the light it should",
                        name(fault.lights), std::max(0.0, percent(fault.value))),
            (photographs.of_session ? "check the LED and its cable and scan again"
                                    : "photograph again under it") +
                or_without(fault.lights)};
  }
  Verdict gain(const Fault& fault) const {
    return {"LED_GAIN",
            fmt::format("{} gives {:.1f} percent of what its calibration says (± {:.1f}), which turns "
                        "the normals by {:.2f}°",
                        name(fault.lights), percent(fault.value), percent(fault.sigma), fault.moved_deg),
            (photographs.of_session ? "calibrate the lights again"
                                    : "see whether it was exposed otherwise than the rest") +
                or_without(fault.lights)};
  }
  Verdict operator()(const Fault& fault) const {
    switch (fault.kind) {
      case FaultKind::kExchanged:
        return exchanged(fault);
      case FaultKind::kDead:
        return dead(fault);
      case FaultKind::kGain:
        return gain(fault);
    }
    return {};
  }
};

FaultFacts facts_of(const Fault& fault, const Speaker& say) {
  return {.kind = fault.kind,
          .lights = say.numbers(fault.lights),
          .shown_by = say.numbers(fault.shown_by),
          .value = fault.value,
          .sigma = fault.sigma,
          .residual_before = fault.residual_before,
          .residual_after = fault.residual_after,
          .moved_deg = fault.moved_deg,
          .confidence = fault.agreement};
}

LightFacts facts_of(const solver::LightEvidence& light, int number_of_light) {
  return {.light = number_of_light,
          .residual_rms = light.residual_rms,
          .residual_median = light.residual_median,
          .residual_mean = light.residual_mean,
          .gain = light.gain,
          .gain_range = light.gain_range,
          .saturated = light.saturated,
          .shadowed = light.shadowed,
          .missing = light.missing,
          .outlier = light.outlier,
          .gradient = light.gradient,
          .gradient_share = light.gradient_share};
}

// The share of the maps' pixels.
double share_with(const SolveFacts& solve, StatusBit bit) {
  return static_cast<double>(solve.status.with(bit)) / static_cast<double>(solve.size.pixels());
}

// Where the error comes from: what is known of each source, in its own unit.
std::vector<ErrorSource> budget_of(const PhotographsSummary& photographs, const SigmaFacts& sigma,
                                   const SolveFacts& solve) {
  std::vector<ErrorSource> budget;
  const auto add = [&](const char* source, const std::string& what, double value, const char* unit) {
    if (std::isfinite(value)) budget.push_back({source, what, value, unit});
  };
  const char* noise = photographs.noise_is_known ? "photon and read noise" : "scatter of the readings";
  for (const auto& [source, part] : {std::pair{noise, sigma.noise},
                                     {"what the model leaves out", sigma.model},
                                     {"calibration", sigma.calibration}}) {
    if (part) add(source, "median predicted angle of the normal", part->median, "deg");
  }
  for (const Fault& fault : photographs.diagnosis.faults) {
    if (fault.kind == FaultKind::kDead) continue;
    const Speaker say = {photographs};
    add(fault.kind == FaultKind::kGain ? "gain of a light" : "exchanged lights",
        fmt::format("{} put right would turn half of the normals by more", say.name(fault.lights)),
        fault.moved_deg, "deg");
  }
  add("cloth unlike the model", "median deviation of the readings, over the albedo",
      percent(photographs.diagnosis.left), "percent");
  const auto share = [&](const char* source, const char* what, StatusBit bit) {
    add(source, what, percent(share_with(solve, bit)), "percent");
  };
  share("shadows", "pixels with a reading left out for shadow", kShadowed);
  share("highlights", "pixels with a reading over three times the prediction", kSpecular);
  share("saturation", "pixels with a reading left out as saturated", kSaturated);
  return budget;
}

// None where nothing was added.
std::optional<AngleMiddle> middle_of(const AngleHistogram& angles) {
  const double median = angles.quantile(0.5);
  if (!std::isfinite(median)) return std::nullopt;
  return AngleMiddle{median, angles.quantile(0.95)};
}

}  // namespace

AngleHistogram::AngleHistogram() : counts_(kBins) {}

void AngleHistogram::add(double angle_deg) {
  if (!std::isfinite(angle_deg)) return;
  const double bin = std::log(std::max(angle_deg, kLeastSigma) / kLeastSigma) / std::log(kBinRatio);
  ++counts_[std::min(static_cast<std::size_t>(bin), kBins - 1)];
  sum_deg_ += angle_deg;
}

double AngleHistogram::mean() const {
  std::int64_t all = 0;
  for (const std::int64_t n : counts_) all += n;
  return all > 0 ? sum_deg_ / static_cast<double>(all) : 0;
}

double AngleHistogram::quantile(double share) const {
  std::int64_t all = 0, seen = 0;
  for (const std::int64_t n : counts_) all += n;
  for (std::size_t i = 0; i < kBins; ++i) {
    seen += counts_[i];
    if (seen > 0 && static_cast<double>(seen) >= share * static_cast<double>(all)) {
      return kLeastSigma * std::pow(kBinRatio, static_cast<double>(i) + 0.5);
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

MapSummary::MapSummary(Size size) : sigma_(size, 1, kGridSide), row_({size.width, 1}) {}

void MapSummary::add(const MapBand& band, View<const float> normal_deg, View<const float> calibration_deg) {
  for (int y = 0; y < band.albedo_rows.height(); ++y) {
    const float* sigma = normal_deg.row(y);
    for (int x = 0; x < row_.width(); ++x) {
      const bool known = sigma[x] < solver::kUnknownAngleDeg;
      row_(x, 0) = known ? sigma[x] : std::numeric_limits<float>::quiet_NaN();
      if (!known) continue;
      sum_.add(sigma[x]);
      noise_.add(band.sigma_normal_deg(x, y));
      model_.add(band.model_normal_deg(x, y));
      if (calibration_deg.height() > 0) calibration_.add(calibration_deg(x, y));
    }
    sigma_.add_rows(std::array{View<const float>(row_.plane())});
  }
  constexpr unsigned kNoCloth = kNoSolution | kInvalidReading;
  for (int y = 0; y < band.status.height(); ++y) {
    for (int x = 0; x < band.status.width(); ++x) {
      const unsigned status = band.status(x, y);
      if (status != kNoCloth) ++cloth_;
      if ((status & kNoSolution) == 0) ++solved_;
    }
  }
}

ExpectedError MapSummary::expected() const {
  const auto mean_deg = [](const AngleHistogram& rms) { return solver::kMeanOfRms * rms.mean(); };
  const bool is_known = std::isfinite(sum_.quantile(0.5));
  const double total_deg = is_known || solved_ == 0 ? mean_deg(sum_) : deg_of_whole(0, 0);
  return {total_deg, mean_deg(noise_), mean_deg(model_), mean_deg(calibration_),
          cloth_ > 0 ? static_cast<double>(solved_) / static_cast<double>(cloth_) : 0};
}

SigmaFacts MapSummary::sigma_facts() const {
  SigmaFacts facts = {.noise = middle_of(noise_),
                      .model = middle_of(model_),
                      .calibration = middle_of(calibration_),
                      .solved = expected().solved};
  if (const std::optional<AngleMiddle> all = middle_of(sum_)) {
    facts.median = all->median;
    facts.p95 = all->p95;
  }
  return facts;
}

SigmaMap MapSummary::sigma_map() const {
  const Image<float>& means = sigma_.averages();
  SigmaMap map = {.median = sum_.quantile(0.5),
                  .p95 = sum_.quantile(0.95),
                  .solved = expected().solved,
                  .square_px = sigma_.square(),
                  .columns = means.width(),
                  .rows = means.height()};
  for (int y = 0; y < means.height(); ++y) {
    for (int x = 0; x < means.width(); ++x) map.grid.push_back(number(means(x, y)));
  }
  return map;
}

LightCondition condition_over(const LightField& field, Size size) {
  constexpr int kPoints = 9;  // a side
  std::vector<double> conditions;
  for (int j = 0; j < kPoints; ++j) {
    for (int i = 0; i < kPoints; ++i) {
      std::vector<Vec3> directions;
      for (std::size_t k = 0; k < field.count(); ++k) {
        const LightField::Light light =
            field.at(k, 1, (size.width - 1) * i / (kPoints - 1), (size.height - 1) * j / (kPoints - 1));
        if (light.strength > 0) directions.push_back(light.direction);
      }
      conditions.push_back(condition_number(directions));
    }
  }
  const double worst = *std::ranges::max_element(conditions);
  return {median(std::move(conditions)), worst};
}

PhotographsSummary summarize_photographs(const Photographs& photographs, const std::vector<int>& picked,
                                         const std::vector<std::string>& warnings,
                                         const JobContext& context) {
  PhotographsSummary summary;
  const solver::Evidence evidence = read_evidence(photographs);
  summary.diagnosis = solver::diagnose(evidence, context.threads);
  summary.outshining = solver::outshining_share(evidence);
  summary.of_session = !photographs.leds.empty();
  summary.numbers = summary.of_session ? photographs.leds : picked;
  for (std::size_t k = summary.numbers.size(); k < photographs.count(); ++k) {
    summary.numbers.push_back(static_cast<int>(k) + 1);
  }
  summary.noise_is_known = photographs.noise().has_value();
  summary.condition = condition_over(*photographs.field, photographs.size);
  summary.warnings = warnings;
  return summary;
}

namespace {

// Verdicts on shifts that were measured: one or none.
std::vector<Verdict> moved_verdicts(const PhotographsSummary& photographs) {
  const Speaker say = {photographs};
  const std::string remedy =
      fmt::format("see that nothing touches cloth, table and camera while they are {0}, and {1} again",
                  photographs.of_session ? "scanned" : "photographed",
                  photographs.of_session ? "scan" : "photograph them");
  if (const auto& far = photographs.far_shifts; far && !far->moved.empty()) {
    const bool can_do_without = photographs.numbers.size() - far->moved.size() >= kLeastOfMoved;
    return {
        {"CLOTH_MOVED",
         fmt::format("The cloth moved: under {} it lies up to {:.0f} pixels from where the others show it, "
                     "which explains {} percent of what readings miss",
                     say.name(far->moved), far->most_px, percent_words(far->explained)),
         remedy + (can_do_without ? say.or_without(far->moved) : "")}};
  }
  const SessionShifts& shifts = photographs.shifts;
  double cost_deg = 0;
  std::vector<std::size_t> lights;
  for (const std::size_t k : shifts.with(ShiftVerdict::kFlagged)) {
    if (!shifts.found || shifts.shots[k].measured.cost_deg <= kLeastWarnedShift_deg) continue;
    cost_deg = std::max(cost_deg, shifts.shots[k].measured.cost_deg);
    lights.push_back(k);
  }
  if (lights.empty()) return {};
  return {
      {"CLOTH_MOVED",
       fmt::format("The cloth moved in so many shots that none can be left out: a shift under {} turns the "
                   "normals by up to {:.2f}°",
                   say.name(lights), cost_deg),
       remedy}};
}

// What named faults do not explain.
double misfit_of(const PhotographsSummary& photographs) {
  const solver::Diagnosis& diagnosis = photographs.diagnosis;
  return diagnosis.faults.empty() ? diagnosis.residual : diagnosis.left;
}

// The verdict on readings that fit no cloth, for a reason that nothing told.
Verdict unexplained(const PhotographsSummary& photographs, std::optional<solver::Level> level) {
  std::string looked_at = "exchanged, dead and dimmer lights";
  if (photographs.far_shifts && photographs.far_shifts->reach_px > 0)
    looked_at += fmt::format(", a cloth that moved by up to {:.0f} pixels", photographs.far_shifts->reach_px);
  if (level) looked_at += ", highlights";
  const double residual = photographs.diagnosis.residual;
  Verdict verdict = {
      "READINGS_DO_NOT_FIT",
      fmt::format("The readings do not fit: they deviate by {} percent from what was solved of "
                  "them, and nothing that was looked at explains it ({})",
                  residual > 1 ? "over 100" : percent_words(residual), looked_at),
      photographs.of_session
          ? "check that this calibration is the rig's, and look at the photographs"
          : "check how values follow light (--transfer), that none are clipped, that all were "
            "exposed alike, and their order and directions"};
  if (level && *level < solver::Level::kRobust)
    verdict.remedy += "; if the cloth shines, solve with --quality robust";
  return verdict;
}

}  // namespace

bool may_have_moved_far(const PhotographsSummary& photographs) {
  const bool is_explained = photographs.glossy_share > kMostlyGlossy;
  return !photographs.shifts.found && !is_explained && misfit_of(photographs) > kLeastMisfit;
}

std::vector<Verdict> verdicts_of(const PhotographsSummary& photographs, double specular,
                                 const std::optional<LeftOutFacts>& check,
                                 std::optional<solver::Level> level) {
  const Speaker say = {photographs};
  std::vector<Verdict> verdicts = photographs.doubts;
  const auto explains = [](const Verdict& doubt) { return doubt.name != "LIGHTS_MIRRORED"; };
  const bool is_explained = std::ranges::any_of(photographs.doubts, explains);  // so that readings miss
  for (const FaultKind kind : {FaultKind::kExchanged, FaultKind::kDead, FaultKind::kGain}) {
    for (const Fault& fault : photographs.diagnosis.faults) {
      const bool matters = fault.kind != FaultKind::kGain || fault.moved_deg >= kLeastWarned_deg;
      if (is_explained && kind != FaultKind::kDead) continue;
      if (fault.kind == kind && matters) verdicts.push_back(say(fault));
    }
  }
  const bool is_dominated =
      specular > kSpecularDominated && photographs.outshining >= solver::kLeastOutshining;
  if (!is_explained) std::ranges::move(moved_verdicts(photographs), std::back_inserter(verdicts));
  if (check && verdicts.empty()) {
    if (const std::optional<Verdict> unfit = verdict_of(*check, photographs.of_session, level))
      verdicts.push_back(*unfit);
  }
  const bool shines = is_dominated || photographs.glossy_share > kMostlyGlossy;
  if (verdicts.empty() && !shines && !photographs.shifts.found && misfit_of(photographs) > kMisfit)
    verdicts.push_back(unexplained(photographs, level));
  if (is_dominated) {
    const bool robust_ran = level && *level >= solver::Level::kRobust;
    verdicts.push_back({"SPECULAR_DOMINATED",
                        fmt::format("Highlights dominate: in {} percent of the pixels a reading is over "
                                    "three times what a matt cloth would give",
                                    percent_words(specular)),
                        fmt::format("put crossed polarisers on LEDs and lens and {} again",
                                    photographs.of_session ? "scan" : "photograph") +
                            (robust_ran ? "" : ", or solve with --quality robust")});
  }
  if (photographs.shadow_reach_is_capped) {
    verdicts.push_back({"SHADOWS_CAPPED",
                        "The relief is so high that shadows fall farther than they are looked for",
                        photographs.of_session
                            ? "lay the cloth flat and scan again, or solve with --quality robust and choose "
                              "that solve: weft library tag SESSION --set current_solve=ID"
                            : "lay the cloth flat and photograph again, or solve with --quality robust"});
  }
  verdicts.insert(verdicts.begin(), photographs.of_frames.begin(), photographs.of_frames.end());
  for (const std::string& warning : photographs.warnings) verdicts.push_back({"CONDITIONS", warning, ""});
  return verdicts;
}

SolveReportFacts report_facts(const std::string& title, const SolveFacts& solve,
                              const PhotographsSummary& photographs, const MapSummary& maps,
                              const Json& seconds) {
  const solver::Diagnosis& diagnosis = photographs.diagnosis;
  const Speaker say = {photographs};
  const SigmaFacts sigma = maps.sigma_facts();
  SolveReportFacts report = {.title = title,
                             .is_of_photographs = !photographs.of_session,
                             .id = solve.id,
                             .method = solve.method,
                             .size = solve.size,
                             .albedo_scale = solve.albedo_scale,
                             .pixels = solve.pixels,
                             .warnings = solve.warnings,
                             .looked_at = static_cast<std::int64_t>(diagnosis.pixels),
                             .outshining = photographs.outshining,
                             .residual = diagnosis.residual,
                             .residual_explained = diagnosis.left,
                             .budget = budget_of(photographs, sigma, solve),
                             .condition = photographs.condition,
                             .sigma_normal_deg = maps.sigma_map(),
                             .sigma_noise_deg = sigma.noise,
                             .sigma_model_deg = sigma.model,
                             .sigma_calibration_deg = sigma.calibration,
                             .check = solve.check,
                             .error = solve.error,
                             .gates = solve.gates,
                             .registration = solve.registration.value_or(std::vector<RegisteredShot>()),
                             .sharpening = solve.sharpening,
                             .lateral_color = solve.lateral_color,
                             .conditions = solve.conditions,
                             .seconds = seconds,
                             .foretold = solve.foretold};
  for (std::size_t i = 0; i < kStatusNames.size(); ++i)
    report.status.shares[i] = share_with(solve, kStatusNames[i].bit);
  for (std::size_t k = 0; k < diagnosis.lights.size(); ++k)
    report.lights.push_back(facts_of(diagnosis.lights[k], photographs.numbers[k]));
  for (const Fault& fault : diagnosis.faults) report.faults.push_back(facts_of(fault, say));
  if (report.conditions && object_of(*report.conditions).empty()) report.conditions.reset();
  return report;
}

Result<void> write_report(const fs::path& folder, const SolveReportFacts& report) {
  constexpr std::array<std::pair<const char*, const char*>, 6> kPreviews = {
      {{"albedo.png", "albedo"},
       {"normal.png", "normal"},
       {"relit.png", "relit from the upper left"},
       {"error.png", "error against the truth"},
       {"status_preview.png", "status"},
       {"reflectance.png", "lobe and yarns"}}};
  std::vector<report::Figure> pictures;
  for (const auto& [name, label] : kPreviews) {
    if (!is_there(folder / name)) continue;
    Result<std::string> png = read_text(folder / name);
    if (!png) return std::move(png).error();
    pictures.push_back({label, report::Png{std::move(*png)}});
  }
  if (Result<void> ok = write_json(folder / "report.json", json_of(report)); !ok) return ok;
  return write_file(folder / "report.html", report_page(report, pictures));
}

}  // namespace weft::solve
