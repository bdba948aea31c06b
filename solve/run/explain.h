// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "solve/input/photo_input.h"
#include "solve/input/session_input.h"
#include "solve/run/solve_session.h"
#include "solver/method.h"

// What each level of the solver would give and cost, measured on this cloth and this machine before it is
// paid.

namespace weft::solve {

/// Wall seconds of one level on the whole frame, by the phases of a solve. What is not measured on the frame
/// itself is told by solving cuts of it.
struct LevelSeconds {
  double read = 0;      ///< measured: the photographs were read
  double prepare = 0;   ///< measured: shots registered to each other; of a preview the cut's, by pixels
  double solve = 0;     ///< of the cut below, each part by what it grows with (solve/levels/work.h)
  double fixed = 0;     ///< of `solve`, what no frame makes longer: beginning, and looking for a lobe
  double write = 0;     ///< by two cuts, 1024 x 1024 and 512 x 256: so much for each pixel more than in them
  double pictures = 0;  ///< likewise, up to the size that previews have
  double report = 0;    ///< of the cut, as it is: it looks at samples
  double sync = 0;      ///< by two cuts, in the system's temporary folder

  double total() const { return read + prepare + solve + write + pictures + report + sync; }
};

/// Seconds that grow with the pixels of the maps.
struct Growing {
  double at_cut = 0, a_pixel = 0;
  double pixels_of_cut = 0;

  double at(double pixels) const { return std::max(0.0, at_cut + a_pixel * (pixels - pixels_of_cut)); }
};

/// What files and pictures take is the same at all levels, and mostly not of the pixels: two cuts solved by
/// the level fast tell. So do they of what any solve takes to begin.
struct SharedSeconds {
  Growing solve, write, pictures, sync;
};

/// What is priced, and what is kept of it.
struct PriceOptions {
  std::optional<solver::Level> only = {};  ///< this level alone; none: all
  /// Folder for what each level made of the cut, LEVEL_relit.png, LEVEL_normal.png and LEVEL_normal.exr;
  /// empty: nowhere.
  std::filesystem::path crops = {};
  /// Filled where it is empty: who prices many sessions measures it once.
  std::optional<SharedSeconds>* shared = nullptr;
};

/// What one level would give, and what it would cost. The error, and the share of the cloth that it holds
/// for, are those of the cut.
struct LevelPrice {
  solver::Level level = solver::Level::kStandard;
  ExpectedError error;
  LevelSeconds seconds;
  std::string note;  ///< what there is to say of it: nothing to gain, gates, the cloth's lobe; or empty

  std::string name() const { return solver::method_of(level).name; }
  bool is_solved() const { return error.solved >= kLeastSolved; }
};

/// As the solve of that level keeps it (SolveOptions::foretold).
SolvePrice price_of(const LevelPrice& level);

/// Levels, priced.
struct Ladder {
  Json gates;                      ///< of the reference level, as solve.json has them; null without it
  std::vector<LevelPrice> levels;  ///< in the order of solver::Level
  bool of_session = true;          ///< else of a folder's photographs, which no meter took
};

/// A dearer level that is not this share better than a cheaper one has nothing to gain.
inline constexpr double kWorthwhileGain = 0.05;

/// Reads the photographs and solves a cut of up to 512 x 256 pixels from the middle of the frame at each
/// level that is wanted as `weft solve` does, on the threads of `context`: the quicker of two runs, or one
/// where it takes long. The error to expect is what sigma.exr says of the cut. That the height's transform of
/// the reference level grows by a logarithm faster than the frame is left out, and so is holding a simulated
/// session against its truth. Nothing is written beside the photographs.
Result<Ladder> explain_session(const SessionOptions& input, const SolveOptions& options,
                               const PriceOptions& wanted, const JobContext& context);
Result<Ladder> explain_photos(const PhotoOptions& input, const SolveOptions& options,
                              const PriceOptions& wanted, const JobContext& context);

/// What somebody asks of a level; at least one of them.
struct LevelWish {
  std::optional<double> within_seconds = {};
  std::optional<double> to_deg = {};

  bool is_one() const { return within_seconds || to_deg; }
};

/// Index of the cheapest level that is as close as `to_deg` and as quick as `within_seconds`; where only time
/// is limited, the best that fits, and the cheaper of those that are equally good. How close a level is
/// counts over the whole cloth, what has no normal as deg_of_whole() has it. kBadData where no level solves
/// half of the cloth; kUsage with what is possible where nothing fits.
Result<std::size_t> choose_level(const Ladder& ladder, const LevelWish& wish);

/// {"levels": [{"quality", "predicted_deg", "solved", "parts_deg", "seconds", "note"}], "gates",
/// "recommended", "chosen": name or null}. Recommended is what choose_level() takes where nothing is wished.
Json json_of(const Ladder& ladder, std::optional<std::size_t> chosen);

}  // namespace weft::solve
