// SPDX-License-Identifier: Apache-2.0
// The same bytes whatever the threads and the tiles, and the same solve only once.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "solve/run/solve_session.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

struct Division {
  int threads;
  TileOptions tile;
};

const Division kDivisions[] = {{2, {}},
                               {7, {}},
                               {1, {.width = 1, .height = 1}},
                               {7, {.width = 1, .height = 1}},
                               {2, {.width = 24, .height = 5}},
                               {7, {.width = 100, .height = 3}},
                               {2, {.width = 1 << 20, .height = 1 << 20}}};

using Solve = std::function<Result<solve::SolveReport>(const solve::SolveOptions&, const JobContext&)>;

/// Solves by each of some methods, whole and divided in many ways, and compares the maps byte by byte.
void expect_same_maps(const Workspace& work, const std::vector<std::string>& methods, const Solve& solve) {
  for (const std::string& method : methods) {
    const auto maps_of = [&](const Division& division) {
      solve::SolveOptions options;
      options.method = method;
      options.output = work / "maps";
      options.previews = false;
      options.tile = division.tile;
      const Result<solve::SolveReport> report = solve(options, {.threads = division.threads});
      std::vector<std::string> bytes;
      if (!report) {
        ADD_FAILURE() << report.error().message();
        return bytes;
      }
      for (const char* map : kMaps) bytes.push_back(bytes_of(work / "maps" / map));
      fs::remove_all(work / "maps");
      return bytes;
    };
    const std::vector<std::string> whole = maps_of({1, {}});
    ASSERT_EQ(whole.size(), kMaps.size());
    for (const Division& division : kDivisions) {
      const std::vector<std::string> divided = maps_of(division);
      ASSERT_EQ(divided.size(), kMaps.size());
      for (std::size_t m = 0; m < kMaps.size(); ++m) {
        EXPECT_TRUE(divided[m] == whole[m])
            << kMaps[m] << " of " << method << " differs with " << division.threads
            << " threads and tiles of " << division.tile.width << " x " << division.tile.height;
      }
    }
  }
}

class SameMapsOfASession : public testing::TestWithParam<Size> {};

TEST_P(SameMapsOfASession, ForAnyThreadsAndTiles) {
  const Workspace work;
  simulate(scene_named("golden", GetParam()), work / "cloth.weft");
  const auto solve = [&](const auto& options, const auto& context) {
    return solve::solve_session({.folder = work / "cloth.weft", .calibration = {}, .leds = {}}, options,
                                context);
  };
  expect_same_maps(work, {"fast", "robust", "least-squares", "seed"}, solve);
}

// One tile of a band; several bands; several tiles a band.
INSTANTIATE_TEST_SUITE_P(Sizes, SameMapsOfASession,
                         testing::Values(Size{64, 48}, Size{34, 262}, Size{322, 24}));

struct PhotographKind {
  Size size;
  const char* ending;
  SampleType type;
};

class SameMapsOfPhotographs : public testing::TestWithParam<PhotographKind> {};

TEST_P(SameMapsOfPhotographs, ForAnyThreadsAndTiles) {
  const Workspace work;
  PhotographSample sample;
  sample.size = GetParam().size;
  sample.ending = GetParam().ending;
  sample.type = GetParam().type;
  sample.write(work / "photos");
  const auto solve = [&](const auto& options, const auto& context) {
    solve::PhotoOptions photos;
    photos.folder = work / "photos";
    return solve::solve_photos(photos, options, context);
  };
  // Photographs come to all methods by the same reader.
  expect_same_maps(work, {"fast", "robust"}, solve);
}

INSTANTIATE_TEST_SUITE_P(Sizes, SameMapsOfPhotographs,
                         testing::Values(PhotographKind{{1, 1}, ".exr", SampleType::kFloat},
                                         PhotographKind{{37, 131}, ".exr", SampleType::kHalf},
                                         PhotographKind{{333, 29}, ".png", SampleType::kUint16},
                                         PhotographKind{{15, 17}, ".png", SampleType::kUint8},
                                         PhotographKind{{21, 257}, ".tif", SampleType::kUint16}));

class Sameness : public testing::Test {
 protected:
  void SetUp() override { simulate(scene_named("golden", {64, 48}), session_); }
  Workspace work_;
  const fs::path session_ = work_ / "cloth.weft";
};

