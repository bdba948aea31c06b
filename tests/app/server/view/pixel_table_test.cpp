// SPDX-License-Identifier: Apache-2.0
#include "app/server/view/pixel_tables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "app/server/view/probes.h"
#include "app/server/view/viewed_maps.h"
#include "tests/app/server/view/asked_session.h"

namespace weft::app {
namespace {

class AskedSolve : public AskedSession {
 protected:
  static Result<Layers> layers() { return layers_of(maps_); }
  static OpenLayer opener() {
    return [](const Layer& layer) -> Result<std::shared_ptr<Pyramid>> {
      Result<std::unique_ptr<Pyramid>> pyramid = Pyramid::open(maps_, layer, root() / "kept");
      if (!pyramid) return std::move(pyramid).error();
      return std::shared_ptr<Pyramid>(std::move(*pyramid));
    };
  }
};

TEST_F(AskedSolve, ReadingsMinusTheirModelAreTheResidualOfTheMap) {
  const auto table = PixelTable::read(session(), solve_, {});
  ASSERT_TRUE(table) << table.error().message();
  const Result<Layers> layers = AskedSolve::layers();
  ASSERT_TRUE(layers) << layers.error().message();
  const auto residual = opener()(*layers->find("residual"));
  ASSERT_TRUE(residual) << residual.error().message();
  int pixels = 0;
  for (const auto& [x, y] : {std::pair{10, 10}, {101, 55}, {128, 96}, {255, 191}, {30, 170}}) {
    const Json answer = (*table)->at(x, y);
    ASSERT_EQ(answer["readings"].size(), 10U);
    double squares = 0;
    int used = 0;
    for (const Json& reading : answer["readings"]) {
      EXPECT_EQ(reading["used"].get<bool>(), reading["left_out"].is_null());
      if (!reading["used"]) continue;
      const double strength = reading["strength"];
      squares += std::pow((reading["reading"].get<double>() - reading["model"].get<double>()) / strength, 2);
      ++used;
    }
    const double solved = std::sqrt(squares / used) / answer["solved"]["albedo"][0].get<double>();
    const auto map = (*residual)->read(0, {x, y, x + 1, y + 1});
    ASSERT_TRUE(map) << map.error().message();
    EXPECT_NEAR(solved, (*map)(0, 0), 1e-3 * solved + 1e-5) << x << " " << y;
    ++pixels;
  }
  EXPECT_EQ(pixels, 5);
}

TEST_F(AskedSolve, SaysWhyAReadingIsLeftOut) {
  const auto table = PixelTable::read(session(), solve_, {});
  ASSERT_TRUE(table) << table.error().message();
  std::set<std::string> reasons;
  for (int y = 0; y < 192; y += 3) {
    for (int x = 0; x < 256; x += 3) {
      const Json answer = (*table)->at(x, y);
      for (const Json& reading : answer["readings"]) {
        if (reading["left_out"].is_string()) reasons.insert(reading["left_out"]);
      }
    }
  }
  EXPECT_TRUE(reasons.contains("shadowed")) << "of a weave some yarns face away from low lights";
  EXPECT_FALSE(reasons.contains("saturated"));
}

TEST_F(AskedSolve, IsRefusedWhereTheSessionHasChanged) {
  SolveFacts other = solve_;
  other.input->calibration = "another";
  const auto table = PixelTable::read(session(), other, {});
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().kind, ErrorKind::kBadData);
  EXPECT_EQ(table.error().what, "the readings of this solve are no longer there");
}

TEST_F(AskedSolve, MeasuresALineInMillimetresWithItsDeviation) {
  const Result<Layers> layers = AskedSolve::layers();
  ASSERT_TRUE(layers) << layers.error().message();
  Result<Calibration> calibration = read_calibration(session() / "calibration");
  ASSERT_TRUE(calibration) << calibration.error().message();
  // A deviation of one percent in the focal length gives the length one percent.
  const double fx = calibration->camera->fx, sigma = 0.01 * fx;
  calibration->camera_covariance = ParameterCovariance{{"fx"}, {sigma * sigma}};
  const Result<Json> line =
      line_facts(*layers, opener(), {20, 100, 220, 100}, {.calibration = &*calibration});
  ASSERT_TRUE(line) << line.error().message();
  const double each = kMmPerPixel;
  EXPECT_NEAR((*line)["mm"].get<double>(), 200 * each, 1e-6 * each);
  EXPECT_NEAR((*line)["sigma_mm"].get<double>(), 2 * each, 0.02 * each);
  EXPECT_EQ((*line)["profile"]["mm"].size(), 201U);
}

TEST_F(AskedSolve, CountsEveryPixelOfARectangleOnce) {
  const Result<Layers> layers = AskedSolve::layers();
  ASSERT_TRUE(layers) << layers.error().message();
  const Result<Json> facts = region_facts(*layers, opener(), {11, 13, 111, 63});
  ASSERT_TRUE(facts) << facts.error().message();
  EXPECT_EQ((*facts)["level"], 0);
  EXPECT_EQ((*facts)["pixels"], 5000);
  const Json& green = (*facts)["layers"]["albedo"]["G"];
  std::int64_t counted = 0;
  for (const Json& bin : green["bins"]) counted += bin.get<std::int64_t>();
  EXPECT_EQ(counted, 5000);
  EXPECT_LE(green["p5"], green["p50"]);
  EXPECT_LE(green["p50"], green["p95"]);
  EXPECT_EQ((*facts)["status"].size(), kStatusNames.size());
}

}  // namespace
}  // namespace weft::app
