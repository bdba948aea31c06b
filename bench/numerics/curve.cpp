// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bench/numerics/numerics.h"
#include "bench/numerics/plain_formula.h"
#include "bench/oracles/hard_lights.h"
#include "bench/oracles/quad_oracle.h"
#include "bench/oracles/rig.h"
#include "core/solve_record.h"

namespace weft::bench {
namespace {

using solver::PixelRow;

constexpr int kPixels = 300;
constexpr std::size_t kLights = 6;

/// The rows of one pixel under lights of a condition number, exact in float32 as far as float32 can tell
/// lights apart.
std::vector<std::vector<PixelRow>> pixels_at(double condition) {
  DistantLights lights = test::clustered_lights(kLights, std::min(condition, 1e7));
  const Vec3 axis = test::cluster_axis(), across = {0, 1, 0}, up = cross(axis, across);
  const double closer = std::max(1.0, condition / 1e7);
  std::vector<std::vector<PixelRow>> pixels;
  for (int x = 0; x < kPixels; ++x) {
    test::Random random(static_cast<std::uint64_t>(x));
    const Vec3 z = test::random_normal(random, 10), n = z.x * across + z.y * up + z.z * axis;
    std::vector<PixelRow> rows;
    for (const DistantLight& light : lights.lights) {
      const Vec3 aside = light.direction - dot(light.direction, axis) * axis;
      const Vec3 l = closer > 1 ? normalized(axis + (1 / closer) * aside) : light.direction;
      const double reading = static_cast<float>(0.4 * dot(n, l));
      rows.push_back({l, {1, 1, 1}, {reading, reading, reading}});
    }
    pixels.push_back(std::move(rows));
  }
  return pixels;
}

/// The level `fast` on these pixels, whose lights are the same.
struct Ours {
  std::vector<Vec3> normals;
  bool flagged = false;
};

Ours solve_ours(const std::vector<std::vector<PixelRow>>& pixels) {
  DistantLights lights;
  for (const PixelRow& row : pixels[0]) lights.lights.push_back({row.direction, {1, 1, 1}});
  const Size size = {kPixels, 1};
  const Result<LightField> field = LightField::make(lights, std::nullopt, size, 0);
  Ours ours;
  if (!field) {
    // A rig like this is refused as a whole; a pixel may still be left with such lights, and goes straight to
    // double.
    for (const std::vector<PixelRow>& rows : pixels) {
      const solver::PixelSolution s = solver::solve_pixel(rows, {1, true, {}});
      const Vec3 n = s.normal;
      ours.normals.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
      ours.flagged |= (s.status & (kIllConditioned | kNoSolution)) != 0;
    }
    return ours;
  }
  test::Trial trial(*field, {0, 0, kPixels, 1}, 1, [](int, int) { return test::Truth{{0, 0, 1}, {}}; });
  for (std::size_t k = 0; k < kLights; ++k) {
    for (int x = 0; x < kPixels; ++x)
      trial.reading(k)(x, 0) = static_cast<float>(pixels[static_cast<std::size_t>(x)][k].reading[0]);
  }
  trial.solve(*solver::fast_method());
  for (int x = 0; x < kPixels; ++x) {
    ours.normals.push_back(trial.normal(x, 0));
    ours.flagged |= (trial.status(x, 0) & (kIllConditioned | kNoSolution)) != 0;
  }
  return ours;
}

}  // namespace

Rows numerics_curve() {
  Rows rows;
  for (double exponent = 0.125; exponent < 8.01; exponent += 0.125) {
    const std::vector<std::vector<PixelRow>> pixels = pixels_at(std::pow(10, exponent));
    const Ours ours = solve_ours(pixels);
    double condition = 0;
    std::array<double, 6> worst = {};
    for (std::size_t x = 0; x < pixels.size(); ++x) {
      const test::OracleSolution exact = test::solve_in_quad(test::oracle_rows(pixels[x], 1));
      condition = exact.condition;
      const auto note = [&](std::size_t method, const std::optional<Vec3>& n) {
        worst[method] = std::max(worst[method], n ? angle_deg(*n, exact.normal) : 180.0);
      };
      note(0, plain_normal<float>(pixels[x]));
      note(1, qr_normal<float>(pixels[x]));
      note(2, svd_normal<float>(pixels[x]));
      note(3, plain_normal<double>(pixels[x]));
      note(4, svd_normal<double>(pixels[x]));
      note(5, ours.normals[x]);
    }
    rows.push_back({{"condition", condition},
                    {"float32_normal_equations_deg", worst[0]},
                    {"float32_qr_deg", worst[1]},
                    {"float32_svd_deg", worst[2]},
                    {"double_normal_equations_deg", worst[3]},
                    {"double_svd_deg", worst[4]},
                    {"ours_deg", worst[5]},
                    {"flagged", ours.flagged}});
  }
  return rows;
}

}  // namespace weft::bench
