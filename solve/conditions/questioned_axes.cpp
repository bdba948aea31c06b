// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/questioned_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/percent.h"
#include "solve/photographs/photograph_blocks.h"
#include "solver/sanity/surface_witnesses.h"

namespace weft::solve {
namespace {

using solver::BlockTile;

constexpr int kFine = 2;             // pixels of a block
constexpr double kLessCurl = 0.8;    // of the curl as given
constexpr double kLeastCurl = 2e-3;  // slope from block to block: less is a flat card's rounding

std::string remedy_of(solver::Symmetry meant, bool is_of_rig) {
  if (is_of_rig) {
    return "check lights.json: x goes to the right of the picture, y upwards, z to the camera; calibrate the "
           "lights again if it was written by hand";
  }
  switch (meant) {
    case solver::Symmetry::kAsGiven:
      break;
    case solver::Symmetry::kMirrored:
      return "most often y points downwards in the light file: solve with --flip y, or with --flip x where "
             "relief comes out inside out";
    case solver::Symmetry::kQuarterTurned:
      return "solve with --flip left, or with --flip right where relief comes out inside out";
    case solver::Symmetry::kExchanged:
      return "solve with --flip exchange, or with --flip against where relief comes out inside out";
  }
  return "";
}

std::optional<Verdict> doubt_curl(const std::vector<BlockTile>& tiles, bool is_of_rig) {
  static constexpr std::array<const char*, solver::kSymmetries> kAre = {"", "mirrored", "turned by a quarter",
                                                                        "exchanged, x for y"};
  const auto curls = solver::curls(tiles);
  const auto least = static_cast<std::size_t>(std::ranges::min_element(curls) - curls.begin());
  const double share = curls[least] / curls[0];
  if (!(share < kLessCurl) || !(curls[0] > kLeastCurl)) return std::nullopt;
  return Verdict{
      "LIGHTS_MIRRORED",
      fmt::format("The lights are {}: so the solved normals would be those of a surface (their curl "
                  "falls to {} percent)",
                  kAre[least], percent_words(share)),
      remedy_of(static_cast<solver::Symmetry>(least), is_of_rig)};
}

// A curl does not see half a turn: relief is inside out, and as much a surface.
std::optional<Verdict> doubt_side(const std::vector<BlockTile>& tiles, bool has_mask, bool is_of_rig) {
  constexpr std::size_t kFewestDark = 40;
  constexpr double kExplained = 0.15, kTimes = 4, kLeast = 0.01, kRises = -0.5;
  const auto turned = [&](std::string why) {
    return Verdict{"LIGHTS_MIRRORED",
                   "The lights are turned by half, and relief is inside out: " + std::move(why),
                   is_of_rig ? remedy_of(solver::Symmetry::kAsGiven, true)
                             : "turn x and y of the lights to their opposites: solve with --flip half"};
  };
  const solver::Sides sides = solver::shadows_explained(tiles);
  if (sides.dark >= kFewestDark && sides.inside_out > kExplained &&
      sides.inside_out > kTimes * std::max(sides.as_given, kLeast))
    return turned(fmt::format("so relief stands before {} percent of what lies in shadow",
                              percent_words(sides.inside_out)));
  if (has_mask && solver::falls_at_edge(tiles) < kRises)
    return turned("what the mask shows rises at its edge, which is right for a bowl alone");
  return std::nullopt;
}

}  // namespace

std::optional<Verdict> doubt_axes(const Photographs& photographs, const SolvePlan& plan, int threads) {
  const std::vector<BlockTile> tiles = block_tiles(photographs, kFine, threads);
  if (std::optional<Verdict> curl = doubt_curl(tiles, plan.is_of_rig)) return curl;
  return doubt_side(tiles, !plan.mask.empty(), plan.is_of_rig);
}

}  // namespace weft::solve
