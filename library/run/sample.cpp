// SPDX-License-Identifier: Apache-2.0
#include "library/run/sample.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/temporary_folder.h"
#include "core/base/vec.h"
#include "core/image_io/image_io.h"
#include "library/run/lean.h"
#include "library/run/solve_change.h"
#include "solve/run/explain.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

// Mean angle between what a level made of the middle of the frame and the solve before; none where that is of
// another size.
std::optional<double> turn_in_the_middle(const fs::path& cut_file, const fs::path& before_file, Size frame) {
  const std::vector<std::string> channels = {"X", "Y", "Z"};
  const Result<LoadedImage> cut = read_image(cut_file);
  if (!cut || cut->planes.planes() < 3) return {};
  const Result<MapRows> before = MapRows::open(before_file, channels);
  const Size size = cut->info.size;
  if (!before || before->size() != frame || size.width > frame.width || size.height > frame.height) return {};
  // As solve/run/explain.h takes it: on whole cells of the colour filter.
  const int x0 = (frame.width - size.width) / 2 / 2 * 2, y0 = (frame.height - size.height) / 2 / 2 * 2;
  const Result<Image<float>> part = before->read({x0, y0, x0 + size.width, y0 + size.height});
  if (!part) return {};
  double sum = 0;
  std::int64_t count = 0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto normal = [&](const Image<float>& map) {
        return Vec3{map(x, y, 0), map(x, y, 1), map(x, y, 2)};
      };
      const double angle = angle_deg(normal(cut->planes), normal(*part));
      if (!std::isfinite(angle)) continue;
      sum += angle;
      ++count;
    }
  }
  return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
}

}  // namespace

Result<std::vector<Forecast>> measure_session(const Candidate& candidate, const SampleOptions& options,
                                              const JobContext& context) {
  const TemporaryFolder crops;
  solve::SolveOptions solve;
  solve.compression = compression_of(options.product);
  const solve::PriceOptions wanted = {.only = options.only, .crops = crops.path(), .shared = &options.shared};
  const Result<solve::Ladder> ladder = solve::explain_session(candidate.input, solve, wanted, context);
  if (!ladder) return ladder.error();
  const fs::path before = candidate.input.folder / "solve" / candidate.before;
  double compare_s = 0;
  if (!candidate.before.empty()) {
    Stopwatch watch;
    if (compare_solves(before, before, context.threads)) compare_s = watch.lap();
  }
  std::vector<Forecast> levels;
  for (const solve::LevelPrice& price : ladder->levels) {
    Forecast level;
    level.seconds = price.seconds.total();
    level.degrees = price.error.total_deg;
    level.solved = price.error.solved;
    level.solve_seconds = solve::price_of(price).seconds;
    const bool is_half = price.level == solver::Level::kPreview;
    if (!candidate.before.empty() && !is_half) {
      level.seconds += compare_s;
      level.turn_deg = turn_in_the_middle(crops.path() / (price.name() + "_normal.exr"),
                                          before / "normal.exr", candidate.size);
    }
    levels.push_back(level);
  }
  return levels;
}

}  // namespace weft::library
