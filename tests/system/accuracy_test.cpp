// SPDX-License-Identifier: Apache-2.0
// From photographs on disk to maps on disk, against the truth.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

class Accuracy : public testing::Test {
 protected:
  /// Solves and returns what `weft compare --json` says of the maps.
  Json solve(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "solve");
    for (const char* more : {"-q", "--json", "-o"}) arguments.emplace_back(more);
    arguments.push_back((work_ / "maps").string());
    const Outcome run = run_weft(arguments, {.folder = work_.path()});
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return run.json();
  }
  Json compare(const std::string& map, const fs::path& truth) {
    std::vector<std::string> arguments = {"compare", (work_ / "maps" / map).string(), truth.string(),
                                          "--json"};
    if (map == "albedo.exr") arguments.insert(arguments.end(), {"--kind", "albedo"});
    const Outcome run = run_weft(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return run.json();
  }
  Json normal_error() { return compare("normal.exr", session_ / "truth" / "normal.exr"); }
  Json albedo_error() { return compare("albedo.exr", session_ / "truth" / "albedo.exr"); }

  Workspace work_;
  const fs::path session_ = work_ / "cloth.weft";
};

constexpr Size kSmall = {128, 96};

TEST_F(Accuracy, OfAFlatGreyCardFromRawIsBoundByTheCounts) {
  simulate(scene_named("flat", kSmall), session_);
  const Json solved = solve({session_.string()});
  EXPECT_EQ(solved["pixels"], kSmall.pixels());
  EXPECT_EQ(solved["albedo_scale"], "absolute");
  const Json normal = normal_error();
  EXPECT_EQ(normal["pixels"], kSmall.pixels());
  EXPECT_LT(normal["mean_deg"], 0.01) << normal;
  EXPECT_LT(normal["max_deg"], 0.05) << normal;
  EXPECT_LT(albedo_error()["mean_rel"], 3e-4) << albedo_error();
}

TEST_F(Accuracy, OfATiltedCardFromRawIsBoundByTheCounts) {
  simulate(scene_named("tilted", kSmall), session_);
  solve({session_.string()});
  const Json normal = normal_error();
  EXPECT_LT(normal["mean_deg"], 0.01) << normal;
  EXPECT_LT(normal["max_deg"], 0.05) << normal;
  EXPECT_LT(albedo_error()["mean_rel"], 3e-4) << albedo_error();
}

TEST_F(Accuracy, OfEveryMethodOnAFlatCard) {
  simulate(scene_named("flat", kSmall), session_);
  for (const char* method : {"seed", "least-squares"}) {
    solve({session_.string(), "--method", method});
    EXPECT_LT(normal_error()["mean_deg"], 0.01) << method << normal_error();
    fs::remove_all(work_ / "maps");
  }
}

TEST_F(Accuracy, OfANoisyTwillIsThatOfItsPhotons) {
  simulate(scene_named("golden", {256, 256}), session_);
  solve({session_.string()});
  const Json normal = normal_error(), albedo = albedo_error();
  EXPECT_LT(normal["mean_deg"], 0.4) << normal;
  EXPECT_LT(normal["p95_deg"], 0.9) << normal;
  // Albedo is interpolated between photosites, and the yarns are twelve pixels wide.
  EXPECT_LT(albedo["mean_rel"], 0.06) << albedo;
  EXPECT_LT(std::abs(albedo["bias_rel"].get<double>()), 0.015) << albedo;
}

TEST_F(Accuracy, OfFloatExrFramesIsThatOfTheArithmetic) {
  simulate_developed(scene_named("tilted", kSmall), session_, ".exr", SampleType::kFloat);
  solve({session_.string()});
  EXPECT_LT(normal_error()["max_deg"], 1e-3) << normal_error();
  EXPECT_LT(albedo_error()["mean_rel"], 5e-4) << albedo_error();  // half floats
}

TEST_F(Accuracy, OfLinearTiffFramesIsBoundByTheirCounts) {
  simulate_developed(scene_named("tilted", kSmall), session_, ".tif", SampleType::kUint16);
  solve({session_.string()});
  EXPECT_LT(normal_error()["mean_deg"], 0.003) << normal_error();
  EXPECT_LT(albedo_error()["mean_rel"], 5e-4) << albedo_error();
}

