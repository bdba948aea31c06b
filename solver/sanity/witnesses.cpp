// SPDX-License-Identifier: Apache-2.0
#include "solver/sanity/witnesses.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "core/base/statistics.h"

namespace weft::solver {
namespace {

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kFewestBlocks = 50;
constexpr double kMostReadings = 1e5;    // that one witness looks at
constexpr double kMostOfGains = 3e4;     // that each round of gains_of() looks at
constexpr double kWorstCondition = 2e4;  // of the lights' normal equations, by Frobenius' norm

using Unknowns = Eigen::Matrix<double, 4, 1>;
using Normal = Eigen::Matrix<double, 4, 4>;

// Every so many blocks are looked at.
std::size_t step_for(std::span<const BlockTile> tiles, double most) {
  double readings = 0;
  for (const BlockTile& tile : tiles) readings += static_cast<double>(tile.readings.size());
  return static_cast<std::size_t>(std::max(1.0, std::ceil(readings / most)));
}

// Where a lamp's light comes from at a place over the picture, as bright as it is there.
Vec3 light_at(const Vec3& far, double distance, const Vec3& place) {
  const double strength = length(far);
  const Vec3 way = distance / strength * far - place;
  const double ratio = distance / length(way);
  return strength * ratio * ratio / length(way) * way;
}

// A block and the lights that light it, as they may be meant.
class BlockFit {
 public:
  explicit BlockFit(const Meaning& meaning) : meaning_(meaning), unknowns_(meaning.has_constant ? 4 : 3) {}

  // False where it says nothing.
  bool fit(const BlockTile& tile, std::size_t block) {
    const std::span<const float> readings = tile.of(block);
    const auto width = static_cast<std::size_t>(tile.width);
    const Vec3 place = {tile.left + static_cast<double>(block % width),
                        tile.top - static_cast<double>(block / width),
                        tile.heights.empty() ? 0 : tile.heights[block]};
    lit_.clear(), rows_.clear(), values_.clear();
    for (std::size_t k = 0; k < readings.size(); ++k) {
      if (!std::isfinite(readings[k])) continue;
      const double value = static_cast<double>(readings[k]);
      Vec3 light = tile.light(block, meaning_.order.empty() ? k : meaning_.order[k]);
      if (meaning_.distance > 0) light = light_at(light, meaning_.distance, place);
      lit_.push_back(k);
      rows_.push_back({light.x, light.y, light.z, meaning_.has_constant ? 1.0 : 0.0});
      values_.push_back(meaning_.curve ? meaning_.curve(value) : value);
    }
    return lit_.size() > static_cast<std::size_t>(unknowns_) && mean() > 0 && solve();
  }

  const std::vector<std::size_t>& lit() const { return lit_; }
  double constant() const { return solved_(3); }
  Vec3 normal() const { return normalized({solved_(0), solved_(1), solved_(2)}); }
  double mean() const {
    return std::accumulate(values_.begin(), values_.end(), 0.0) / static_cast<double>(values_.size());
  }
  double value(std::size_t i) const { return values_[i]; }
  // What lit light i gives beyond what the others predict; NaN where they do not tell.
  double left_out(std::size_t i) const {
    constexpr double kTold = 1e-6;
    const double own = 1 - rows_[i].dot(inverse_ * rows_[i]);
    return own > kTold ? (values_[i] - rows_[i].dot(solved_)) / own : kNone;
  }

 private:
  bool solve() {
    Normal normal = Normal::Zero();
    Unknowns right = Unknowns::Zero();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      normal += rows_[i] * rows_[i].transpose();
      right += values_[i] * rows_[i];
    }
    if (unknowns_ < 4) normal(3, 3) = normal.trace() / 3;  // which no row knows of
    inverse_ = normal.inverse();
    solved_ = inverse_ * right;
    const double condition = normal.norm() * inverse_.norm();
    return std::isfinite(condition) && condition < kWorstCondition;
  }

  const Meaning& meaning_;
  int unknowns_;
  std::vector<std::size_t> lit_;
  std::vector<Unknowns> rows_;
  std::vector<double> values_;
  Normal inverse_;
  Unknowns solved_;
};

// Calls visit(fit) for the blocks that tell something.
template <typename Visit>
void for_each_fit(std::span<const BlockTile> tiles, const Meaning& meaning, const Visit& visit,
                  double most = kMostReadings) {
  const std::size_t step = step_for(tiles, most);
  BlockFit fit(meaning);
  for (const BlockTile& tile : tiles) {
    for (std::size_t block = 0; block < tile.blocks(); block += step) {
      if (fit.fit(tile, block)) visit(fit);
    }
  }
}

// One round of gains_of(): by how much more each photograph gathers than the others say.
std::vector<double> next_gains(std::span<const BlockTile> tiles, std::size_t count) {
  std::vector<std::vector<double>> ratios(count);
  const auto compare = [&](const BlockFit& fit) {
    for (std::size_t i = 0; i < fit.lit().size(); ++i) {
      const double predicted = fit.value(i) - fit.left_out(i);
      if (predicted > kLeastLit * fit.mean()) ratios[fit.lit()[i]].push_back(fit.value(i) / predicted);
    }
  };
  for_each_fit(tiles, {}, compare, kMostOfGains);
  std::vector<double> gains;
  for (std::vector<double>& each : ratios) {
    gains.push_back(each.size() < kFewestBlocks / 4 ? kNone : quantile(std::move(each), 0.5));
  }
  return gains;
}

}  // namespace

