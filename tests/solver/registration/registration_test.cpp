// SPDX-License-Identifier: Apache-2.0
#include "solver/registration/registration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "bench/oracles/rig.h"
#include "core/vec.h"
#include "solver/sample_tiles.h"

namespace weft::solver {
namespace {

constexpr Size kShotSize = {384, 256};
const NoiseModel kNoise = {4e-5, 1e-9, 0};

// Cloth in closed form: height slopes and albedo at a point in pixels from the frame's centre.
struct Cloth {
  double slope = 0.4;     // steepest, of yarns
  double pitch_px = 12;   // of a yarn
  double contrast = 0.3;  // of the albedo, between places
};

test::Truth truth_of(const Cloth& c, double x, double y) {
  const double u = 2 * kPi * x / c.pitch_px, v = 2 * kPi * y / (1.1 * c.pitch_px);
  const Vec3 n =
      normalized({c.slope * std::cos(u) * std::cos(v / 2), c.slope * std::cos(v) * std::cos(u / 2), 1});
  const double rho = 0.5 * (1 + c.contrast * std::sin(u / 3 + v / 4) * std::cos(v / 3 - u / 5));
  return {n, {rho, rho, rho}};
}

// Ten shots of it under ten distant LEDs, each with the cloth elsewhere, and what is measured.
struct Scan {
  std::vector<ClothShift> shifts;
  NoiseModel noise = kNoise;
  int planes = 1;
  int lights = 10;

