// SPDX-License-Identifier: Apache-2.0
// Real photographs, which are no part of the repository: the folder that WEFT_SHARED_DATA names.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/image_io/image_io.h"
#include "solve/correction/leave_out_lights.h"
#include "solve/input/load.h"
#include "solve/input/photo_input.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

class RealPhotographs : public testing::Test {
 protected:
  void find(const std::string& folder) {
    const char* shared = std::getenv("WEFT_SHARED_DATA");
    if (shared == nullptr) GTEST_SKIP() << "WEFT_SHARED_DATA is not set";
    data_ = fs::path(shared) / folder;
    if (!fs::exists(data_)) GTEST_SKIP() << data_ << " is not there";
  }
  Json error_against(const fs::path& truth, const fs::path& mask) const {
    const Outcome run = run_weft({"compare", (work_ / "maps" / "normal.exr").string(), truth.string(),
                                  "--mask", mask.string(), "--json"});
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return run.json();
  }

  Workspace work_;
  fs::path data_;
};

/// The normals of a sphere that fills a mask, seen from afar; zero outside.
Image<float> sphere_in(const LoadedImage& mask) {
  Rect box = {mask.info.size.width, mask.info.size.height, 0, 0};
  for (int y = 0; y < mask.info.size.height; ++y) {
    for (int x = 0; x < mask.info.size.width; ++x) {
      if (!(mask.planes(x, y) > 0.5f)) continue;
      box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x + 1), std::max(box.y1, y + 1)};
    }
  }
  const double cx = (box.x0 + box.x1 - 1) / 2.0, cy = (box.y0 + box.y1 - 1) / 2.0,
               radius = (box.width() + box.height()) / 4.0;
  Image<float> normal(mask.info.size, 3);
  for (int y = 0; y < normal.height(); ++y) {
    for (int x = 0; x < normal.width(); ++x) {
      const double nx = (x - cx) / radius, ny = (cy - y) / radius, zz = 1 - nx * nx - ny * ny;
      if (zz <= 0) continue;
      normal(x, y, 0) = static_cast<float>(nx);
      normal(x, y, 1) = static_cast<float>(ny);
      normal(x, y, 2) = static_cast<float>(std::sqrt(zz));
    }
  }
  return normal;
}

