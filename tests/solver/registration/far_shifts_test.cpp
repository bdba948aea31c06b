// SPDX-License-Identifier: Apache-2.0
#include "solver/registration/far_shifts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bench/oracles/oracle_rig.h"
#include "core/base/vec.h"

namespace weft::solver {
namespace {

constexpr Size kPicture = {128, 112};

struct Place {
  double slope_x = 0, slope_y = 0, albedo = 0.5;
};
/// What the cloth is at a point, in pixels.
using ClothAt = std::function<Place(double x, double y)>;

/// A number from -1 to 1 that belongs to a cell of a lattice.
double chance(int x, int y, int of) {
  const double v = std::sin(12.9898 * x + 78.233 * y + 37.719 * of) * 43758.5453;
  return 2 * (v - std::floor(v)) - 1;
}

/// Smooth between the cells' numbers.
double bumps(double x, double y, int of) {
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const double u = x - i, v = y - j, su = u * u * (3 - 2 * u), sv = v * v * (3 - 2 * v);
  const auto row = [&](int at) { return (1 - su) * chance(i, at, of) + su * chance(i + 1, at, of); };
  return (1 - sv) * row(j) + sv * row(j + 1);
}

Place weave(double x, double y) {
  const double u = kPi * x / 6, v = kPi * y / 7;
  return {0.4 * std::cos(u) * std::cos(v / 2) + 0.1 * bumps(x / 3, y / 3, 1),
          0.4 * std::cos(v) * std::cos(u / 2) + 0.1 * bumps(x / 3, y / 3, 2),
          0.5 + 0.1 * bumps(x / 9, y / 9, 3)};
}
Place fleece(double x, double y) {
  return {0.35 * bumps(x / 5, y / 5, 4), 0.35 * bumps(x / 5, y / 5, 5), 0.4};
}
Place print(double x, double y) {
  const double motif = std::sin(x / 7 + 2 * std::sin(y / 23)) * std::sin(y / 9 + std::sin(x / 31));
  return {0.05 * std::cos(kPi * x / 3), 0, 0.45 + (motif > 0.1 ? 0.2 : -0.1)};
}
Place rib(double x, double y) {
  return {0.5 * std::sin(kPi * x / 8 + 0.3 * bumps(x / 20, y / 20, 6)), 0.2 * bumps(x / 4, y / 6, 7),
          0.5 + 0.05 * bumps(x / 2, y / 2, 8)};
}

/// Ten shots, the cloth of each displaced, and what may be wrong with them beside.
struct Shots {
  ClothAt cloth;
  std::vector<std::array<int, 2>> moved = std::vector<std::array<int, 2>>(10);
  std::function<double(double value, std::size_t k)> spoil = [](double v, std::size_t) { return v; };
  std::vector<Vec3> said = {};  // directions, where they are others than the real ones
  double gloss = 0;

