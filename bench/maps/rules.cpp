// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/rules.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "material/filtering/normal_length.h"

namespace weft::bench {
namespace {

using material::Footprint;
using material::LobeWidth;
using material::MipTexel;
using material::NormalWeight;

constexpr int kMostSamples = 32;  // a side, of larger footprints
constexpr int kTriedAlphas = 22;  // 0.05 to 1

std::vector<Vec3> block_of(const NormalSquare& cloth, int x0, int y0, int across, int down) {
  const int step_x = std::max(1, across / kMostSamples), step_y = std::max(1, down / kMostSamples);
  std::vector<Vec3> block;
  for (int y = y0; y < y0 + down; y += step_y) {
    for (int x = x0; x < x0 + across; x += step_x) block.push_back(cloth.at(x % cloth.side, y % cloth.side));
  }
  return block;
}

MipTexel texel_of(const std::vector<Vec3>& normals, double alpha, const MipContender& contender) {
  const double shortening = material::normal_length(alpha);
  Footprint sum;
  for (const Vec3 n : normals) {
    sum.add(contender.weight == NormalWeight::kFacet ? 1 / n.z : 1, n, {alpha, alpha, 0}, shortening);
  }
  return material::filtered(sum, contender.rule);
}

/// What is seen of one place, and what texels make of it.
struct Place {
  std::vector<Vec3> normals;
  Vec3 mean;
  std::vector<MipTexel> texels;
  std::array<double, kTriedAlphas> squares_of_tried{};
};

double tried_alpha(int i) {
  return 0.05 * std::pow(20.0, i / (kTriedAlphas - 1.0));
}

std::vector<Place> places_of(const NormalSquare& cloth, const MipTrial& trial,
                             std::span<const MipContender> contenders, std::mt19937& random) {
  std::uniform_int_distribution<int> any(0, cloth.side - 1);
  const int texel_across = trial.texel_across_px > 0 ? trial.texel_across_px : trial.across_px;
  std::vector<Place> places;
  for (int i = 0; i < trial.footprints; ++i) {
    const int x = any(random), y = any(random);
    Place place;
    place.normals = block_of(cloth, x, y, trial.across_px, trial.down_px);
    const std::vector<Vec3> beneath = block_of(cloth, x + cloth.side - (texel_across - trial.across_px) / 2,
                                               y, texel_across, trial.down_px);
    Vec3 sum;
    for (const Vec3 n : beneath) sum = sum + n;
    place.mean = normalized(sum);
    for (const MipContender& contender : contenders)
      place.texels.push_back(texel_of(beneath, trial.alpha, contender));
    places.push_back(std::move(place));
  }
  return places;
}

std::vector<Vec3> lights_of(const MipTrial& trial, std::mt19937& random) {
  std::vector<Vec3> lights;
  while (static_cast<int>(lights.size()) < trial.lights) {
    const Vec3 l = trial.highest_light_deg > 0 ? [&] {
      std::uniform_real_distribution<double> any(0, 1);
      const double tilt = radians(trial.highest_light_deg + any(random) * (trial.lowest_light_deg - trial.highest_light_deg));
      const double phi = 2 * kPi * any(random);
      return Vec3{std::sin(tilt) * std::cos(phi), std::sin(tilt) * std::sin(phi), std::cos(tilt)};
    }() : cosine_lights(1, random).front();
    lights.push_back(l);
  }
  return lights;
}

}  // namespace

MipErrors mip_errors(const NormalSquare& cloth, const MipTrial& trial,
                     std::span<const MipContender> contenders, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Place> places = places_of(cloth, trial, contenders, random);
  std::vector<double> squares(contenders.size(), 0.0);
  double truths = 0;
  for (const double azimuth : {0.0, kPi / 2}) {
    const double tilt = radians(trial.view_deg);
    const Vec3 v = {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
    for (const Vec3 l : lights_of(trial, random)) {
      for (Place& place : places) {
        double truth = 0;
        for (const Vec3 n : place.normals)
          truth += reflected(n, {trial.alpha, trial.alpha, 0}, l, v, trial.law);
        truth /= static_cast<double>(place.normals.size());
        truths += truth * truth;
        for (std::size_t c = 0; c < contenders.size(); ++c) {
          const MipTexel& texel = place.texels[c];
          squares[c] += std::pow(reflected(texel.normal, texel.lobe, l, v, trial.law) - truth, 2);
        }
        for (int i = 0; i < kTriedAlphas; ++i) {
          const LobeWidth lobe = {tried_alpha(i), tried_alpha(i), 0};
          place.squares_of_tried[static_cast<std::size_t>(i)] +=
              std::pow(reflected(place.mean, lobe, l, v, trial.law) - truth, 2);
        }
      }
    }
  }
  MipErrors errors;
  for (const double s : squares) errors.by_contender.push_back(std::sqrt(s / truths));
  double best = 0;
  for (const Place& place : places) {
    const auto* least = std::ranges::min_element(place.squares_of_tried);
    best += *least;
    errors.alpha += tried_alpha(static_cast<int>(least - place.squares_of_tried.begin())) / trial.footprints;
  }
  errors.best = std::sqrt(best / truths);
  return errors;
}

}  // namespace weft::bench
