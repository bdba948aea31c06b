// SPDX-License-Identifier: Apache-2.0
#include "material/run/maps_price.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/solve/solve_record.h"
#include "material/finish/crop.h"
#include "material/maps/occlusion.h"
#include "material/run/surface_files.h"

namespace weft::material {
namespace {

using solver::HeightMethod;

constexpr int kPiece = 512;
constexpr int kBestDirections = 64;
constexpr std::array<int, 3> kDirections = {4, 8, 16};

struct HeightSetting {
  HeightMethod method;
  const char* name;
};
constexpr std::array<HeightSetting, 3> kHeights = {{{HeightMethod::kAutomatic, "tiled"},
                                                    {HeightMethod::kMultigrid, "multigrid"},
                                                    {HeightMethod::kSeed, "seed"}}};

// The middle of a surface, or all of a small one.
Result<Surface> piece_of(const Surface& surface) {
  const Size size = surface.size();
  const int width = std::min(size.width, kPiece), height = std::min(size.height, kPiece);
  const double mm = surface.mm_per_pixel;
  Result<Cropped> cropped = crop(
      surface, {mm * ((size.width - width) / 2), mm * ((size.height - height) / 2), mm * width, mm * height});
  if (!cropped) return std::move(cropped).error();
  return std::move(cropped->surface);
}

bool is_whole(const Surface& surface) {
  for (int y = 0; y < surface.status.height(); ++y) {
    for (int x = 0; x < surface.status.width(); ++x) {
      if ((surface.status(x, y) & kNoSolution) != 0) return false;
    }
  }
  return true;
}

double rms_between(const Image<float>& a, const Image<float>& b) {
  double sum = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      const double off = static_cast<double>(a(x, y)) - static_cast<double>(b(x, y));
      sum += off * off;
    }
  }
  return std::sqrt(sum / static_cast<double>(a.size().pixels()));
}

// A map of the piece, and how long it took.
struct Tried {
  Image<float> map;
  double seconds = 0;
};

Result<Tried> height_by(HeightMethod method, const Surface& piece, const JobContext& context) {
  DeriveOptions options;
  options.height = method;
  MapWork work = {.surface = piece, .folder = {}, .options = options, .context = context};
  Stopwatch watch;
  if (Result<void> ok = find_height(work); !ok) return std::move(ok).error();
  return Tried{std::move(work.height_mm), watch.lap()};
}

Result<Tried> openness_by(int directions, View<const float> height_mm, double mm_per_pixel,
                          const JobContext& context) {
  Stopwatch watch;
  Result<Occlusion> found = material::occlusion(
      height_mm, {.mm_per_pixel = mm_per_pixel, .directions = directions, .threads = context.threads});
  if (!found) return std::move(found).error();
  return Tried{std::move(found->openness), watch.lap()};
}

// The quickest that is good enough, else the best that is in time, else the quickest.
std::size_t chosen_of(const std::vector<MapPrice>& prices, const PriceAims& aims) {
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < prices.size(); ++i) {
    if (aims.to && prices[i].error <= *aims.to) return i;
    const bool is_in_time = !aims.within_s || prices[i].seconds <= *aims.within_s;
    const bool is_default = !aims.to && !aims.within_s && prices[i].is_default;
    if (is_default) return i;
    if ((aims.to || aims.within_s) && is_in_time) chosen = i;
  }
  return chosen;
}

}  // namespace

Result<MapPrices> price_maps(const MapsOptions& options, const PriceAims& aims, const JobContext& context) {
  const Result<RectifyReport> rectified = rectified_maps(options, context);
  if (!rectified) return rectified.error();
  const Result<RectifiedSurface> read = read_surface(rectified->folder, rectified->facts.mm_per_pixel);
  if (!read) return read.error();
  const Surface& surface = read->surface;
  const Result<Surface> piece = piece_of(surface);
  if (!piece) return piece.error();
  const double times =
      static_cast<double>(surface.size().pixels()) / static_cast<double>(piece->size().pixels());

  // Both are exact; the cosine transform takes whole frames alone.
  const HeightMethod exact = is_whole(*piece) ? HeightMethod::kDct : HeightMethod::kMultigrid;
  const Result<Tried> direct = height_by(exact, *piece, context);
  if (!direct) return direct.error();
  std::vector<MapPrice> prices = {
      {"height", exact == HeightMethod::kDct ? "direct" : "multigrid", times * direct->seconds, 0, "mm"}};
  for (const HeightSetting& setting : kHeights) {
    if (setting.method == exact) continue;
    const Result<Tried> tried = height_by(setting.method, *piece, context);
    if (!tried) return tried.error();
    prices.push_back({"height", setting.name, times * tried->seconds, rms_between(tried->map, direct->map),
                      "mm", setting.method == HeightMethod::kAutomatic});
  }
  const View<const float> height_mm = direct->map.plane();
  const Result<Tried> best = openness_by(kBestDirections, height_mm, piece->mm_per_pixel, context);
  if (!best) return best.error();
  std::vector<MapPrice> occlusion;
  for (const int directions : kDirections) {
    const Result<Tried> tried = openness_by(directions, height_mm, piece->mm_per_pixel, context);
    if (!tried) return tried.error();
    occlusion.push_back({"occlusion", fmt::format("{} directions", directions), times * tried->seconds,
                         rms_between(tried->map, best->map), "share",
                         directions == DeriveOptions().directions});
  }
  const std::size_t chosen = chosen_of(occlusion, aims);
  occlusion[chosen].is_chosen = true;
  prices.insert(prices.end(), occlusion.begin(), occlusion.end());
  return MapPrices{std::move(prices), kDirections[chosen]};
}

Json json_of(const MapPrices& prices) {
  Json rows = Json::array();
  for (const MapPrice& price : prices.rows) {
    rows.push_back({{"map", price.map},
                    {"setting", price.setting},
                    {"seconds", price.seconds},
                    {"error", price.error},
                    {"unit", price.unit},
                    {"default", price.is_default},
                    {"chosen", price.is_chosen}});
  }
  return rows;
}

}  // namespace weft::material