  static std::vector<Vec3> lights() {
    std::vector<Vec3> all;
    for (const NearLight& led : test::ten_leds().leds) all.push_back(normalized(led.position_mm));
    return all;
  }
  FarShifts found() const {
    test::Random random(3);
    std::vector<Image<float>> pictures;
    const std::vector<Vec3> real = lights();
    for (std::size_t k = 0; k < real.size(); ++k) {
      Image<float>& picture = pictures.emplace_back(kPicture);
      const Vec3 half = normalized(real[k] + Vec3{0, 0, 1});
      for (int y = 0; y < kPicture.height; ++y) {
        for (int x = 0; x < kPicture.width; ++x) {
          const Place p = cloth(x - moved[k][0], y - moved[k][1]);
          const Vec3 n = normalized({-p.slope_x, p.slope_y, 1});
          const double light =
              p.albedo * std::max(0.0, dot(n, real[k])) + gloss * std::pow(std::max(0.0, dot(n, half)), 40);
          picture(x, y) = static_cast<float>(spoil(light, k) + 0.003 * random.normal());
        }
      }
    }
    return find_far_shifts(pictures, said.empty() ? real : said, 1);
  }
};

std::string words_of(const FarShifts& shifts) {
  std::string words = "explained " + std::to_string(shifts.explained);
  for (const FarShift& s : shifts.shots) {
    words +=
        "; " + std::to_string(s.dx_px) + " " + std::to_string(s.dy_px) + " " + std::to_string(s.explained);
  }
  return words;
}

const std::vector<std::pair<std::string, ClothAt>> kCloths = {
    {"weave", weave}, {"fleece", fleece}, {"print", print}, {"rib", rib}};

TEST(FarShifts, OfOneShotAreFoundToAPixel) {
  for (const auto& [name, cloth] : kCloths) {
    Shots shots = {cloth};
    shots.moved[4] = {23, -11};
    const FarShifts found = shots.found();
    ASSERT_TRUE(found.found) << name << ": " << words_of(found);
    for (std::size_t k = 0; k < 10; ++k) {
      EXPECT_NEAR(found.shots[k].dx_px, shots.moved[k][0], 1) << name << " " << k << ": " << words_of(found);
      EXPECT_NEAR(found.shots[k].dy_px, shots.moved[k][1], 1) << name << " " << k << ": " << words_of(found);
    }
  }
}

TEST(FarShifts, OfAClothThatWasPushedHalfWayAreFound) {
  for (const auto& [name, cloth] : kCloths) {
    Shots shots = {cloth};
    for (std::size_t k = 5; k < 10; ++k) shots.moved[k] = {-14, 17};
    const FarShifts found = shots.found();
    ASSERT_TRUE(found.found) << name << ": " << words_of(found);
    const int dx = found.shots[9].dx_px - found.shots[0].dx_px,
              dy = found.shots[9].dy_px - found.shots[0].dy_px;
    EXPECT_NEAR(dx, -14, 1) << name << ": " << words_of(found);
    EXPECT_NEAR(dy, 17, 1) << name << ": " << words_of(found);
  }
}

TEST(FarShifts, OfAClothThatLayElsewhereInEachShotAreFound) {
  for (const auto& [name, cloth] : kCloths) {
    Shots shots = {cloth};
    for (std::size_t k = 0; k < 10; ++k) {
      shots.moved[k] = {static_cast<int>(15 * chance(static_cast<int>(k), 1, 9)),
                        static_cast<int>(15 * chance(static_cast<int>(k), 2, 9))};
    }
    const FarShifts found = shots.found();
    EXPECT_TRUE(found.found) << name << ": " << words_of(found);
  }
}

TEST(FarShifts, AreNotWhatExplainsSpoiledReadings) {
  const std::vector<Vec3> real = Shots::lights();
  std::vector<Vec3> exchanged = real, by_name = real, below = real;
  for (std::size_t k = 0; k + 1 < real.size(); k += 2) std::swap(exchanged[k], exchanged[k + 1]);
  for (std::size_t k = 1; k < real.size(); ++k) by_name[k] = real[k == 1 ? 9 : k - 1];  // 1, 10, 2, 3 ...
  for (std::size_t k = 1; k < real.size(); k += 2) below[k].z = -below[k].z;
  for (const std::size_t of : {0U, 2U}) {
    const auto& [name, cloth] = kCloths[of];
    const std::vector<std::pair<std::string, Shots>> spoiled = {
        {"still", {cloth}},
        {"gamma",
         {.cloth = cloth,
          .spoil = [](double v, std::size_t) { return std::pow(std::max(v, 0.0), 1 / 2.2); }}},
        {"min is white", {.cloth = cloth, .spoil = [](double v, std::size_t) { return 1 - v; }}},
        {"clipped", {.cloth = cloth, .spoil = [](double v, std::size_t) { return std::min(v, 0.4); }}},
        {"exposures by turns",
         {.cloth = cloth, .spoil = [](double v, std::size_t k) { return k % 2 == 0 ? v : v / 2; }}},
        {"exchanged", {.cloth = cloth, .said = exchanged}},
        {"names sorted 1, 10, 2", {.cloth = cloth, .said = by_name}},
        {"below", {.cloth = cloth, .said = below}},
        {"gloss", {.cloth = cloth, .gloss = 0.5}},
        {"velvet", {.cloth = cloth, .spoil = [](double v, std::size_t) { return 0.02 * v; }}},
    };
    // Every other one of each cloth, for the time that they take.
    for (std::size_t i = of / 2; i < spoiled.size(); i += 2) {
      const auto& [how, shots] = spoiled[i];
      const FarShifts found = shots.found();
      EXPECT_FALSE(found.found) << name << ", " << how << ": " << words_of(found);
    }
  }
}

TEST(FarShifts, NeedFiveLights) {
  std::vector<Image<float>> pictures;
  for (int k = 0; k < 4; ++k) pictures.emplace_back(kPicture);
  EXPECT_FALSE(find_far_shifts(pictures, std::vector<Vec3>(4, Vec3{0, 0, 1}), 1).found);
}

}  // namespace
}  // namespace weft::solver
