// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "solver/frame_fit/cell_fit.h"
#include "solver/frame_fit/frame_misfit.h"
#include "solver/frame_fit/room_light.h"
#include "solver/frame_fit/row_waves.h"
#include "solver/frame_fit/tilt_law.h"

namespace weft::solver {
namespace {

constexpr int kColumns = 32, kRows = 120;
constexpr std::size_t kLights = 10;
constexpr double kNoise = 0.004;

// Cloth of albedo 0.3 to 0.5 under two rings of five lights, with noise; `gloss` is of a lobe seen from
// above.
template <typename NormalAt>
FrameCells cloth_with(const NormalAt& normal_at, double gloss) {
  FrameCells cells;
  cells.columns = kColumns;
  cells.rows = kRows;
  cells.count = kLights;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, kNoise);
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      const Vec3 normal = normalized(normal_at(x, y));
      const double albedo = 0.4 + 0.1 * std::sin(0.37 * x * y);
      for (std::size_t k = 0; k < kLights; ++k) {
        const double turn = 2 * kPi * static_cast<double>(k % 5) / 5 + (k < 5 ? 0 : 0.6);
        const double height = radians(k < 5 ? 35 : 60);
        const Vec3 light = {std::cos(turn) * std::cos(height), std::sin(turn) * std::cos(height),
                            std::sin(height)};
        cells.direction.push_back(light);
        cells.strength.push_back(k < 5 ? 1.0F : 1.4F);
        const double lobe = gloss * std::pow(dot(normal, normalized(light + Vec3{0, 0, 1})), 30);
        cells.value.push_back(
            static_cast<float>(albedo * (std::max(0.0, dot(normal, light)) + noise(random)) + lobe));
      }
    }
  }
  return cells;
}

// Smooth waves with slopes up to 0.3.
FrameCells waves_of_cloth(double gloss = 0) {
  return cloth_with(
      [](int x, int y) {
        return Vec3{0.3 * std::sin(1.3 * x + 0.4 * y), 0.3 * std::cos(0.9 * y - 0.5 * x), 1};
      },
      gloss);
}

template <typename Change>
FrameCells changed(FrameCells cells, std::size_t light, const Change& change) {
  for (std::size_t cell = 0; cell < cells.cells(); ++cell) {
    float& value = cells.value[cell * kLights + light];
    value = static_cast<float>(change(static_cast<int>(cell) % kColumns, static_cast<int>(cell) / kColumns,
                                      static_cast<double>(value)));
  }
  return cells;
}

// Light of `share` of each cell's mean reading more in every photograph.
FrameCells in_a_lit_room(FrameCells cells, double share) {
  for (std::size_t cell = 0; cell < cells.cells(); ++cell) {
    double mean = 0;
    for (std::size_t k = 0; k < kLights; ++k)
      mean +=
          static_cast<double>(cells.value[cell * kLights + k] * cells.strength[cell * kLights + k]) / kLights;
    for (std::size_t k = 0; k < kLights; ++k)
      cells.value[cell * kLights + k] +=
          static_cast<float>(share * mean) / cells.strength[cell * kLights + k];
  }
  return cells;
}

RoomShare room_of(const FrameCells& cells) {
  const CellFit fit = fit_cells(cells, 1);
  return find_room_light(cells, fit, frame_misfits(cells, fit, 1), kNoise);
}

TEST(FrameFit, SaysNothingOfPhotographsThatFit) {
  const FrameCells cells = waves_of_cloth();
  const CellFit fit = fit_cells(cells, 1);
  for (const FrameMisfit& misfit : frame_misfits(cells, fit, 1)) {
    EXPECT_FALSE(misfit.is_wrong()) << misfit.missed;
    EXPECT_NEAR(misfit.gain, 1, 0.005);
  }
  EXPECT_FALSE(find_row_waves(cells, fit, {}, 1));
  EXPECT_FALSE(room_of(cells).is_told()) << room_of(cells).share;
}