  Registration of(const Cloth& cloth, int threads = 1) const {
    DistantLights distant;
    for (const NearLight& led : test::ten_leds().leds) {
      if (distant.lights.size() == static_cast<std::size_t>(lights)) break;
      distant.lights.push_back({normalized(led.position_mm), {0.5, 1, 0.7}});
    }
    const LightField field = *LightField::make(distant, std::nullopt, kShotSize, 0);
    const CfaPattern cfa;
    test::Random random(11);
    Image<float> readings(kShotSize, lights * planes);
    for (int k = 0; k < lights; ++k) {
      const ClothShift shift = shifts.empty() ? ClothShift() : shifts[static_cast<std::size_t>(k)];
      for (int y = 0; y < kShotSize.height; ++y) {
        for (int x = 0; x < kShotSize.width; ++x) {
          const double px = x - kShotSize.width / 2.0, py = y - kShotSize.height / 2.0;
          const ClothShift::Displacement d = shift.at(px, py);
          const test::Truth t = truth_of(cloth, px - d.x, py - d.y);
          for (int p = 0; p < planes; ++p) {
            const int c = planes == 1 ? cfa.channel_at(x, y) : p;
            const LightField::Light light = field.at(static_cast<std::size_t>(k), c, x, y);
            const double r = t.albedo[0] * light.strength * std::max(0.0, dot(t.normal, light.direction));
            readings(x, y, k * planes + p) =
                static_cast<float>(r + std::sqrt(noise.variance(r)) * random.normal());
          }
        }
      }
    }
    std::vector<std::vector<View<const float>>> views;
    std::vector<TileInput> tiles;
    for (const Rect& tile : sample_tiles(kShotSize)) {
      views.emplace_back();
      for (int i = 0; i < readings.planes(); ++i) views.back().push_back(readings.plane(i).crop(tile));
    }
    for (std::size_t i = 0; i < views.size(); ++i) {
      tiles.push_back({sample_tiles(kShotSize)[i], planes, cfa, views[i], &field,
                       planes == 1 ? std::optional(noise) : std::nullopt});
    }
    return register_shots(tiles, kShotSize, threads);
  }
};

// One shot has moved, and turned, against nine.
std::vector<ClothShift> one_moved(const ClothShift& shift) {
  std::vector<ClothShift> all(10);
  all[6] = shift;
  return all;
}

double worst_px(const Registration& r, const std::vector<ClothShift>& truth) {
  double worst = 0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    worst = std::max({worst, std::abs(r.shots[k].shift.dx_px - truth[k].dx_px),
                      std::abs(r.shots[k].shift.dy_px - truth[k].dy_px)});
  }
  return worst;
}

TEST(Registration, FindsHalfAPixelInOneShotOfTenToATwentieth) {
  for (const Cloth& cloth : {Cloth{0.15, 12, 0}, Cloth{0.4, 12, 0.3}, Cloth{0.4, 7, 0.3}}) {
    const std::vector<ClothShift> truth = one_moved({0.4, -0.3, 0});
    const Registration found = Scan{truth}.of(cloth);
    EXPECT_TRUE(found.found);
    EXPECT_LT(worst_px(found, truth), 0.05) << "slope " << cloth.slope << ", pitch " << cloth.pitch_px;
    EXPECT_TRUE(found.shots[6].significant);
    EXPECT_FALSE(found.shots[2].significant);
  }
}

TEST(Registration, FindsShiftsOfRgbPhotographs) {
  const std::vector<ClothShift> truth = one_moved({0.4, -0.3, 0});
  Scan scan{truth};
  scan.planes = 3;
  EXPECT_LT(worst_px(scan.of({}), truth), 0.05);
}

TEST(Registration, FindsATurn) {
  const std::vector<ClothShift> truth = one_moved({0.2, 0.1, 2e-3});
  const Registration found = Scan{truth}.of({});
  EXPECT_LT(worst_px(found, truth), 0.05);
  EXPECT_NEAR(found.shots[6].shift.turn, 2e-3, 3e-4);
}

TEST(Registration, LeavesWhatHasNotMovedAndItsErrorCoversWhatItFinds) {
  const Registration still = Scan{}.of({});
  double square = 0, variance = 0;
  for (const ShotRegistration& s : still.shots) {
    EXPECT_FALSE(s.significant) << s.shift.dx_px << ", " << s.shift.dy_px;
    square += s.shift.dx_px * s.shift.dx_px + s.shift.dy_px * s.shift.dy_px;
    variance += 2 * s.sigma_px * s.sigma_px;
  }
  EXPECT_LT(square, 4 * variance);
  EXPECT_LT(still.shots[0].sigma_px, 0.05);
}

TEST(Registration, CannotTellOfAFlatGreyCard) {
  const Registration card = Scan{one_moved({0.5, 0, 0})}.of({0, 12, 0});
  for (const ShotRegistration& s : card.shots) {
    EXPECT_GT(s.sigma_px, 1) << s.sigma_px;
    EXPECT_TRUE(std::isfinite(s.sigma_px) && std::isfinite(s.shift.dx_px) && std::isfinite(s.cost_deg));
    EXPECT_FALSE(s.significant);
  }
}

TEST(Registration, CannotTellFromThreeLights) {
  Scan scan;
  scan.lights = 3;
  for (const ShotRegistration& s : scan.of({}).shots) {
    EXPECT_GT(s.sigma_px, 1);
    EXPECT_FALSE(s.significant);
  }
}

TEST(Registration, GrowsItsCostWithTheShiftAndPricesHalfAPixelByItsSlopes) {
  const double half = Scan{one_moved({0.5, 0, 0})}.of({}).shots[6].cost_deg;
  const double quarter = Scan{one_moved({0.25, 0, 0})}.of({}).shots[6].cost_deg;
  EXPECT_NEAR(half / quarter, 2, 0.2) << half << " and " << quarter << " degrees";
}

TEST(Registration, GivesTheSameNumbersForAnyThreads) {
  const Scan scan{one_moved({0.4, -0.3, 0})};
  const Registration one = scan.of({}, 1), two = scan.of({}, 2);
  for (std::size_t k = 0; k < 10; ++k) EXPECT_EQ(one.shots[k].shift, two.shots[k].shift);
}

}  // namespace
}  // namespace weft::solver
