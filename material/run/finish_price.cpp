// SPDX-License-Identifier: Apache-2.0
#include "material/run/finish_price.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "core/base/temporary_folder.h"
#include "core/base/vec.h"
#include "material/run/surface_files.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

constexpr std::array<int, 2> kTriedFactors = {4, 2};
constexpr int kComparedSide = 512;  // pixels of the finest grid that are held against coarser ones

// What was done on one grid.
struct TriedGrid {
  Size size;
  std::vector<StepPrice> steps;
};

// The seconds between what a job tells of its steps.
class StepTimes {
 public:
  JobContext context(const JobContext& of) {
    JobContext timed = of;
    timed.progress = [this](std::string_view phase, double) {
      if (phase == "finish") laps_.push_back(watch_.lap());
    };
    return timed;
  }

  // Before the first step, of each step, and after the last.
  std::vector<double> take() {
    laps_.push_back(watch_.lap());
    return std::move(laps_);
  }

 private:
  Stopwatch watch_;
  std::vector<double> laps_;
};

Result<TriedGrid> tried_on(const MapsOptions& asked, double mm_per_pixel, const fs::path& folder,
                           const JobContext& context) {
  MapsOptions options = asked;
  options.mm_per_pixel = mm_per_pixel;
  options.output = folder;
  Stopwatch watch;
  const Result<RectifyReport> rectified = rectified_maps(options, context);
  if (!rectified) return rectified.error();
  TriedGrid tried = {rectified->facts.size, {{"rectify", watch.lap()}}};
  StepTimes times;
  const Result<MapsReport> made = make_maps(options, times.context(context));
  if (!made) return made.error();
  if (!rectified->was_there) {
    std::error_code ignored;
    fs::remove_all(rectified->folder, ignored);
  }
  const std::vector<double> laps = times.take();
  for (std::size_t i = 0; i < asked.recipe.steps.size(); ++i)
    tried.steps.push_back({asked.recipe.steps[i].name, laps[i + 1]});
  tried.steps.push_back({"write", laps.front() + laps.back()});
  return tried;
}

// By two sizes, never less than the larger of them took; where they are one, in proportion to its pixels.
double grown(double few_s, double few, double more_s, double more, double pixels) {
  const double a_pixel = more > few ? std::max(0.0, (more_s - few_s) / (more - few)) : more_s / more;
  return more_s + a_pixel * (pixels - more);
}

double pixels_of(const TriedGrid& grid) {
  return static_cast<double>(grid.size.pixels());
}

// The rms angle of the middle's normals to the normal of the mean slope of their square.
double lost_by(const Surface& surface, int factor) {
  const Size size = surface.size();
  const int width = std::min(size.width, kComparedSide) / factor * factor;
  const int height = std::min(size.height, kComparedSide) / factor * factor;
  const int x0 = (size.width - width) / 2, y0 = (size.height - height) / 2;
  const auto slope = [&](int x, int y, int plane) { return static_cast<double>(surface.slope(x, y, plane)); };
  const auto normal = [](double x, double y) { return normalized({-x, -y, 1}); };
  double sum = 0;
  for (int y = y0; y < y0 + height; y += factor) {
    for (int x = x0; x < x0 + width; x += factor) {
      double mean_x = 0, mean_y = 0;
      for (int k = 0; k < factor * factor; ++k) {
        mean_x += slope(x + k % factor, y + k / factor, 0) / (factor * factor);
        mean_y += slope(x + k % factor, y + k / factor, 1) / (factor * factor);
      }
      for (int k = 0; k < factor * factor; ++k) {
        const int at_x = x + k % factor, at_y = y + k / factor;
        const double angle =
            angle_deg(normal(mean_x, mean_y), normal(slope(at_x, at_y, 0), slope(at_x, at_y, 1)));
        sum += angle * angle;
      }
    }
  }
  return std::sqrt(sum / std::max(1, width * height));
}

GridPrice price_of(const TriedGrid& grid, double mm_per_pixel, double lost_deg) {
  GridPrice price = {.mm_per_pixel = mm_per_pixel, .size = grid.size, .steps = grid.steps};
  for (const StepPrice& step : grid.steps) price.seconds += step.seconds;
  price.lost_deg = lost_deg;
  return price;
}