TEST(FrameFit, TellsLightOfTheRoomByItsShareOfTheMeanReading) {
  for (const double share : {0.02, 0.1, 0.3}) {
    const RoomShare room = room_of(in_a_lit_room(waves_of_cloth(), share));
    EXPECT_TRUE(room.is_told()) << room.share << " of " << share << ", sigma " << room.sigma;
    EXPECT_NEAR(room.share, share / (1 + share), 0.1 * share);
  }
}

TEST(FrameFit, TellsTheLightOfADarkShotThatTheFramesLack) {
  const RoomShare room = room_of(in_a_lit_room(waves_of_cloth(), -0.05));
  EXPECT_TRUE(room.is_told());
  EXPECT_NEAR(room.share, -0.05 / 0.95, 0.005);
}

TEST(FrameFit, NoGainOfALampIsLightOfTheRoom) {
  FrameCells cells = waves_of_cloth();
  for (std::size_t k = 0; k < kLights; k += 3)
    cells = changed(std::move(cells), k, [](int, int, double value) { return 1.02 * value; });
  EXPECT_FALSE(room_of(cells).is_told()) << room_of(cells).share;
}

TEST(FrameFit, TakesAGainForNoMisfit) {
  const FrameCells cells = changed(waves_of_cloth(), 4, [](int, int, double value) { return 0.7 * value; });
  const std::vector<FrameMisfit> misfits = frame_misfits(cells, fit_cells(cells, 1), 1);
  EXPECT_NEAR(misfits[4].gain, 0.7, 0.01);
  EXPECT_FALSE(misfits[4].is_wrong()) << misfits[4].missed;
}

TEST(FrameFit, NamesAPhotographThatFitsNothingAndWhy) {
  const FrameCells right = waves_of_cloth();
  const auto at = [&](int x, int y, std::size_t k) {
    return static_cast<double>(right.value[static_cast<std::size_t>(y * kColumns + x) * kLights + k]);
  };
  const FrameCells copy = changed(right, 3, [&](int x, int y, double) { return at(x, y, 1); });
  const FrameMisfit copied = frame_misfits(copy, fit_cells(copy, 1), 1)[3];
  EXPECT_TRUE(copied.fits_nothing) << copied.missed;
  EXPECT_EQ(copied.same_as, 1U);

  const FrameCells turn =
      changed(right, 3, [&](int x, int y, double) { return at(kColumns - 1 - x, kRows - 1 - y, 3); });
  const std::vector<FrameMisfit> turned = frame_misfits(turn, fit_cells(turn, 1), 1);
  EXPECT_TRUE(turned[3].fits_nothing) << turned[3].missed;
  EXPECT_TRUE(turned[3].is_turned);
  for (std::size_t k = 0; k < kLights; ++k) EXPECT_EQ(turned[k].fits_nothing, k == 3) << k;
}

TEST(FrameFit, NamesACopyAndATurnedPhotographOfClothThatNothingFits) {
  const FrameCells right = waves_of_cloth(0.5);
  const std::vector<FrameMisfit> clean = frame_misfits(right, fit_cells(right, 1), 1);
  for (std::size_t k = 0; k < kLights; ++k) EXPECT_FALSE(clean[k].is_wrong()) << k << ": " << clean[k].missed;
  ASSERT_GT(clean[0].typical, kMissedFrom) << "it shines";
  const auto at = [&](int x, int y, std::size_t k) {
    return static_cast<double>(right.value[static_cast<std::size_t>(y * kColumns + x) * kLights + k]);
  };
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.4 * kNoise);
  const FrameCells copy =
      changed(right, 3, [&](int x, int y, double) { return at(x, y, 4) + noise(random); });
  const FrameMisfit copied = frame_misfits(copy, fit_cells(copy, 1), 1)[3];
  EXPECT_TRUE(copied.fits_nothing) << copied.missed << " of " << copied.typical;
  EXPECT_EQ(copied.same_as, 4U);
  const FrameCells turn =
      changed(right, 3, [&](int x, int y, double) { return at(kColumns - 1 - x, kRows - 1 - y, 3); });
  EXPECT_TRUE(frame_misfits(turn, fit_cells(turn, 1), 1)[3].is_turned);
}

