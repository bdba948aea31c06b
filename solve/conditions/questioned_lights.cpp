// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/questioned_lights.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
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
#include "solve/conditions/questioned_axes.h"
#include "solve/photographs/photograph_blocks.h"
#include "solver/sanity/surface_witnesses.h"
#include "solver/sanity/witnesses.h"

namespace weft::solve {
namespace {

using solver::BlockTile;

constexpr int kBlock = 4;  // pixels
// Times as well as left-out light is to be predicted, so that each is told.
constexpr double kTellsCurve = 1.5, kTellsOrder = 1.5, kTellsConstant = 1.1, kTellsNear = 1.2,
                 kTellsGains = 3;
constexpr double kIsSure = 2;             // so that a curve is mended
constexpr double kLeastConstant = 0.015;  // of a reading
constexpr double kMostConstant = 0.95;    // beyond, no light of a room explains it
constexpr double kSimpler = 3;            // times as well must what has more unknowns predict it

double through_srgb(double value) {
  return rec709_of_srgb({value, value, value})[0];
}
double to_srgb(double value) {
  return srgb_of_rec709({value, value, value})[0];
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

// Photographs that gather clearly more or less than half of them do.
std::vector<std::size_t> apart(const std::vector<double>& gains) {
  constexpr double kApart = 1.2;
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < gains.size(); ++k) {
    if (std::max(gains[k], 1 / gains[k]) > kApart) all.push_back(k);
  }
  return all;
}

// What would make the photographs fit better, by the factor by which left-out light is predicted better.
struct Findings {
  double error = 0;  // as they are taken for
  double curve = 0, order = 0, constant = 0, near = 0, gains = 0;
  double share = 0;     // of the constant
  double distance = 0;  // of near lamps, half widths of the picture
  std::vector<double> each_gain;

  double least_error() const { return error / std::max({1.0, curve, order, constant, near, gains}); }
};

// Asks photographs once, with their highlights or without.
class Asked {
 public:
  Asked(const Exposures& exposures, const std::vector<BlockTile>& tiles)
      : plan_(exposures.plan),
        size_(exposures.photographs.size),
        tiles_(tiles),
        are_distant_(std::holds_alternative<DistantLights>(exposures.photographs.field->lights())) {}

  Findings findings() const {
    const std::vector<BlockTile> lit = solver::without_shadows(tiles_);
    const Findings all = look(lit, true), matt = look(solver::without_highlights(lit), false);
    return matt.least_error() < kMatter * all.least_error() ? matt : all;
  }

 private:
  static constexpr double kMatter = 0.6;  // of the error: highlights are in the way

  Findings look(const std::vector<BlockTile>& tiles, bool is_matt) const {
    Findings found;
    found.error = solver::left_out_error(tiles);
    const auto times = [&](const solver::Meaning& meaning) {
      return found.error / solver::left_out_error(tiles, meaning);
    };
    if (plan_.transfer != Transfer::kAuto && !plan_.raw)
      found.curve = times({.curve = plan_.transfer == Transfer::kSrgb ? to_srgb : through_srgb});
    if (const std::vector<std::size_t> order = counted_order(plan_.lit); !order.empty())
      found.order = times({.order = order});
    const solver::ConstantShare share = solver::constant_share(tiles);
    found.share = share.median;
    if (share.median > kLeastConstant && share.lower > 0.25 * share.median)
      found.constant = times({.has_constant = true});
    if (are_distant_) look_near(times, found);
    look_at_gains(is_matt, found);
    return found;
  }

  template <typename Times>
  void look_near(const Times& times, Findings& found) const {
    for (const double half_widths : {1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0}) {
      const double distance = half_widths * std::max(size_.width, size_.height) / (2.0 * kBlock);
      if (const double factor = times({.distance = distance}); factor > found.near)
        found.near = factor, found.distance = half_widths;
    }
  }

  void look_at_gains(bool is_matt, Findings& found) const {
    constexpr std::size_t kFewest = 3;  // one or two have a cause of their own
    std::vector<double> gains = solver::gains_of(tiles_, is_matt);
    if (apart(gains).size() < kFewest) return;
    std::vector<BlockTile> even = solver::without_shadows(solver::evened_out(tiles_, gains));
    if (!is_matt) even = solver::without_highlights(std::move(even));
    found.gains = found.error / solver::left_out_error(even);
    found.each_gain = std::move(gains);
  }

