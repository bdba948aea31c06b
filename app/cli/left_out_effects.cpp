// SPDX-License-Identifier: Apache-2.0
#include "app/cli/left_out_effects.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "app/cli/terminal.h"

namespace weft::app {
namespace {

using simulator::LeftOutEffect;

constexpr double kWorthTelling_s = 0.05;

std::string sigma_of(const LeftOutEffect& effect) {
  return std::isinf(effect.bound_sigma) ? "no bound" : fmt::format("{:.3g}", effect.bound_sigma);
}

std::string words_of(double seconds) {
  return seconds < kWorthTelling_s ? "under 0.05" : fmt::format("{:.1f}", seconds);
}

}  // namespace

void print_left_out(std::span<const LeftOutEffect> left_out, std::span<const double> saved_seconds) {
  if (left_out.empty()) return;
  print(fmt::format("\nleft out              sigma at most  {}why",
                    saved_seconds.empty() ? "" : "thread-seconds saved  "));
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    const std::string saved =
        saved_seconds.empty() ? "" : fmt::format("{:>20}  ", words_of(saved_seconds[i]));
    print(
        fmt::format("{:<21} {:>13}  {}{}", left_out[i].name, sigma_of(left_out[i]), saved, left_out[i].why));
  }
}

}  // namespace weft::app