TEST(FrameFit, NamesThePartThatAHandHides) {
  const FrameCells cells = changed(waves_of_cloth(), 6, [](int x, int y, double value) {
    return x < 12 && y >= 80 ? 0.2 * value : value;
  });
  const FrameMisfit misfit = frame_misfits(cells, fit_cells(cells, 1), 1)[6];
  ASSERT_TRUE(misfit.part);
  EXPECT_FALSE(misfit.fits_nothing);
  EXPECT_LE(misfit.part->x0, 0);
  EXPECT_GE(misfit.part->x1, 12);
  EXPECT_LE(misfit.part->y0, 80);
  EXPECT_EQ(misfit.part->y1, kRows);
  EXPECT_NEAR(misfit.part_share, 0.125, 0.03);
}

// A lobe that all of a nearly level cloth shows to one light, and to the one beside it, and that no other
// sees.
FrameCells ribs_in_a_highlight(double slope) {
  FrameCells cells = cloth_with(
      [&](int x, int y) {
        return Vec3{0.02 * std::sin(1.3 * x), slope * std::sin(2 * kPi * y / 11.0), 1};
      },
      0);
  for (std::size_t cell = 0; cell < cells.cells(); ++cell) {
    const int y = static_cast<int>(cell) / kColumns;
    const double tilt = slope * std::sin(2 * kPi * y / 11.0);
    for (const std::size_t k : {2U, 3U})
      cells.value[cell * kLights + k] +=
          static_cast<float>(0.8 * std::exp(-std::pow((tilt + (k == 2 ? 0.05 : -0.1)) / 0.3, 2)));
  }
  return cells;
}

TEST(FrameFit, AccusesNoPhotographInWhoseHighlightAllOfTheClothLies) {
  const FrameCells cells = ribs_in_a_highlight(0.2);
  const CellFit fit = fit_cells(cells, 1);
  const std::vector<FrameMisfit> misfits = frame_misfits(cells, fit, 1);
  ASSERT_GT(misfits[2].missed, 0.2) << "Lambert's law is far off";
  for (std::size_t k = 0; k < kLights; ++k)
    EXPECT_FALSE(misfits[k].is_wrong()) << k << ": " << misfits[k].missed;
  // The same light on another cloth is no function of how this one leans.
  const FrameCells other = changed(cells, 2, [&](int x, int y, double) {
    return static_cast<double>(
        cells.value[static_cast<std::size_t>((y + 31) % kRows * kColumns + x) * kLights + 2]);
  });
  EXPECT_TRUE(frame_misfits(other, fit_cells(other, 1), 1)[2].fits_nothing);
}

TEST(FrameFit, TakesAHighlightForNoPartThatAHandHides) {
  const FrameCells cells = changed(waves_of_cloth(), 6, [](int x, int y, double value) {
    return x < 12 && y >= 80 ? value + 0.3 : value;
  });
  EXPECT_FALSE(frame_misfits(cells, fit_cells(cells, 1), 1)[6].part);
}

TEST(FrameFit, NamesThePartThatAHandHidesOfClothThatShines) {
  const FrameCells cells = changed(waves_of_cloth(0.5), 6, [](int x, int y, double value) {
    return x < 12 && y >= 80 ? 0.2 * value : value;
  });
  const std::vector<FrameMisfit> misfits = frame_misfits(cells, fit_cells(cells, 1), 1);
  ASSERT_GT(misfits[0].typical, kMissedFrom) << "it shines";
  for (std::size_t k = 0; k < kLights; ++k) EXPECT_EQ(misfits[k].part.has_value(), k == 6) << k;
}

