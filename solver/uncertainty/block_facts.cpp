// SPDX-License-Identifier: Apache-2.0
#include "solver/uncertainty/block_facts.h"

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"
#include "core/solve/solve_record.h"

namespace weft::solver {
namespace {

// Steeper normals than this have slopes that are mostly noise.
constexpr double kLeastUp = 0.2;
constexpr double kLeastLog = 1e-4, kMostLog = 1e4;

float log_of(double value) {
  return static_cast<float>(std::log(std::isfinite(value) ? std::clamp(value, kLeastLog, kMostLog) : 1.0));
}

struct Slopes {
  double p = 0, q = 0, squared = 0;
  bool known = false;
};

Slopes slopes_at(const std::array<const float*, 3>& normal, int x) {
  const auto z = static_cast<double>(normal[2][x]);
  if (!(z > kLeastUp)) return {};
  const double p = -static_cast<double>(normal[0][x]) / z, q = -static_cast<double>(normal[1][x]) / z;
  return {p, q, p * p + q * q, true};
}

double root(double sum, double count) {
  return count > 0 ? std::sqrt(std::max(sum, 0.0) / count) : 0;
}

}  // namespace

void BlockSums::add(const BlockRow& row, int count) {
  for (int x = 0; x < count; x += 2) {
    if (row.status[x] & kNoSolution) continue;
    const Slopes here = slopes_at(row.normal, x);
    if (!here.known) continue;
    const auto albedo = static_cast<double>(row.albedo[x]), residual = static_cast<double>(row.residual[x]),
               noise = static_cast<double>(row.noise_deg[x]), model = static_cast<double>(row.model_deg[x]);
    ++pixels_;
    model2_ += model * model;
    noise2_ += noise * noise;
    residual2_ += residual * residual;
    residual4_ += residual * residual * residual * residual;
    specular_ += (row.status[x] & kSpecular) != 0 ? 1 : 0;
    shadowed_ += (row.status[x] & kShadowed) != 0 ? 1 : 0;
    albedo_ += albedo;
    albedo2_ += albedo * albedo;
    slope2_ += here.squared;
    slope4_ += here.squared * here.squared;
    albedo_slope2_ += albedo * here.squared;
    if (x + 1 >= count) continue;
    const Slopes right = slopes_at(row.normal, x + 1), below = slopes_at(row.below, x);
    if (!right.known || !below.known) continue;
    // y is up, rows go down.
    const double px = right.p - here.p, qx = right.q - here.q, py = here.p - below.p, qy = here.q - below.q;
    ++pairs_;
    bend2_ += px * px + py * py + qx * qx + qy * qy;
    curl2_ += (py - qx) * (py - qx);
    // Each slope has half of the angle's variance, and the tangent grows faster than its angle.
    const double of_tangent = 1 + here.squared;
    pair_noise2_ += 2 * radians(noise) * radians(noise) * of_tangent * of_tangent;
  }
}

BlockFacts BlockSums::facts(const ModelTraits& traits, float robust) const {
  const double n = std::max(pixels_, 1.0);
  const double albedo = albedo_ / n, slope2 = slope2_ / n;
  const double albedo_varies = root(albedo2_ - n * albedo * albedo, n),
               slope_varies = root(slope4_ - n * slope2 * slope2, n);
  const double together = albedo_varies * slope_varies;
  const double bend = root(bend2_, pairs_), mean2 = residual2_ / n;
  BlockFacts facts = {};
  facts[kLogModel] = log_of(root(model2_, n));
  facts[kLogNoise] = log_of(root(noise2_, n));
  facts[kSlope] = static_cast<float>(std::sqrt(slope2));
  facts[kLogMisfit] = log_of(std::sqrt(mean2));
  facts[kMisfitPeaks] = log_of(mean2 > 0 ? residual4_ / n / (mean2 * mean2) : 1);
  facts[kAlbedo] = std::min(static_cast<float>(albedo), kMostFactAlbedo);
  facts[kAlbedoVaries] = albedo > 0 ? static_cast<float>(std::min(albedo_varies / albedo, 1.0)) : 0.0F;
  facts[kAlbedoFollowsSlope] =
      together > 0
          ? static_cast<float>(std::clamp((albedo_slope2_ / n - albedo * slope2) / together, -1.0, 1.0))
          : 0.0F;
  facts[kLogBend] = log_of(bend);
  facts[kLogCurl] = log_of(bend > 0 ? root(curl2_, pairs_) / bend : 1);
  facts[kLogCurlOfNoise] = log_of(bend > 0 ? root(pair_noise2_, pairs_) / bend : 1);
  facts[kSpecularShare] = static_cast<float>(specular_ / n);
  facts[kShadowedShare] = static_cast<float>(shadowed_ / n);
  facts[kRobustShare] = robust;
  facts[kOfHalf] = traits.is_half ? 1.0F : 0.0F;
  facts[kOfFast] = traits.is_fast ? 1.0F : 0.0F;
  facts[kBouncesOut] = traits.bounces_are_out ? 1.0F : 0.0F;
  facts[kLobeShare] = static_cast<float>(traits.lobe_share);
  facts[kLogLobeMisfit] = log_of(traits.lobe_misfit);
  facts[kSigmaSlope] = static_cast<float>(std::min(traits.sigma_slope, 1.0));
  facts[kLogUnpredicted] = log_of(traits.unpredicted);
  facts[kLogTurned] = log_of(traits.turned_deg);
  return facts;
}

}  // namespace weft::solver
