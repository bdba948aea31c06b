// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace weft::solver {
namespace {

constexpr std::array<const char*, kFrameParts> kPartNames = {"upper left", "upper right", "lower left",
                                                             "lower right"};
constexpr auto kAlphaAt = static_cast<std::size_t>(LobeParameter::kLogAlpha);

}  // namespace

const char* name_of_part(std::size_t part) {
  return kPartNames[part];
}

std::vector<LobePart> measure_parts(const LobeSamples& samples, const LobeFit& fit,
                                    std::span<const std::size_t> part, double sigma_alpha, int threads) {
  LobeParameters alpha_alone = {};
  alpha_alone[kAlphaAt] = true;
  std::vector<LobePart> parts;
  if (samples.pixels() == 0) return parts;
  for (std::size_t p = 0; p < kFrameParts; ++p) {
    LobeSamples of_part(samples.of(0).size());
    LobeFit there = {fit.lobe, {}, {}, {}, 0};
    for (std::size_t i = 0; i < samples.pixels(); ++i) {
      if (part[i] != p) continue;
      of_part.add(samples.of(i));
      there.b.push_back(fit.b[i]);
      there.yarn.push_back(fit.yarn[i]);
    }
    if (of_part.pixels() < kLeastPartPixels) continue;
    there = fit_lobe(of_part, std::move(there), {.fitted = alpha_alone, .threads = threads});
    const LobeCovariance covariance = covariance_of(of_part, there, alpha_alone, threads);
    const double formal = std::sqrt(std::max(covariance[kAlphaAt][kAlphaAt], 0.0));
    parts.push_back({p, there.lobe.alpha, std::hypot(formal, sigma_alpha), of_part.pixels()});
  }
  return parts;
}

std::optional<std::array<LobePart, 2>> change_across(std::span<const LobePart> parts) {
  if (parts.size() < 2) return std::nullopt;
  const auto [smoothest, roughest] = std::ranges::minmax_element(parts, {}, &LobePart::alpha);
  const double differ = std::log(roughest->alpha / smoothest->alpha);
  if (!(differ > kChangeSigmas * std::hypot(smoothest->sigma_alpha, roughest->sigma_alpha)))
    return std::nullopt;
  return std::array<LobePart, 2>{*smoothest, *roughest};
}

}  // namespace weft::solver