TEST(FrameFit, WhatLeansAsAFunctionOfTiltLeavesNoErrorByTilt) {
  const FrameCells cells = waves_of_cloth(0.5);
  const CellFit fit = fit_cells(cells, 1);
  const auto rms = [](const std::vector<float>& errors) {
    double squares = 0, count = 0;
    for (const float error : errors) {
      if (std::isfinite(error)) squares += std::pow(static_cast<double>(error), 2), ++count;
    }
    return std::sqrt(squares / count);
  };
  const double of_cloth = rms(errors_by_tilt(cells, fit, 2));
  const FrameCells other =
      changed(cells, 2, [](int x, int y, double) { return 0.3 + 0.2 * std::sin(0.31 * x * x + 0.17 * y); });
  const double of_another = rms(errors_by_tilt(other, fit, 2));
  EXPECT_LT(of_cloth, 0.25 * of_another) << of_cloth << " and " << of_another;
}

TEST(FrameFit, ClothThatShinesIsNoLightOfTheRoom) {
  for (const double gloss : {0.05, 0.1, 0.2}) {
    const RoomShare room = room_of(waves_of_cloth(gloss));
    EXPECT_FALSE(room.is_told()) << room.share << " of gloss " << gloss << ", by tilt " << room.by_tilt;
  }
}

TEST(FrameFit, EvensOutLightThatFlickersAlongRows) {
  constexpr double kPeriod = 21.3, kAmplitude = 0.06;
  FrameCells cells = waves_of_cloth();
  const CellFit truth = fit_cells(cells, 1);
  for (std::size_t k = 0; k < kLights; ++k) {
    cells = changed(std::move(cells), k, [&](int, int y, double value) {
      return value * (1 + kAmplitude * std::sin(2 * kPi * y / kPeriod + 2.4 * static_cast<double>(k * k)));
    });
  }
  const CellFit fit = fit_cells(cells, 1);
  const std::optional<RowWaves> waves = find_row_waves(cells, fit, {}, 1);
  ASSERT_TRUE(waves);
  EXPECT_TRUE(waves->are_even);
  EXPECT_NEAR(waves->period_rows, kPeriod, 0.2);
  FrameCells even = cells;
  for (std::size_t k = 0; k < kLights; ++k) {
    EXPECT_NEAR(waves->amplitude[k], kAmplitude, 0.25 * kAmplitude) << k;
    even = changed(std::move(even), k, [&](int, int y, double value) {
      return value / static_cast<double>(waves->gain[k][static_cast<std::size_t>(y)]);
    });
  }
  const double before = change_of(truth, fit).turned_deg,
               after = change_of(truth, fit_cells(even, 1)).turned_deg;
  EXPECT_LT(after, 0.3 * before) << before << " degrees before, " << after << " after";
}

TEST(FrameFit, TellsOneLampThatFlickersOverALevelCard) {
  const FrameCells cells =
      changed(cloth_with(
                  [](int, int) {
                    return Vec3{0.05, 0.02, 1};
                  },
                  0),
              4, [](int, int y, double value) { return value * (1 + 0.05 * std::sin(2 * kPi * y / 17.0)); });
  const std::optional<RowWaves> waves = find_row_waves(cells, fit_cells(cells, 1), {}, 1);
  ASSERT_TRUE(waves);
  EXPECT_NEAR(waves->period_rows, 17, 0.2);
}

// Yarns along the rows shine, each alike from end to end.
TEST(FrameFit, TakesNoWeaveAlongTheRowsForFlicker) {
  constexpr double kPitch = 9;
  const FrameCells cells = cloth_with(
      [](int x, int y) {
        return Vec3{0.1 * std::sin(1.3 * x), 0.35 * std::sin(2 * kPi * y / kPitch), 1};
      },
      0.2);
  const CellFit fit = fit_cells(cells, 1);
  const std::optional<RowWaves> waves = find_row_waves(cells, fit, {}, 1);
  EXPECT_FALSE(waves) << "a period of " << waves->period_rows << " rows";
}

}  // namespace
}  // namespace weft::solver
