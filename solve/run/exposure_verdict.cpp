// SPDX-License-Identifier: Apache-2.0
#include "solve/run/exposure_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/percent.h"

namespace weft::app {
namespace {

std::string shorter(bool of_session) {
  return of_session ? "scan again with a metered exposure" : "photograph again with a shorter exposure";
}

std::string longer(bool of_session) {
  return of_session
             ? "scan again with a metered exposure, or with more light where the camera has no longer one"
             : "photograph again with a longer exposure or more light";
}

}  // namespace

std::optional<Verdict> exposure_verdict(const pipeline::Fullness& fullness, double lost, double noise_deg,
                                        bool of_session) {
  if (fullness.full > kMostFull || lost > kMostLost) {
    std::string text = fmt::format("The photographs are over: {} percent of the readings are full",
                                   percent_words(fullness.full));
    if (lost > 0)
      text += fmt::format(", and {} percent of the picture has no solution for it", percent_words(lost));
    return Verdict{"OVEREXPOSED", std::move(text), shorter(of_session)};
  }
  if (fullness.brightest && *fullness.brightest < kDarkBelow && noise_deg > kDarkNoise_deg) {
    return Verdict{
        "UNDEREXPOSED",
        fmt::format("The photographs are dark: their brightest places come to {} percent of white, and "
                    "noise turns the normals by {:.1f}° (median)",
                    percent_words(*fullness.brightest), noise_deg),
        longer(of_session)};
  }
  return std::nullopt;
}

Error nothing_solved(const std::string& where, Size size, const pipeline::Fullness& fullness,
                     bool of_session) {
  const double dark = 1 - fullness.full - fullness.missing - fullness.lit;
  const double most = std::max({fullness.full, fullness.missing, dark});
  std::string remedy = "see that readings and mask are of this cloth";
  if (most == dark) remedy = longer(of_session);
  if (most == fullness.full) remedy = shorter(of_session);
  return {ErrorKind::kBadData, "nothing was solved", where,
          fmt::format("none of {} pixels has three readings that can be used: {} percent of the readings are "
                      "full, {} percent dark and {} percent missing",
                      size.pixels(), percent_words(fullness.full), percent_words(dark),
                      percent_words(fullness.missing)),
          std::move(remedy)};
}

}  // namespace weft::app
