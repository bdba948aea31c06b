// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/exposure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/percent.h"
#include "core/base/statistics.h"

namespace weft::solve {
namespace {

constexpr int kFullnessRows = 16;  // from one filter cell that is looked at to the next
constexpr double kBrightestShare = 1e-4;

double brightest_of(const RawFrame& frame) {
  const Size size = frame.counts.size();
  std::vector<double> shares;
  for (int y = 0; y < size.height; ++y) {
    if (y % kFullnessRows > 1) continue;
    for (int x = 0; x < size.width; ++x) {
      const auto black =
          static_cast<double>(frame.black[static_cast<std::size_t>(y & 1)][static_cast<std::size_t>(x & 1)]);
      shares.push_back((frame.counts(x, y) - black) / (static_cast<double>(frame.white) - black));
    }
  }
  return lower_quantile(std::move(shares), 1 - kBrightestShare);
}

double brightest_of(const Mosaics& mosaics) {
  double brightest = 0;
  for (const RawFrame& frame : mosaics.frames) brightest = std::max(brightest, brightest_of(frame));
  for (const std::vector<Bracket>& brackets : mosaics.brackets) {
    for (const Bracket& bracket : brackets) brightest = std::max(brightest, brightest_of(bracket.frame));
  }
  return brightest;
}

std::string remedy_of_over(bool of_session) {
  return of_session ? "scan again with a metered exposure" : "photograph again with a shorter exposure";
}

std::string remedy_of_dark(bool of_session) {
  return of_session
             ? "scan again with a metered exposure, or with more light where the camera has no longer one"
             : "photograph again with a longer exposure or more light";
}

}  // namespace

Fullness fullness_of(const Photographs& photographs) {
  const Size size = photographs.size;
  Image<float> scratch({size.width, 2});
  std::int64_t full = 0, missing = 0, lit = 0, all = 0;
  for (std::size_t k = 0; k < photographs.count(); ++k) {
    for (int y = 0; y < size.height; y += kFullnessRows) {
      const Rect rows = {0, y, size.width, std::min(y + 2, size.height)};
      for (const View<const float>& plane : readings_of(photographs.frames, k, rows, scratch.plane())) {
        for (int j = 0; j < plane.height(); ++j) {
          for (int x = 0; x < plane.width(); ++x) {
            const float r = plane(x, j);
            ++all;
            full += r == std::numeric_limits<float>::infinity();
            missing += std::isnan(r);
            lit += std::isfinite(r) && r > 0;
          }
        }
      }
    }
  }
  const auto share_of = [&](std::int64_t count) {
    return static_cast<double>(count) / static_cast<double>(std::max<std::int64_t>(all, 1));
  };
  Fullness result = {share_of(full), share_of(missing), share_of(lit)};
  if (const Mosaics* mosaics = photographs.mosaics()) result.brightest = brightest_of(*mosaics);
  return result;
}

std::optional<Verdict> exposure_verdict(const Fullness& fullness, double lost, double noise_deg,
                                        bool of_session) {
  if (fullness.full > kMostFull || lost > kMostLost) {
    std::string text = fmt::format("The photographs are over: {} percent of the readings are full",
                                   percent_words(fullness.full));
    if (lost > 0)
      text += fmt::format(", and {} percent of the picture has no solution for it", percent_words(lost));
    return Verdict{"OVEREXPOSED", std::move(text), remedy_of_over(of_session)};
  }
  if (fullness.brightest && *fullness.brightest < kDarkBelow && noise_deg > kDarkNoise_deg) {
    return Verdict{
        "UNDEREXPOSED",
        fmt::format("The photographs are dark: their brightest places come to {} percent of white, and "
                    "noise turns the normals by {:.1f}° (median)",
                    percent_words(*fullness.brightest), noise_deg),
        remedy_of_dark(of_session)};
  }
  return std::nullopt;
}

Error nothing_solved(const std::string& where, Size size, const Fullness& fullness, bool of_session) {
  const double dark = 1 - fullness.full - fullness.missing - fullness.lit;
  const double most = std::max({fullness.full, fullness.missing, dark});
  std::string remedy = "see that readings and mask are of this cloth";
  if (most == dark) remedy = remedy_of_dark(of_session);
  if (most == fullness.full) remedy = remedy_of_over(of_session);
  return {ErrorKind::kBadData, "nothing was solved", where,
          fmt::format("none of {} pixels has three readings that can be used: {} percent of the readings are "
                      "full, {} percent dark and {} percent missing",
                      size.pixels(), percent_words(fullness.full), percent_words(dark),
                      percent_words(fullness.missing)),
          std::move(remedy)};
}

}  // namespace weft::solve