  const SolvePlan& plan_;
  Size size_;
  const std::vector<BlockTile>& tiles_;
  bool are_distant_;
};

// --- what is said

std::string predicted(double factor) {
  return fmt::format("Light that is left out would be predicted {:.2g} times as well if ", factor);
}

Verdict curve_verdict(const Findings& found, Transfer taken) {
  const bool is_srgb = taken == Transfer::kSrgb;
  return {"TRANSFER", predicted(found.curve) + "values were " + (is_srgb ? "linear" : "those of sRGB"),
          fmt::format("solve with --transfer {}", is_srgb ? "linear" : "srgb")};
}

Verdict order_verdict(const Findings& found) {
  return {"FILE_ORDER", predicted(found.order) + "photographs were listed as people count (2 before 10)",
          "list the files in the order of the lights"};
}

Verdict constant_verdict(const Findings& found) {
  if (found.share > kMostConstant) {
    return {"LIGHTS_DO_NOT_FIT",
            "The photographs contradict the directions of their lights, and no light that is in all of them "
            "explains it",
            "check the order of photographs and lights, and each light's height over the table"};
  }
  return {"LIGHT_IN_ALL",
          fmt::format("A light that is in all photographs, {} percent of their light, would predict left-out "
                      "light {:.2g} times as well: a lit room, or a black level that was left in",
                      percent_words(found.share), found.constant),
          "photograph the cloth once with all lamps off and solve with --dark FILE"};
}

Verdict near_verdict(const Findings& found) {
  return {"LIGHTS_ARE_NEAR",
          predicted(found.near) +
              fmt::format("lamps stood {:g} half widths of the picture away, and not far", found.distance),
          "give positions of the lamps in mm and --mm-per-pixel, or move the lamps farther away"};
}

Verdict gains_verdict(const Findings& found) {
  constexpr std::size_t kMostNamed = 8;
  std::vector<std::string> words;
  const std::vector<std::size_t> all = apart(found.each_gain);
  for (const std::size_t k : all) {
    if (words.size() < kMostNamed) words.push_back(fmt::format("{} by {:.2g}", k + 1, found.each_gain[k]));
  }
  return {
      "EXPOSURES_DIFFER",
      predicted(found.gains) + fmt::format("photographs gathered other light than is said: {}{}",
                                           fmt::join(words, ", "), all.size() > kMostNamed ? ", ..." : ""),
      "photograph them again with one exposure, or write these factors behind the lights as strengths"};
}

// The likeliest alone: what has more unknowns must explain more.
std::optional<Verdict> verdict_of(const Findings& found, Transfer taken) {
  const double known = std::max({found.curve, found.near, found.order});
  if (found.gains > kTellsGains && found.gains > kSimpler * known && found.gains > 2 * found.constant)
    return gains_verdict(found);
  if (found.order > kTellsOrder && found.order >= std::max({found.curve, found.near, found.constant}))
    return order_verdict(found);
  if (found.curve > kTellsCurve && found.curve >= found.near && kSimpler * found.curve > found.constant)
    return curve_verdict(found, taken);
  if (found.near > kTellsNear && found.near >= found.constant) return near_verdict(found);
  if (found.constant > kTellsConstant) return constant_verdict(found);
  return std::nullopt;
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

// Whether the verdict was a curve that nothing but custom told, which is then mended.
bool mend(const Exposures& exposures, const Findings& found, const Verdict& verdict) {
  const SolvePlan& plan = exposures.plan;
  auto* developed = std::get_if<Developed>(&exposures.photographs.frames);
  if (verdict.name != "TRANSFER" || !plan.transfer_is_custom || developed == nullptr ||
      !(found.curve > kIsSure))
    return false;
  convert(*developed, plan.transfer, exposures.context.threads);
  exposures.photographs.conditions.assumed.push_back(
      fmt::format("values are {}, since left-out light is then predicted {:.2g} times as well",
                  plan.transfer == Transfer::kSrgb ? "linear" : "those of sRGB", found.curve));
  return true;
}

}  // namespace

Result<void> question_lights(const Exposures& exposures) {
  Conditions& conditions = exposures.photographs.conditions;
  const int threads = exposures.context.threads;
  if (!exposures.plan.is_of_rig) {
    std::vector<BlockTile> tiles = block_tiles(exposures.photographs, kBlock, threads);
    for (BlockTile& tile : tiles) tile.heights = solver::heights_of(tile);
    const Findings found = Asked(exposures, tiles).findings();
    std::optional<Verdict> verdict = verdict_of(found, exposures.plan.transfer);
    if (verdict && !mend(exposures, found, *verdict)) conditions.doubts.push_back(std::move(*verdict));
  }
  if (std::optional<Verdict> axes = doubt_axes(exposures.photographs, exposures.plan, threads))
    conditions.doubts.push_back(std::move(*axes));
  return {};
}

}  // namespace weft::solve
