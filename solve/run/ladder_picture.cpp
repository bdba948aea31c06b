// SPDX-License-Identifier: Apache-2.0
#include "solve/run/ladder_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/files.h"
#include "core/base/vec.h"
#include "core/image_io/image_io.h"
#include "report/preview.h"
#include "solve/files/pictures.h"
#include "solver/method.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

constexpr int kSide = 128, kEnlarged = 2;

Rect shown_area(Size size) {
  const int width = std::min(size.width, kSide), height = std::min(size.height, kSide);
  const int x0 = (size.width - width) / 2 / 2 * 2, y0 = (size.height - height) / 2 / 2 * 2;
  return {x0, y0, x0 + width, y0 + height};
}

// Normals of `area` of a frame from the map of a solve of it, which a preview has at half its size.
Result<Image<float>> crop_of(const fs::path& normal, Size frame, Rect area) {
  const Result<LoadedImage> map = read_image(normal);
  if (!map) return map.error();
  const Size size = map->info.size;
  const int shrunk = size == frame ? 1 : 2;
  if (map->planes.planes() < 3 || size != Size{frame.width / shrunk, frame.height / shrunk}) {
    return Error{ErrorKind::kBadData, "normal map does not fit the session", normal.string(),
                 fmt::format("{} x {} pixels for a frame of {} x {}", size.width, size.height, frame.width,
                             frame.height),
                 "remove this solve"};
  }
  Image<float> crop({area.width(), area.height()}, 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < crop.height(); ++y) {
      for (int x = 0; x < crop.width(); ++x) {
        crop(x, y, c) = map->planes(std::min((area.x0 + x) / shrunk, size.width - 1),
                                    std::min((area.y0 + y) / shrunk, size.height - 1), c);
      }
    }
  }
  return crop;
}

double mean_angle_deg(const Image<float>& a, const Image<float>& b) {
  double sum = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x)
      sum += angle_deg({a(x, y, 0), a(x, y, 1), a(x, y, 2)}, {b(x, y, 0), b(x, y, 1), b(x, y, 2)});
  }
  return sum / static_cast<double>(a.size().pixels());
}

report::Picture enlarged(const report::Picture& picture) {
  report::Picture large({picture.width() * kEnlarged, picture.height() * kEnlarged}, 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < large.height(); ++y) {
      for (int x = 0; x < large.width(); ++x) large(x, y, c) = picture(x / kEnlarged, y / kEnlarged, c);
    }
  }
  return large;
}

}  // namespace

Result<std::vector<LadderStep>> draw_ladder(const SessionOptions& input, const SolveOptions& options,
                                            const fs::path& file, const JobContext& context,
                                            std::span<const LevelPrice> prices) {
  const Result<SolvePlan> plan = plan_session(input);
  if (!plan) return plan.error();
  const Rect area = shown_area(plan->size);
  std::optional<Image<float>> truth;
  if (!plan->truth.empty()) {
    Result<Image<float>> crop = crop_of(plan->truth, plan->size, area);
    if (!crop) return std::move(crop).error();
    truth = std::move(*crop);
  }

  std::vector<LadderStep> steps;
  std::vector<report::Panel> panels;
  for (const solver::MethodName& level : solver::method_names()) {
    if (!level.level) continue;
    SolveOptions solve = options;
    solve.method = level.name;
    solve.output.clear();
    const auto price = std::ranges::find(prices, *level.level, &LevelPrice::level);
    if (price != prices.end()) solve.foretold = price_of(*price);
    const Result<SolveReport> solved = solve_session(input, solve, context);
    if (!solved) return solved.error();
    const Result<Image<float>> crop = crop_of(solved->folder / "normal.exr", plan->size, area);
    if (!crop) return crop.error();
    LadderStep step = {level.name, solved->folder, {}};
    if (solved->facts.error) step.whole_deg = solved->facts.error->mean_deg;
    step.foretold = solved->facts.foretold;
    step.taken = solved->facts.taken;
    if (truth) step.error_deg = mean_angle_deg(*crop, *truth);
    panels.push_back({level.name, step.error_deg ? fmt::format("mean {:.3f}°", *step.error_deg) : "",
                      enlarged(report::normal_picture(*crop))});
    steps.push_back(std::move(step));
  }
  if (truth) panels.push_back({"truth", "", enlarged(report::normal_picture(*truth))});
  const report::Picture sheet =
      report::contact_sheet(plan->session.fabric, panels, static_cast<int>(panels.size()));
  if (Result<void> written = write_png(file, sheet); !written) return std::move(written).error();
  return steps;
}

}  // namespace weft::solve
