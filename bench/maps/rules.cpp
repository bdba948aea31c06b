// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "material/filtering/normal_length.h"
#include "simulator/geometry/scene_surface.h"

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

namespace {

constexpr double kFibreF0 = 0.04;
constexpr double kGrazing = 1e-4;

struct TangentFrame {
  Vec3 along, across;
};

// Whose first axis lies over the azimuth, seen from above.
TangentFrame tangents_of(Vec3 n, double azimuth_deg) {
  const double c = std::cos(radians(azimuth_deg)), s = std::sin(radians(azimuth_deg));
  const Vec3 along = normalized({c * n.z, s * n.z, -(c * n.x + s * n.y)});
  return {along, cross(n, along)};
}

/// Half-vector and its share of each roughness: (h.t / a)^2 + (h.b / b)^2 + (h.n)^2.
struct StretchedHalf {
  double along = 0, across = 0, up = 0;
  double tilt2() const { return along * along + across * across; }
};

double density_of(const StretchedHalf& h, double areas, FacetLaw law) {
  if (!(h.up > 0)) return 0;
  if (law == FacetLaw::kGgx) return 1 / (kPi * areas * std::pow(h.tilt2() + h.up * h.up, 2));
  return std::exp(-h.tilt2() / (h.up * h.up)) / (kPi * areas * std::pow(h.up, 4));
}

// Smith's G_1 of a direction whose stretched tangent is `tangent` (Walter et al. 2007, eq. 34 and its fit).
double share_seen(double tangent, FacetLaw law) {
  if (law == FacetLaw::kGgx) return 2 / (1 + std::sqrt(1 + tangent * tangent));
  if (tangent <= 0) return 1;
  const double a = 1 / tangent;
  return a < 1.6 ? (3.535 * a + 2.181 * a * a) / (1 + 2.276 * a + 2.577 * a * a) : 1;
}

std::vector<NormalSquare> squares_of(std::vector<std::pair<const char*, simulator::GeometrySettings>> cloths,
                                     int threads) {
  std::vector<NormalSquare> squares(cloths.size());
  parallel_for(cloths.size(), threads,
               [&](std::size_t i, int) { squares[i] = normal_square(cloths[i].first, cloths[i].second); });
  return squares;
}

simulator::GeometrySettings woven(simulator::GeometryKind kind, double crimp, double flank_deg,
                                  double fibres) {
  simulator::GeometrySettings geometry;
  geometry.kind = kind;
  geometry.crimp = crimp;
  geometry.flank_deg = flank_deg;
  geometry.fibre_relief = fibres;
  return geometry;
}

}  // namespace

double reflected(Vec3 n, const material::LobeWidth& lobe, Vec3 l, Vec3 v, FacetLaw law) {
  const double n_l = dot(n, l), n_v = std::max(dot(n, v), kGrazing);
  if (!(n_l > 0)) return 0;
  const Vec3 h = normalized(l + v);
  const TangentFrame t = tangents_of(n, lobe.azimuth_deg);
  const double a = std::max(lobe.along, 1e-3), b = std::max(lobe.across, 1e-3);
  const StretchedHalf half = {dot(h, t.along) / a, dot(h, t.across) / b, dot(h, n)};
  const auto tangent = [&](Vec3 d, double cosine) {
    return std::hypot(a * dot(d, t.along), b * dot(d, t.across)) / cosine;
  };
  const double seen = share_seen(tangent(l, n_l), law) * share_seen(tangent(v, n_v), law);
  const double fresnel = kFibreF0 + (1 - kFibreF0) * std::pow(1 - dot(l, h), 5);
  return fresnel * density_of(half, a * b, law) * seen / (4 * n_v);
}

NormalSquare normal_square(std::string name, const simulator::GeometrySettings& geometry, int side,
                           double mm_per_pixel) {
  const simulator::Surface cloth = simulator::surface_of(geometry);
  NormalSquare square = {std::move(name), side, 0, {}};
  square.normals.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      square.normals.push_back(simulator::point_at(cloth, x * mm_per_pixel, -y * mm_per_pixel).normal);
      square.slope_deg += degrees(std::acos(square.normals.back().z));
    }
  }
  square.slope_deg /= static_cast<double>(square.normals.size());
  return square;
}

std::vector<NormalSquare> page_weaves(int threads) {
  using simulator::GeometryKind;
  simulator::GeometrySettings satin = woven(GeometryKind::kSatin, 0.08, 36, 0.003);
  satin.flatness = 0.25;
  return squares_of({{"smooth", woven(GeometryKind::kPlain, 0.03, 14, 0.002)},
                     {"satin", satin},
                     {"plain", woven(GeometryKind::kPlain, 0.08, 36, 0.003)},
                     {"deep", woven(GeometryKind::kPlain, 0.2, 62, 0)}},
                    threads);
}

std::vector<NormalSquare> other_weaves(int threads) {
  using simulator::GeometryKind;
  simulator::GeometrySettings eight = woven(GeometryKind::kSatin, 0.06, 28, 0.002);
  eight.over = 7;
  eight.under = 1;
  eight.step = 3;
  simulator::GeometrySettings twisted = woven(GeometryKind::kPlain, 0.06, 30, 0);
  twisted.twist_relief = 0.02;
  simulator::GeometrySettings knit;
  knit.kind = GeometryKind::kKnit;
  return squares_of({{"twill", woven(GeometryKind::kTwill, 0.08, 36, 0.003)},
                     {"eight-harness satin", eight},
                     {"twisted plain", twisted},
                     {"knit", knit}},
                    threads);
}

std::vector<Vec3> cosine_lights(int count, std::mt19937& random) {
  std::uniform_real_distribution<double> any(0, 1);
  std::vector<Vec3> lights;
  for (int i = 0; i < count; ++i) {
    const double phi = 2 * kPi * any(random), up = std::sqrt(1 - any(random)), out = std::sqrt(1 - up * up);
    lights.push_back({out * std::cos(phi), out * std::sin(phi), up});
  }
  return lights;
}

std::vector<Vec3> ggx_facets(double alpha, int count, std::mt19937& random) {
  std::uniform_real_distribution<double> any(0, 1);
  std::vector<Vec3> facets;
  for (int i = 0; i < count; ++i) {
    const double u = any(random), tilt = std::atan(alpha * std::sqrt(u / (1 - u))),
                 phi = 2 * kPi * any(random);
    facets.push_back({std::sin(tilt) * std::cos(phi), std::sin(tilt) * std::sin(phi), std::cos(tilt)});
  }
  return facets;
}

}  // namespace weft::bench