std::vector<BlockTile> without_shadows(std::vector<BlockTile> tiles, double least_lit) {
  for (BlockTile& tile : tiles) {
    for (std::size_t block = 0; block < tile.blocks(); ++block) {
      const std::span<float> readings = tile.of(block);
      const float mean =
          std::accumulate(readings.begin(), readings.end(), 0.0F) / static_cast<float>(tile.count);
      for (float& reading : readings) {
        if (!(mean > 0) || !(reading >= static_cast<float>(least_lit) * mean)) reading = kMissing;
      }
    }
  }
  return tiles;
}

std::vector<BlockTile> without_highlights(std::vector<BlockTile> tiles) {
  constexpr double kMirrored = 0.75;  // cosine of the angle from the camera
  constexpr std::size_t kFewest = 6;  // lights that are left
  const Meaning as_told;
  BlockFit fit(as_told);
  for (BlockTile& tile : tiles) {
    for (std::size_t block = 0; block < tile.blocks(); ++block) {
      if (!fit.fit(tile, block)) continue;
      const Vec3 normal = fit.normal();
      std::vector<std::size_t> shining;
      for (const std::size_t k : fit.lit()) {
        const Vec3 light = normalized(tile.light(block, k));
        if ((2 * dot(normal, light) * normal - light).z > kMirrored) shining.push_back(k);
      }
      if (fit.lit().size() - shining.size() < kFewest) continue;
      for (const std::size_t k : shining) tile.of(block)[k] = kMissing;
    }
  }
  return tiles;
}

double left_out_error(std::span<const BlockTile> tiles, const Meaning& meaning) {
  std::vector<double> errors;
  for_each_fit(tiles, meaning, [&](const BlockFit& fit) {
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < fit.lit().size(); ++i) {
      const double miss = fit.left_out(i);
      if (!std::isfinite(miss)) continue;
      sum += miss * miss;
      ++count;
    }
    if (count > 0) errors.push_back(std::sqrt(sum / count) / fit.mean());
  });
  return errors.size() < kFewestBlocks ? std::numeric_limits<double>::infinity()
                                       : quantile(std::move(errors), 0.5);
}

ConstantShare constant_share(std::span<const BlockTile> tiles) {
  std::vector<double> shares;
  for_each_fit(tiles, {.has_constant = true},
               [&](const BlockFit& fit) { shares.push_back(fit.constant() / fit.mean()); });
  if (shares.size() < kFewestBlocks) return {kNone, kNone};
  return {quantile(shares, 0.25), quantile(shares, 0.5)};
}

std::vector<BlockTile> evened_out(std::vector<BlockTile> tiles, std::span<const double> gains) {
  for (BlockTile& tile : tiles) {
    for (std::size_t i = 0; i < tile.readings.size(); ++i)
      tile.readings[i] /= static_cast<float>(gains[i % tile.count]);
  }
  return tiles;
}

// A light that gathers little is taken for shadow at first: what counts is chosen anew now and then.
std::vector<double> gains_of(std::span<const BlockTile> tiles, bool is_matt) {
  constexpr int kChoices = 3;
  constexpr std::size_t kFew = 16;  // lights, which take long to agree
  if (tiles.empty()) return {};
  const int rounds = tiles[0].count < kFew ? 40 : 10;
  std::vector<double> gains(tiles[0].count, 1.0);
  for (int choice = 0; choice < kChoices; ++choice) {
    const double least_lit = choice == 0 ? kLeastLit / 2 : kLeastLit;
    std::vector<BlockTile> lit = without_shadows(evened_out({tiles.begin(), tiles.end()}, gains), least_lit);
    if (!is_matt) lit = without_highlights(std::move(lit));
    for (int round = 0; round < rounds; ++round) {
      std::vector<double> more = next_gains(lit, gains.size());
      const bool is_last = choice + 1 == kChoices && round + 1 == rounds;
      if (is_last && !std::ranges::all_of(more, [](double gain) { return gain > 0; })) return {};
      for (double& gain : more) gain = gain > 0 ? gain : 1;
      lit = evened_out(std::move(lit), more);
      std::ranges::transform(gains, more, gains.begin(), std::multiplies());
    }
  }
  const double middle = quantile(gains, 0.5);
  for (double& gain : gains) gain /= middle;
  return gains;
}

}  // namespace weft::solver
