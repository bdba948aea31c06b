// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/frame_words.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/percent.h"

namespace weft::solve {

int number_of(const Exposures& exposures, std::size_t k) {
  return exposures.plan.is_of_rig ? exposures.photographs.leds[k] : exposures.plan.lit[k].led;
}

std::string name_of(const Exposures& exposures, std::size_t k) {
  const int number = number_of(exposures, k);
  if (exposures.plan.is_of_rig) return fmt::format("LED {}", number);
  return fmt::format("photograph {} ({})", number, exposures.plan.lit[k].file);
}

std::string how_again(const Exposures& exposures, int number) {
  if (!exposures.plan.is_of_rig)
    return number == 0 ? "photograph it again with all lamps off"
                       : "photograph it again, or leave it out of the list";
  return fmt::format("take it again: weft scan --again {} -o {}", number, exposures.plan.session_name);
}

std::string words_of(const solver::CellChange& cost) {
  constexpr double kLeastAlbedo = 0.0005;
  const std::string turns = fmt::format("turns the normals by {:.2g}\u00b0", cost.turned_deg);
  if (std::abs(cost.albedo) < kLeastAlbedo) return turns;
  return fmt::format("{} and makes albedo {} percent too {}", turns, percent_words(std::abs(cost.albedo)),
                     cost.albedo > 0 ? "bright" : "dark");
}

}  // namespace weft::solve
