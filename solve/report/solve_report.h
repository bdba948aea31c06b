// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/solve/solve.h"
#include "core/solve/verdict.h"
#include "report/downsampler.h"
#include "solve/bands/bands.h"
#include "solve/levels/shifts.h"
#include "solve/photographs/photographs.h"
#include "solve/report/report_facts.h"
#include "solver/diagnosis/diagnosis.h"

// The report of a solve: what went wrong, and where its error comes from. report.json (weft.solve-report/1,
// docs/formats.md) holds it, report.html shows it on one page that needs no other file.

namespace weft::solve {

/// How many pixels have which angle, in bins of one percent from 1e-4 to 180 degrees.
class AngleHistogram {
 public:
  AngleHistogram();
  void add(double angle_deg);  ///< what is not finite is left out
  /// To one percent; NaN where nothing was added.
  double quantile(double share) const;
  double mean() const;  ///< 0 where nothing was added

 private:
  std::vector<std::int64_t> counts_;
  double sum_deg_ = 0;
};

/// The mean error of the normals that sigma.exr lets one expect, and of its parts, whose squares add up pixel
/// by pixel. Degrees. They hold for the share of the cloth that has a normal; a radian where of none of them
/// anything is known.
struct ExpectedError {
  double total_deg = 0, noise_deg = 0, model_deg = 0, calibration_deg = 0;
  double solved = 0;  ///< 0 to 1; what no photograph shows, outside a mask, is no cloth

  double of_whole_deg() const { return deg_of_whole(total_deg, solved); }
};

/// What the report says of the maps, gathered while they are solved.
class MapSummary {
 public:
  explicit MapSummary(Size size);
  /// `normal_deg` and `calibration_deg` are the channels normal_deg and normal_deg.calibration of sigma.exr
  /// over band.albedo_rows, the second empty where the calibration has no covariance. The band has its
  /// model's part.
  void add(const MapBand& band, View<const float> normal_deg, View<const float> calibration_deg = {});

  /// The angle over the share of the cloth that is solved.
  SigmaMap sigma_map() const;
  /// The angle and its parts: of noise, of the model, and of the calibration's covariance.
  SigmaFacts sigma_facts() const;
  ExpectedError expected() const;

 private:
  report::Downsampler sigma_;
  Image<float> row_;  // of the band, NaN where the angle is not known
  AngleHistogram sum_, noise_, model_, calibration_;
  std::int64_t cloth_ = 0, solved_ = 0;  // pixels
};

LightCondition condition_over(const LightField& field, Size size);

/// What the report says of the photographs, gathered while they are in memory.
struct PhotographsSummary {
  solver::Diagnosis diagnosis;  ///< lights by their index in the photographs
  std::vector<int> numbers;     ///< the number of each light, as a person knows it
  bool of_session = true;       ///< lights are LEDs of a rig; else photographs in a list
  bool noise_is_known = false;  ///< the camera's noise was calibrated
  LightCondition condition;
  double glossy_share = 0;               ///< of the blocks, solved with a lobe that was measured
  double outshining = 0;                 ///< share of pixels, solver/diagnosis/highlights.h
  std::vector<std::string> warnings;     ///< a sentence each, said when the photographs were read
  std::vector<Verdict> of_frames;        ///< frames and dark shots that lie
  std::vector<Verdict> doubts;           ///< whether lights and values are what they are taken for
  SessionShifts shifts;                  ///< of the photographs as they were read
  std::optional<MovedShots> far_shifts;  ///< where they were looked for
  bool shadow_reach_is_capped = false;
  /// What a session adds: its folder's name, the shot of each LED, and the shots that a person left out.
  std::string session;
  std::map<int, int> shot_of_led;
  std::vector<int> left_out;
};
/// `picked` are the numbers of the lights where photographs were picked from a list; else empty. `warnings`
/// are what was said when they were read.
PhotographsSummary summarize_photographs(const Photographs& photographs, const std::vector<int>& picked,
                                         const std::vector<std::string>& warnings, const JobContext& context);

/// The scene is called dominated by highlights where this share of pixels has the bit SPECULAR, if highlights
/// outshine the cloth (solver/diagnosis/highlights.h).
inline constexpr double kSpecularDominated = 0.2;

/// Readings are said not to fit where shots cannot be registered and they deviate by more than this from
/// their fit, over the albedo: cloth that shows nothing to register by fits well.
inline constexpr double kMisfit = 0.05;
/// Nor where more than this share of the cloth is solved with its lobe, or highlights dominate: what deviates
/// is then gloss.
inline constexpr double kMostlyGlossy = 0.5;
/// From here on shifts are looked for that are too large to be registered: of one shot of ten that moved the
/// median hardly tells.
inline constexpr double kLeastMisfit = 0.01;
/// Whether they are. What named faults explain does not count, nor what a lobe does.
bool may_have_moved_far(const PhotographsSummary& photographs);
/// What is left alone and costs more is warned of.
inline constexpr double kLeastWarnedShift_deg = 0.2;

/// Everything to be warned of, the gravest first: LEDS_EXCHANGED, LED_DEAD, LED_GAIN, CLOTH_MOVED,
/// LIGHTS_DO_NOT_FIT or READINGS_DO_NOT_FIT, SPECULAR_DOMINATED, SHADOWS_CAPPED, CONDITIONS. `specular` is
/// the share of pixels with that bit. `level` is the one that ran, if it was a level: no remedy names it or
/// one below.
std::vector<Verdict> verdicts_of(const PhotographsSummary& photographs, double specular,
                                 const std::optional<LeftOutFacts>& check,
                                 std::optional<solver::Level> level);

/// report.json from solve.json and seconds by phase. Nothing but "seconds" differs from run to run.
SolveReportFacts report_facts(const std::string& title, const SolveFacts& solve,
                              const PhotographsSummary& photographs, const MapSummary& maps,
                              const Json& seconds);

/// Writes report.json and report.html into the folder of a solve, with the previews that are there.
Result<void> write_report(const std::filesystem::path& folder, const SolveReportFacts& report);

}  // namespace weft::solve
