// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/questioned_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/percent.h"
#include "core/base/text.h"
#include "core/image/color_spaces.h"
#include "solver/sample_tiles.h"
#include "solver/sanity/witnesses.h"

namespace weft::solve {
namespace {

using solver::BlockTile;

constexpr int kBlock = 4;                // pixels: whole cells of a colour filter
constexpr double kTells = 1.5;           // times as well predicted
constexpr double kIsSure = 2;            // so that it is mended
constexpr double kLeastConstant = 0.03;  // of a reading
constexpr double kMostConstant = 0.95;   // beyond, no light of a room explains it
constexpr double kLessCurl = 0.8;        // of the curl as given

// --- readings

double block_mean(View<const float> plane, int x0, int y0) {
  double sum = 0;
  for (int y = y0; y < y0 + kBlock; ++y) {
    for (int x = x0; x < x0 + kBlock; ++x) sum += static_cast<double>(plane(x, y));
  }
  return sum / (kBlock * kBlock);
}

// A mosaic's block has all its colours; developed photographs are asked by their green.
Vec3 light_at(const Photographs& photographs, std::size_t k, int x, int y) {
  const bool is_mosaic = photographs.planes().count == 1;
  Vec3 sum;
  for (const int c : {0, 1, 1, 2}) {
    const LightField::Light light = photographs.field->at(k, is_mosaic ? c : 1, x, y);
    sum = sum + 0.25 * light.strength * light.direction;
  }
  return sum;
}

BlockTile block_tile(const Photographs& photographs, Rect part) {
  const std::size_t count = photographs.count();
  const int plane = photographs.planes().speaker();
  BlockTile tile;
  tile.width = part.width() / kBlock;
  tile.height = part.height() / kBlock;
  tile.readings.resize(static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height) * count);
  Image<float> scratch({part.width(), part.height()});
  for (std::size_t k = 0; k < count; ++k) {
    tile.lights.push_back(light_at(photographs, k, (part.x0 + part.x1) / 2, (part.y0 + part.y1) / 2));
    const View<const float> readings =
        readings_of(photographs.frames, k, part, scratch.plane())[static_cast<std::size_t>(plane)];
    std::size_t at = k;
    for (int y = 0; y < tile.height; ++y) {
      for (int x = 0; x < tile.width; ++x, at += count)
        tile.readings[at] = static_cast<float>(block_mean(readings, kBlock * x, kBlock * y));
    }
  }
  return tile;
}

std::vector<BlockTile> block_tiles(const Photographs& photographs, int threads) {
  const std::vector<Rect> parts = solver::sample_tiles(photographs.size);
  std::vector<BlockTile> tiles(parts.size());
  parallel_for(parts.size(), threads,
               [&](std::size_t i, int) { tiles[i] = block_tile(photographs, parts[i]); });
  return tiles;
}

// --- what may be otherwise

/// What would make the photographs fit better.
struct Suspicion {
  double factor = 1;  ///< by which left-out light would be predicted better
  Verdict verdict;
};

double through_srgb(double value) {
  return rec709_of_srgb({value, value, value})[0];
}
double to_srgb(double value) {
  return srgb_of_rec709({value, value, value})[0];
}

std::optional<Suspicion> suspect_curve(const std::vector<BlockTile>& tiles, double error, Transfer taken) {
  const bool is_srgb = taken == Transfer::kSrgb;
  const double factor = error / solver::left_out_error_through(tiles, is_srgb ? to_srgb : through_srgb);
  if (!(factor > kTells)) return std::nullopt;
  return Suspicion{
      factor,
      {"TRANSFER",
       fmt::format("Light that is left out would be predicted {:.2g} times as well if values were {}", factor,
                   is_srgb ? "linear" : "those of sRGB"),
       fmt::format("solve with --transfer {}", is_srgb ? "linear" : "srgb")}};
}

std::optional<Suspicion> suspect_constant(const std::vector<BlockTile>& tiles, double error) {
  const double factor = error / solver::left_out_error(tiles, true);
  const double share = solver::constant_share(tiles);
  if (!(factor > kTells) || !(share > kLeastConstant)) return std::nullopt;
  if (share > kMostConstant) {
    return Suspicion{
        factor,
        {"LIGHTS_DO_NOT_FIT",
         "The photographs contradict the directions of their lights, and no light that is in all "
         "of them explains it",
         "check the order of photographs and lights, and each light's height over the table"}};
  }
  return Suspicion{
      factor,
      {"LIGHT_IN_ALL",
       fmt::format("A light that is in all photographs, {} percent of their light, would predict left-out "
                   "light {:.2g} times as well: a lit room, or a black level that was left in",
                   percent_words(share), factor),
       "photograph the cloth once with all lamps off and solve with --dark FILE"}};
}

// Which light each photograph has if they were listed as text sorts them, and lights as people count.
std::vector<std::size_t> counted_order(const std::vector<Shot>& shots) {
  std::vector<std::size_t> order(shots.size());
  std::iota(order.begin(), order.end(), 0);
  const auto before_in_text = [&](std::size_t a, std::size_t b) { return shots[a].file < shots[b].file; };
  if (!std::ranges::is_sorted(order, before_in_text)) return {};
  std::vector<std::size_t> counted = order;
  std::ranges::stable_sort(
      counted, [&](std::size_t a, std::size_t b) { return stands_before(shots[a].file, shots[b].file); });
  if (counted == order) return {};
  std::vector<std::size_t> light_of(shots.size());
  for (std::size_t rank = 0; rank < counted.size(); ++rank) light_of[counted[rank]] = rank;
  return light_of;
}

std::optional<Suspicion> suspect_order(const std::vector<BlockTile>& tiles, double error,
                                       const std::vector<Shot>& shots) {
  const std::vector<std::size_t> order = counted_order(shots);
  if (order.empty()) return std::nullopt;
  const double factor = error / solver::left_out_error_in_order(tiles, order);
  if (!(factor > kTells)) return std::nullopt;
  return Suspicion{
      factor,
      {"FILE_ORDER",
       fmt::format("Light that is left out would be predicted {:.2g} times as well if photographs "
                   "were listed as people count (2 before 10)",
                   factor),
       "list the files in the order of the lights"}};
}

std::optional<Verdict> doubt_axes(const std::vector<BlockTile>& tiles) {
  const auto curls = solver::curls(tiles);
  const auto least = static_cast<std::size_t>(std::ranges::min_element(curls) - curls.begin());
  const double share = curls[least] / curls[0];
  if (!(share < kLessCurl)) return std::nullopt;
  struct Words {
    const char* are;
    const char* remedy;
  };
  static constexpr std::array<Words, solver::kSymmetries> kWords = {
      {{"", ""},
       {"mirrored",
        "most often y points downwards in the light file: solve with --flip y, or with --flip x "
        "where relief comes out inside out"},
       {"turned by a quarter",
        "solve with --flip left, or with --flip right where relief comes out inside out"},
       {"exchanged, x for y",
        "solve with --flip exchange, or with --flip against where relief comes out inside "
        "out"}}};
  return Verdict{
      "LIGHTS_MIRRORED",
      fmt::format("The lights are {}: so the solved normals would be those of a surface (their curl "
                  "falls to {} percent)",
                  kWords[least].are, percent_words(share)),
      kWords[least].remedy};
}

void convert(Developed& developed, Transfer taken, int threads) {
  parallel_for(developed.rgb.size(), threads, [&](std::size_t k, int) {
    Image<float>& image = developed.rgb[k];
    for (int c = 0; c < image.planes(); ++c) {
      for (int y = 0; y < image.height(); ++y) {
        float* row = image.plane(c).row(y);
        std::transform(row, row + image.width(), row, [&](float v) {
          const double value = static_cast<double>(v);
          return std::isfinite(v)
                     ? static_cast<float>(taken == Transfer::kSrgb ? to_srgb(value) : through_srgb(value))
                     : v;
        });
      }
    }
    developed.page_out(k);
  });
}

}  // namespace