TEST_F(Accuracy, OfFewerLightsIsStillBoundByTheCounts) {
  simulate(scene_named("flat", kSmall), session_);
  const Json solved = solve({session_.string(), "--lights", "1,5,7,9"});
  EXPECT_EQ(solved["pixels"], kSmall.pixels());
  EXPECT_LT(normal_error()["mean_deg"], 0.02) << normal_error();
  const Json record = Json::parse(bytes_of(work_ / "maps" / "solve.json"));
  EXPECT_EQ(record["lights"], 4);
}

TEST_F(Accuracy, OfLightsThatWereNotPickedIsOfNoImport) {
  simulate_developed(scene_named("tilted", kSmall), session_, ".exr", SampleType::kFloat);
  // Another frame in the place of LED 4's is harmful only where LED 4 is picked.
  fs::copy_file(session_ / "raw" / "08_led09.exr", session_ / "raw" / "03_led04.exr",
                fs::copy_options::overwrite_existing);
  solve({session_.string(), "--lights", "1,2,3,5,6,7,8,9,10"});
  EXPECT_LT(normal_error()["max_deg"], 1e-3) << normal_error();
  fs::remove_all(work_ / "maps");
  solve({session_.string(), "--method", "least-squares"});
  EXPECT_GT(normal_error()["mean_deg"], 1) << normal_error();
}

TEST_F(Accuracy, OfFloatPhotographsIsThatOfTheArithmetic) {
  PhotographSample().write(work_ / "photos");
  solve({"--photos", (work_ / "photos").string()});
  EXPECT_LT(compare("normal.exr", work_ / "photos" / "normal_gt.exr")["max_deg"], 1e-3);
  EXPECT_LT(compare("albedo.exr", work_ / "photos" / "albedo_gt.exr")["mean_rel"], 5e-4);
}

TEST_F(Accuracy, OfPhotographsOf16BitIsBoundByTheirCounts) {
  PhotographSample sample;
  sample.ending = ".png";
  sample.type = SampleType::kUint16;
  sample.write(work_ / "photos");
  solve({"--photos", (work_ / "photos").string()});
  const Json normal = compare("normal.exr", work_ / "photos" / "normal_gt.exr");
  EXPECT_LT(normal["mean_deg"], 0.005) << normal;
}

TEST_F(Accuracy, OfPhotographsFollowsTheTransferNamed) {
  PhotographSample sample;
  sample.ending = ".png";
  sample.type = SampleType::kUint8;
  sample.write(work_ / "photos");
  const fs::path truth = work_ / "photos" / "normal_gt.exr";
  solve({"--photos", (work_ / "photos").string(), "--transfer", "linear"});
  EXPECT_LT(compare("normal.exr", truth)["mean_deg"], 1) << compare("normal.exr", truth);
  fs::remove_all(work_ / "maps");
  // These files are linear in spite of their eight bits, which is found out where nobody says otherwise.
  solve({"--photos", (work_ / "photos").string()});
  EXPECT_LT(compare("normal.exr", truth)["mean_deg"], 1) << compare("normal.exr", truth);
  fs::remove_all(work_ / "maps");
  solve({"--photos", (work_ / "photos").string(), "--transfer", "srgb"});
  EXPECT_GT(compare("normal.exr", truth)["mean_deg"], 4) << compare("normal.exr", truth);
}

TEST_F(Accuracy, OfALightFileIsThatOfItsFolder) {
  PhotographSample sample;
  for (DistantLight& light : sample.lights) light.irradiance_rgb = {1, 1, 1};
  sample.write(work_ / "photos");
  std::string text = "6\n";
  for (std::size_t k = 0; k < sample.lights.size(); ++k) {
    const Vec3 l = 3.0 * sample.lights[k].direction;  // its length says nothing
    text += sample.name_of(k) + " " + std::to_string(l.x) + " " + std::to_string(l.y) + " " +
            std::to_string(l.z) + "\n";
  }
  put_bytes(work_ / "photos" / "lights.lp", text);
  solve({"--lp", (work_ / "photos" / "lights.lp").string()});
  EXPECT_LT(compare("normal.exr", work_ / "photos" / "normal_gt.exr")["max_deg"], 2e-3);
}

}  // namespace
}  // namespace weft::test