TEST_F(RealPhotographs, TheBallOfDiLiGenTByLeastSquaresIsWhatWasPublished) {
  ASSERT_NO_FATAL_FAILURE(find("diligent_ball"));
  if (IsSkipped()) return;
  const Outcome run = run_weft({"solve", "--photos", data_.string(), "--method", "least-squares", "-o",
                                (work_ / "maps").string(), "--no-previews", "-q"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  // Published for plain least squares with all 96 lights (Shi et al., CVPR 2016): 4.10 degrees.
  const Json error = error_against(data_ / "normal_gt.exr", data_ / "mask.png");
  EXPECT_GT(error["mean_deg"], 4.0) << error;
  EXPECT_LT(error["mean_deg"], 4.4) << error;
}

TEST_F(RealPhotographs, TheGreySphereIsRound) {
  ASSERT_NO_FATAL_FAILURE(find("uw_photos"));
  if (IsSkipped()) return;
  // lights.txt lies in the folder above, and names nothing.
  // These photographs are linear in spite of their eight bits: taken as sRGB the sphere is flatter.
  const Outcome run =
      run_weft({"solve", "--photos", (data_ / "gray").string(), "-o", (work_ / "maps").string(), "--transfer",
                "linear", "--no-previews", "--json", "-q"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const Json assumed = Json::parse(bytes_of(work_ / "maps" / "solve.json"))["assumed"];
  EXPECT_EQ(assumed, Json::array({"lights are those of lights.txt in uw_photos",
                                  "photographs are in the order of their names, gray.0.png to gray.11.png",
                                  "12 photographs of 512 x 340, 8 bits, taken as linear by --transfer"}));

  const fs::path mask_file = data_ / "gray" / "gray.mask.png";
  const Result<LoadedImage> mask = read_image(mask_file);
  ASSERT_TRUE(mask) << mask.error().message();
  const Image<float> sphere = sphere_in(*mask);
  const std::array<View<const float>, 3> planes = {sphere.plane(0), sphere.plane(1), sphere.plane(2)};
  ASSERT_TRUE(write_image(work_ / "sphere.exr", planes, {"X", "Y", "Z"}, {}));
  const Json error = error_against(work_ / "sphere.exr", mask_file);
  EXPECT_LT(error["mean_deg"], 10) << error;
}

TEST_F(RealPhotographs, TheLampsOfAChromeBallAreFoundInTheDark) {
  ASSERT_NO_FATAL_FAILURE(find("uw_photos"));
  if (IsSkipped()) return;
  const Outcome run = run_weft({"lights", (data_ / "chrome").string(), "--ball", "--transfer", "linear",
                                "--json", "-o", (work_ / "chrome.lp").string()});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const Json told = run.json();
  // The mask that comes with the photographs is a disc about 253.3, 147.8 of 119.5 pixels.
  ASSERT_EQ(told["balls"].size(), 1U) << told;
  EXPECT_NEAR(told["balls"][0]["x"].get<double>(), 253.3, 1.5);
  EXPECT_NEAR(told["balls"][0]["y"].get<double>(), 147.8, 1.5);
  EXPECT_NEAR(told["balls"][0]["radius"].get<double>(), 119.5, 1.5);
  // Centroids of all that is bright within that mask miss lights.txt by a median of 2.2 degrees too.
  std::ifstream lights(data_ / "lights.txt");
  int count = 0;
  lights >> count;
  std::vector<double> off;
  for (int k = 0; k < count; ++k) {
    Vec3 truth;
    lights >> truth.x >> truth.y >> truth.z;
    const std::string name = "chrome." + std::to_string(k) + ".png";
    for (const Json& light : told["lights"]) {
      if (!light["photograph"].get<std::string>().ends_with("/" + name)) continue;
      const Json& d = light["direction"];
      off.push_back(angle_deg({d[0], d[1], d[2]}, truth));
    }
  }
  ASSERT_EQ(off.size(), 12U);
  std::ranges::sort(off);
  EXPECT_LT(off[6], 2.2) << "median of all, degrees";
}

TEST_F(RealPhotographs, OfMattObjectsLeaveRobustNoBlockThatStandardPredictsBetter) {
  ASSERT_NO_FATAL_FAILURE(find("harvard_dev"));
  if (IsSkipped()) return;
  for (const char* object : {"frog", "turtle"}) {
    solve::PhotoOptions options;
    options.folder = data_ / object;
    options.reading.transfer = Transfer::kLinear;
    const Result<solve::SolvePlan> plan = solve::plan_photos(options);
    ASSERT_TRUE(plan) << plan.error().message();
    const Result<solve::Photographs> photographs = solve::load_photographs(*plan, {});
    ASSERT_TRUE(photographs) << photographs.error().message();
    const auto standard = solver::standard_method(), robust = solver::robust_method();
    Result<solver::BlockChoice> choice =
        solve::choose_by_block(*photographs, {.method = standard.get()}, {.method = robust.get()}, {});
    ASSERT_TRUE(choice) << choice.error().message();
    const auto chosen = solver::blended_method(*standard, *robust, *choice);
    const auto median = [&](const solver::Method& method) {
      return error_of_all(*solve::leave_out_lights(
                              *photographs, {.method = &method},
                              solver::patches_of(photographs->size, solver::PatchUse::kReport), {}))
          .median;
    };
    const double by_standard = median(*standard), by_robust = median(*robust), by_block = median(*chosen);
    EXPECT_GT(by_robust, 1.2 * by_standard) << object;
    EXPECT_LE(by_block, 1.02 * by_standard) << object << ": robust alone has " << by_robust;
  }
}

}  // namespace
}  // namespace weft::test