Result<void> question_lights(const Exposures& exposures) {
  const SolvePlan& plan = exposures.plan;
  if (plan.is_of_rig) return {};
  Conditions& conditions = exposures.photographs.conditions;
  std::vector<BlockTile> tiles = block_tiles(exposures.photographs, exposures.context.threads);
  std::optional<Suspicion> likeliest;
  const auto suspect = [&](std::optional<Suspicion> another) {
    if (another && (!likeliest || another->factor > likeliest->factor)) likeliest = std::move(another);
  };
  const double error = solver::left_out_error(tiles);
  std::optional<Suspicion> curve;
  if (plan.transfer_is_custom && plan.transfer != Transfer::kAuto)
    curve = suspect_curve(tiles, error, plan.transfer);
  suspect(suspect_order(tiles, error, plan.lit));
  suspect(suspect_constant(tiles, error));
  auto* developed = std::get_if<Developed>(&exposures.photographs.frames);
  if (curve && developed != nullptr && curve->factor > kIsSure &&
      (!likeliest || curve->factor > likeliest->factor)) {
    convert(*developed, plan.transfer, exposures.context.threads);
    conditions.assumed.push_back(
        fmt::format("values are {}, since left-out light is then predicted {:.2g} times as well",
                    plan.transfer == Transfer::kSrgb ? "linear" : "those of sRGB", curve->factor));
    tiles = block_tiles(exposures.photographs, exposures.context.threads);
    likeliest.reset();
  } else {
    suspect(std::move(curve));
  }
  if (likeliest) conditions.doubts.push_back(std::move(likeliest->verdict));
  if (std::optional<Verdict> axes = doubt_axes(tiles)) conditions.doubts.push_back(std::move(*axes));
  return {};
}

}  // namespace weft::solve