// The finest grid as the two others, or the one of both, foretell it, `rectified_s` being known.
TriedGrid foretold(const TriedGrid& few, const TriedGrid& more, Size size, double rectified_s) {
  TriedGrid finest = {size, more.steps};
  const auto pixels = static_cast<double>(size.pixels());
  for (std::size_t i = 0; i < finest.steps.size(); ++i)
    finest.steps[i].seconds =
        grown(few.steps[i].seconds, pixels_of(few), more.steps[i].seconds, pixels_of(more), pixels);
  finest.steps.front().seconds = rectified_s;
  return finest;
}

Result<void> choose(std::vector<GridPrice>& rows, const GridWish& wish) {
  const auto fits = [&](const GridPrice& row) { return !wish.within_s || row.seconds <= *wish.within_s; };
  if (wish.to_deg) {
    std::ranges::find_if(rows, [&](const GridPrice& row) {
      return row.lost_deg <= *wish.to_deg;
    })->is_chosen = true;
    return {};
  }
  const auto finest = std::find_if(rows.rbegin(), rows.rend(), fits);
  if (finest != rows.rend()) {
    finest->is_chosen = true;
    return {};
  }
  return Error{ErrorKind::kUsage, "no grid is that quick", fmt::format("--within {:g} s", *wish.within_s),
               fmt::format("the coarsest, of {:.4g} mm a pixel, takes {:.3g} s", rows.front().mm_per_pixel,
                           rows.front().seconds),
               "ask for what weft finish --explain lists"};
}

}  // namespace

Result<FinishPrices> price_finish(const MapsOptions& options, const GridWish& wish,
                                  const JobContext& context) {
  Stopwatch watch;
  const Result<RectifyReport> finest = rectified_maps(options, context);
  if (!finest) return finest.error();
  const double rectified_s = watch.lap(), mm = finest->facts.mm_per_pixel;
  const Result<RectifiedSurface> surface = read_surface(finest->folder, mm);
  if (!surface) return surface.error();
  const TemporaryFolder aside;
  FinishPrices prices;
  std::vector<TriedGrid> tried;
  for (const int factor : kTriedFactors) {
    Result<TriedGrid> grid = tried_on(options, factor * mm, aside.path() / std::to_string(factor), context);
    const bool is_too_coarse =
        !grid && (grid.error().kind == ErrorKind::kBadData || grid.error().kind == ErrorKind::kUsage);
    if (is_too_coarse) continue;
    if (!grid) return std::move(grid).error();
    prices.rows.push_back(price_of(*grid, factor * mm, lost_by(surface->surface, factor)));
    tried.push_back(std::move(*grid));
  }
  Result<TriedGrid> full = tried.empty()
                               ? tried_on(options, mm, aside.path() / "1", context)
                               : foretold(tried.front(), tried.back(), finest->facts.size, rectified_s);
  if (!full) return std::move(full).error();
  prices.rows.push_back(price_of(*full, mm, 0));
  if (Result<void> ok = choose(prices.rows, wish); !ok) return std::move(ok).error();
  return prices;
}

void describe(Fields& fields, StepPrice& price) {
  fields.value({"step", "rectify, a step of the recipe, or write: maps, pictures, checks"}, price.name);
  fields.value({"seconds", "It takes"}, price.seconds);
}

void describe(Fields& fields, GridPrice& price) {
  fields.value({"mm_per_pixel", "Of the grid"}, price.mm_per_pixel);
  fields.value({"width", "Pixels"}, price.size.width);
  fields.value({"height", "Pixels"}, price.size.height);
  fields.value({"seconds", "Of all steps"}, price.seconds);
  fields.list({"steps", "In their order"}, price.steps);
  fields.value({"lost_deg", "Rms angle of the finest grid's normals to those of this one, degrees"},
               price.lost_deg);
  fields.value({"chosen", "The one to buy"}, price.is_chosen);
}

void describe(Fields& fields, FinishPrices& prices) {
  fields.list({"rows", "The coarsest first"}, prices.rows);
}

}  // namespace weft::material
