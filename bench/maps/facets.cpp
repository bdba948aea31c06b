// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/facets.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "simulator/geometry/surface.h"

namespace weft::bench {
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
