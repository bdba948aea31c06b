// SPDX-License-Identifier: Apache-2.0
#include "solver/diagnosis/highlights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/statistics.h"
#include "solver/in_double/pixel.h"

namespace weft::solver {
namespace {

struct Brightness {
  int channel = 0;
  double median = 0, most = 0;  // over the lights
};

std::vector<Brightness> brightness_of(const Evidence& evidence) {
  std::vector<Brightness> all;
  std::vector<double> x;
  for (std::size_t p = 0; p < evidence.pixels(); ++p) {
    x.clear();
    for (std::size_t k = 0; k < evidence.lights; ++k) {
      const EvidenceRow& row = evidence.at(p, k);
      if (std::isfinite(row.reading) && row.strength > 0) x.push_back(row.reading / row.strength);
    }
    if (x.empty()) continue;
    const double most = *std::ranges::max_element(x);
    all.push_back({evidence.channel[p], median(x), most});
  }
  return all;
}

}  // namespace

double outshining_share(const Evidence& evidence) {
  const std::vector<Brightness> pixels = brightness_of(evidence);
  std::array<std::vector<double>, 3> medians;
  for (const Brightness& b : pixels) medians[static_cast<std::size_t>(b.channel)].push_back(b.median);
  std::array<double, 3> matt = {};
  for (std::size_t c = 0; c < 3; ++c) {
    if (!medians[c].empty()) matt[c] = lower_quantile(std::move(medians[c]), 0.75);
  }
  const auto outshining = std::ranges::count_if(pixels, [&](const Brightness& b) {
    return b.most > kSpecularTimes * matt[static_cast<std::size_t>(b.channel)];
  });
  return pixels.empty() ? 0 : static_cast<double>(outshining) / static_cast<double>(pixels.size());
}

}  // namespace weft::solver
