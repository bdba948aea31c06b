// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/json_document.h"
#include "core/result.h"
#include "pipeline/bands.h"
#include "pipeline/photographs.h"
#include "report/downsampler.h"
#include "report/verdict.h"
#include "solver/diagnosis/diagnosis.h"

// The report of a solve: what went wrong, and where its error comes from. report.json (weft.solve-report/1,
// docs/formats.md) holds it, report.html shows it on one page that needs no other file.

namespace weft::app {

/// What the report says of the maps, gathered while they are solved.
class MapSummary {
 public:
  explicit MapSummary(Size size);
  void add(const MapBand& band);

  /// {"median", "p95", "square_px", "columns", "rows", "grid"} of the predicted angle in degrees; the grid's
  /// values are means of squares, row by row, null where there is none. "median" is null where no pixel has
  /// an angle.
  Json sigma_normal_deg() const;

 private:
  double quantile(double q) const;

  report::Downsampler sigma_;
  Image<float> row_;
  std::vector<std::int64_t> histogram_;  // of log sigma
};

/// Condition number of the lights over the frame: {"median", "worst"}.
Json condition_over(const LightField& field, Size size);

/// What speaks of the photographs while they are in memory.
struct PhotographsSummary {
  solver::Diagnosis diagnosis;
  std::vector<int> numbers;  ///< of the lights, as a person knows them
  bool of_session = true;    ///< lights are LEDs of a rig; else photographs in a list
  bool noise_is_known = false;
  Json condition;
  std::vector<std::string> warnings;
};
/// `picked` are the numbers of the lights where photographs were picked from a list; else empty.
PhotographsSummary summarize_photographs(const Photographs& photographs, const std::vector<int>& picked,
                                         const JobContext& context);

/// The scene is called dominated by highlights where this share of pixels has the bit SPECULAR.
inline constexpr double kSpecularDominated = 0.2;

/// Everything to be warned of, the gravest first. `specular` is the share of pixels with that bit.
std::vector<report::Verdict> verdicts_of(const PhotographsSummary& photographs, double specular);

/// report.json from solve.json (`solve`, where "gates", "conditions", "registration" and "error" may be
/// absent) and seconds by phase. Nothing but "seconds" differs from run to run.
Json report_document(const std::string& title, const Json& solve, const PhotographsSummary& photographs,
                     const MapSummary& maps, const Json& seconds);

/// Writes report.json and report.html into the folder of a solve, with the previews that are there.
Result<void> write_report(const std::filesystem::path& folder, const Json& report);

}  // namespace weft::app
