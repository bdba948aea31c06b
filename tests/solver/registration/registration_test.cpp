// SPDX-License-Identifier: Apache-2.0
#include "solver/registration/registration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <vector>

#include "bench/oracles/oracle_rig.h"
#include "core/base/vec.h"
#include "solver/sample_tiles.h"

namespace weft::solver {
namespace {

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

// The ten LEDs of a rig, or a dome: each light a golden angle from the one before, down to 65 degrees.
DistantLights distant_lights(int count) {
  DistantLights distant;
  for (const NearLight& led : test::ten_leds().leds) {
    if (distant.lights.size() == static_cast<std::size_t>(count) || count > 10) break;
    distant.lights.push_back({normalized(led.position_mm), {0.5, 1, 0.7}});
  }
  for (int k = 0; k < count && count > 10; ++k) {
    const double z = 1 - 0.58 * (k + 0.5) / count, r = std::sqrt(1 - z * z), turn = 2.39996 * k;
    distant.lights.push_back({{r * std::cos(turn), r * std::sin(turn), z}, {0.5, 1, 0.7}});
  }
  return distant;
}

// Shots of it under distant lights, each with the cloth elsewhere, and what is measured.
struct Scan {
  std::vector<ClothShift> shifts;
  NoiseModel noise = kNoise;
  int planes = 1;
  int lights = 10;
  Size size = {384, 256};
  double* cpu_s = nullptr;  // that register_shots() took, on one thread

  Registration of(const Cloth& cloth, int threads = 1) const {
    const LightField field = *LightField::make(distant_lights(lights), std::nullopt, size, 0);
    const CfaPattern cfa;
    test::Random random(11);
    Image<float> readings(size, lights * planes);
    for (int k = 0; k < lights; ++k) {
      const ClothShift shift = shifts.empty() ? ClothShift() : shifts[static_cast<std::size_t>(k)];
      for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
          const double px = x - size.width / 2.0, py = y - size.height / 2.0;
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
    for (const Rect& tile : sample_tiles(size)) {
      views.emplace_back();
      for (int i = 0; i < readings.planes(); ++i) views.back().push_back(readings.plane(i).crop(tile));
    }
    for (std::size_t i = 0; i < views.size(); ++i) {
      tiles.push_back({sample_tiles(size)[i], planes, cfa, views[i], &field,
                       planes == 1 ? std::optional(noise) : std::nullopt});
    }
    const std::clock_t begin = std::clock();
    Registration found = register_shots(tiles, size, threads);
    if (cpu_s != nullptr) *cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    return found;
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

// A dome in which one shot, or every third, was taken after the cloth was touched.
TEST(Registration, FindsAThirdOfAPixelInOneOrAThirdOfFortyShots) {
  for (const int every : {40, 3}) {
    std::vector<ClothShift> truth(40);
    for (std::size_t k = 2; k < truth.size(); k += static_cast<std::size_t>(every))
      truth[k] = {0.3, -0.2, 1e-3};
    Scan scan{truth};
    scan.lights = 40;
    scan.size = {256, 256};
    const Registration found = scan.of({});
    EXPECT_TRUE(found.found);
    EXPECT_LT(worst_px(found, truth), 0.05) << "every " << every;
    for (std::size_t k = 0; k < truth.size(); ++k) {
      EXPECT_EQ(found.shots[k].significant, !(truth[k] == ClothShift())) << k << " of every " << every;
      EXPECT_LT(found.shots[k].sigma_px, 0.1) << k;
    }
  }
}

TEST(Registration, LeavesFortyShotsThatHaveNotMovedAndTheirErrorCoversWhatItFinds) {
  Scan scan;
  scan.lights = 40;
  scan.size = {256, 256};
  double square = 0, variance = 0;
  for (const ShotRegistration& s : scan.of({}).shots) {
    EXPECT_FALSE(s.significant) << s.shift.dx_px << ", " << s.shift.dy_px;
    square += s.shift.dx_px * s.shift.dx_px + s.shift.dy_px * s.shift.dy_px;
    variance += 2 * s.sigma_px * s.sigma_px;
  }
  EXPECT_LT(square, 4 * variance);
}

// Both ways of solving, over the count at which one gives way to the other.
TEST(Registration, SaysTheSameOfOneShotMoreThanAreSolvedTogether) {
  std::array<ShotRegistration, 2> moved;
  for (const int more : {0, 1}) {
    Scan scan{std::vector<ClothShift>(static_cast<std::size_t>(kMostTogether + more))};
    scan.lights = kMostTogether + more;
    scan.size = {256, 256};
    scan.shifts[7] = {0.4, -0.3, 0};
    moved[static_cast<std::size_t>(more)] = scan.of({}).shots[7];
  }
  EXPECT_NEAR(moved[0].shift.dx_px, moved[1].shift.dx_px, 0.02);
  EXPECT_NEAR(moved[0].shift.dy_px, moved[1].shift.dy_px, 0.02);
  EXPECT_NEAR(moved[0].sigma_px / moved[1].sigma_px, 1, 0.2);
  EXPECT_NEAR(moved[0].cost_deg / moved[1].cost_deg, 1, 0.2);
}

TEST(Registration, TakesAsMuchMoreTimeAsThereAreMoreLights) {
  std::array<double, 2> took_s = {};
  for (const int times : {1, 4}) {
    Scan scan;
    scan.lights = 50 * times;
    scan.size = {176, 176};
    scan.cpu_s = &took_s[times == 4];
    scan.of({});
  }
  EXPECT_LT(took_s[1] / took_s[0], 10) << took_s[0] << " s for 50 lights, " << took_s[1] << " s for 200";
}

TEST(Registration, GivesTheSameNumbersForAnyThreads) {
  const Scan scan{one_moved({0.4, -0.3, 0})};
  const Registration one = scan.of({}, 1), two = scan.of({}, 2);
  for (std::size_t k = 0; k < 10; ++k) EXPECT_EQ(one.shots[k].shift, two.shots[k].shift);
}

}  // namespace
}  // namespace weft::solver