TEST_F(Sameness, OfWholeRunsOfTheProgram) {
  const auto solve = [&](const std::string& name, const std::vector<std::string>& division) {
    std::vector<std::string> arguments = {"solve", session_.string(), "-o", (work_ / name).string(), "-q"};
    arguments.insert(arguments.end(), division.begin(), division.end());
    const Outcome run = run_weft(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.error;
    // Only solve.json and the report, of all files, say how long it took.
    edit_json(work_ / name / "solve.json", [](Json& document) {
      EXPECT_EQ(document.at("taken").erase("seconds") + document["taken"].erase("parts_s"), 2U);
    });
    edit_json(work_ / name / "report.json", [](Json& report) { EXPECT_EQ(report.erase("seconds"), 1U); });
    const std::string page = bytes_of(work_ / name / "report.html");
    const std::size_t begin = page.find('{', page.find("id=\"report\"")), end = page.find("</script>", begin);
    Json data = Json::parse(page.substr(begin, end - begin));
    const auto is_of_time = [](const Json& section) { return section["title"] == "Time by phase"; };
    EXPECT_EQ(std::erase_if(data["sections"].get_ref<Json::array_t&>(), is_of_time), 1U);
    put_bytes(work_ / name / "report.html", page.substr(0, begin) + data.dump() + page.substr(end));
    return contents_of(work_ / name);
  };
  // Pictures and report too: they name neither date nor threads nor this machine.
  EXPECT_EQ(solve("a", {"--threads", "7", "--tile-width", "1", "--tile-height", "1"}),
            solve("b", {"--threads", "1"}));
}

TEST_F(Sameness, OfASimulation) {
  put_bytes(work_ / "scene.toml", simulator::to_toml(scene_named("golden", {64, 48})));
  const Outcome run = run_weft({"simulate", (work_ / "scene.toml").string(), "-o",
                                (work_ / "again.weft").string(), "-q", "--threads", "7"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_EQ(contents_of(work_ / "again.weft"), contents_of(session_));
}

TEST_F(Sameness, ASolveThatIsThereIsNotDoneAgain) {
  const Outcome first = run_weft({"solve", session_.string(), "-q", "--json"});
  ASSERT_EQ(first.exit_code, 0) << first.error;
  EXPECT_EQ(first.json()["was_there"], false);
  const auto before = contents_of(work_.path());
  // Threads and tiles are no options in this sense.
  const Outcome again = run_weft({"solve", session_.string(), "-q", "--threads", "1", "--tile-width", "16"});
  EXPECT_EQ(again.exit_code, 0) << again.error;
  EXPECT_NE(again.output.find("is there already"), std::string::npos) << again.output;
  const Outcome json = run_weft({"solve", session_.string(), "-q", "--json"});
  EXPECT_EQ(json.exit_code, 0) << json.error;
  EXPECT_EQ(json.json()["was_there"], true);
  EXPECT_EQ(json.json()["normal"], first.json()["normal"]);
  EXPECT_EQ(contents_of(work_.path()), before);
}

TEST_F(Sameness, ASolveOfMovedSessionIsStillThere) {
  ASSERT_EQ(run_weft({"solve", session_.string(), "-q"}).exit_code, 0);
  fs::rename(session_, work_ / "moved.weft");
  const Outcome run = run_weft({"solve", (work_ / "moved.weft").string(), "-q", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_EQ(run.json()["was_there"], true);
}

TEST_F(Sameness, OtherOptionsAreAnotherSolve) {
  for (const std::vector<std::string>& more : {std::vector<std::string>{},
                                               {"--method", "least-squares"},
                                               {"--lights", "1,2,3,4"},
                                               {"--compress", "zip"}}) {
    std::vector<std::string> arguments = {"solve", session_.string(), "-q", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome run = run_weft(arguments);
    ASSERT_EQ(run.exit_code, 0) << run.error;
    EXPECT_EQ(run.json()["was_there"], false);
  }
}

TEST_F(Sameness, AFolderOfSomethingElseIsNeverWrittenTo) {
  fs::create_directories(work_ / "mine");
  put_bytes(work_ / "mine" / "notes.txt", "mine");
  const std::vector<std::string> words = {"output folder is taken", "mine", "something other",
                                          "another folder with -o"};
  expect_refusal(work_, {"solve", session_.string(), "-o", (work_ / "mine").string(), "-q"}, 73, words);
  fs::remove(work_ / "mine" / "notes.txt");
  expect_refusal(work_, {"solve", session_.string(), "-o", (work_ / "mine").string(), "-q"}, 73, words);
}

TEST_F(Sameness, AnotherSolveIsNeverWrittenOver) {
  const std::string maps = (work_ / "maps").string();
  ASSERT_EQ(run_weft({"solve", session_.string(), "-o", maps, "-q"}).exit_code, 0);
  expect_refusal(work_, {"solve", session_.string(), "--method", "seed", "-o", maps, "-q"}, 73,
                 {"output folder is taken", maps, "something other", "another folder with -o"});
}

TEST_F(Sameness, AFileInThePlaceOfTheOutputIsNeverReplaced) {
  put_bytes(work_ / "file", "mine");
  expect_refusal(work_, {"solve", session_.string(), "-o", (work_ / "file").string(), "-q"}, 73, {"file"});
  expect_refusal(work_, {"solve", session_.string(), "-o", (work_ / "file" / "maps").string(), "-q"}, 73,
                 {"file"});
}

}  // namespace
}  // namespace weft::test
