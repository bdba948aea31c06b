// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/jobs/photo_input.h"
#include "app/jobs/session_input.h"
#include "app/jobs/solve.h"
#include "core/job.h"
#include "core/json_document.h"
#include "core/result.h"
#include "pipeline/forecast.h"

// What each level of the solver would give and cost, measured on this cloth and this machine before it is
// paid.

namespace weft::app {

/// Wall seconds of one level on the whole frame.
struct LevelSeconds {
  double read = 0;     ///< measured: the photographs were read
  double prepare = 0;  ///< measured: shots registered to each other; a preview does without
  double solve = 0;    ///< of the cut below, by its pixels to those of the frame
  double write = 0;    ///< likewise, its maps written to the system's temporary folder, and opening them

  /// Their sum, though maps are written while the next are solved. Pictures, report and sync, which do not
  /// grow with the level, come on top.
  double total() const { return read + prepare + solve + write; }
};

/// What one level would give, and what it would cost.
struct LevelPrice {
  pipeline::ErrorForecast error;
  LevelSeconds seconds;
  std::string note;  ///< what there is to say of it: nothing to gain, gates; or empty

  std::string name() const { return solver::method_of(error.level).name; }
};

/// All levels, priced.
struct Ladder {
  solver::Gates gates;
  std::vector<LevelPrice> levels;  ///< in the order of solver::Level
};

/// A dearer level that is not this share better than a cheaper one has nothing to gain.
inline constexpr double kWorthwhileGain = 0.05;

/// Reads the photographs, forecasts errors (pipeline/forecast.h) and times every level on a cut of up to
/// 512 x 256 pixels from the middle of the frame, on the threads of `context`: the lesser of two runs, or one
/// where it takes long. The reference level runs on the cut as it would on the frame, if its gates are open
/// with as many rounds as the cut needs; that the height's transform grows by a logarithm faster than the
/// frame is left out. Nothing is written beside the photographs.
Result<Ladder> explain_session(const SessionOptions& input, const SolveOptions& options,
                               const JobContext& context);
Result<Ladder> explain_photos(const PhotoOptions& input, const SolveOptions& options,
                              const JobContext& context);

/// What somebody asks of a level; at least one of them.
struct LevelWish {
  std::optional<double> within_seconds = {};
  std::optional<double> to_deg = {};

  bool is_one() const { return within_seconds || to_deg; }
};

/// Index of the cheapest level that is as close as `to_deg` and as quick as `within_seconds`; where only time
/// is limited, the best that fits, and the cheaper of those that are equally good. kUsage with what is
/// possible where nothing fits.
Result<std::size_t> choose_level(const Ladder& ladder, const LevelWish& wish);

/// {"levels": [{"quality", "predicted_deg", "parts_deg", "seconds", "note"}], "gates", "chosen": name or
/// null}.
Json json_of(const Ladder& ladder, std::optional<std::size_t> chosen);

}  // namespace weft::app
