// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/cell_noise.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/statistics.h"

namespace weft::solve {

double cell_noise(const solver::FrameCells& cells, const solver::CellFit& fit,
                  const std::optional<NoiseModel>& noise) {
  if (!noise) return 0;
  constexpr std::size_t kMost = 20'000;
  constexpr double kGreens = 2;  // of a cell
  const std::size_t step = std::max<std::size_t>(1, cells.value.size() / kMost) | 1U;
  std::vector<double> sigmas;
  for (std::size_t i = 0; i < cells.value.size(); i += step) {
    const auto brightness = static_cast<double>(fit.brightness[i / cells.count]);
    const auto value = static_cast<double>(cells.value[i]), strength = static_cast<double>(cells.strength[i]);
    if (!std::isfinite(value) || !(brightness > 0)) continue;
    sigmas.push_back(std::sqrt(noise->variance(value * strength) / kGreens) / (strength * brightness));
  }
  return sigmas.empty() ? 0 : median(std::move(sigmas));
}

}  // namespace weft::solve
