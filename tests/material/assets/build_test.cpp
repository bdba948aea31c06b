// SPDX-License-Identifier: Apache-2.0
// Materials in files, built by the job.
#include "material/assets/build.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <thread>

#include "core/base/files.h"
#include "core/base/vec.h"
#include "material/assets/watch.h"
#include "material/layers/field.h"
#include "tests/material/assets/made_maps.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

double channel_at(const LoadedImage& image, const char* channel, int x, int y) {
  return double{image.channel(channel)(x, y)};
}

TEST(Build, OfAScanHasItsMaps) {
  Bench bench;
  bench.draws = true;
  const MadeSet set;
  set.write(bench / "cloth");
  bench.material("plain.toml", "inherits = \"library:cloth/cotton\"\nscan = \"cloth\"\n");
  const BuildReport report = bench.built({"plain.toml"});
  ASSERT_EQ(report.materials.size(), 1U);
  const Json& d = report.materials[0].document;
  EXPECT_EQ(d["schema"], "weft.material-build/1");
  EXPECT_EQ(d["width"], 48);
  EXPECT_EQ(d["is_tile"], true);
  EXPECT_NEAR(d["mm_per_pixel"].get<double>(), 0.25, 1e-12);
  EXPECT_EQ(d["parameters"]["cloth"]["value"], 0.15) << "what the scan does not tell comes from the template";
  const LoadedImage albedo = map_of(report.materials[0], "albedo"),
                    normal = map_of(report.materials[0], "normal"),
                    lobe = map_of(report.materials[0], "roughness"),
                    height = map_of(report.materials[0], "height");
  for (const auto& [x, y] : {std::pair{3, 4}, std::pair{40, 31}}) {
    EXPECT_NEAR(channel_at(albedo, "G", x, y), set.albedo(x, y, 1), 1e-6);
    EXPECT_NEAR(channel_at(height, "height", x, y), set.height(x, y), 1e-6);
    EXPECT_NEAR(-channel_at(normal, "X", x, y) / channel_at(normal, "Z", x, y), set.slope(x, y, 0), 1e-5);
    EXPECT_NEAR(channel_at(lobe, "alpha", x, y), set.alpha(x, y), 1e-6);
    EXPECT_NEAR(channel_at(lobe, "alpha_along", x, y), 0.5 * set.alpha(x, y), 1e-6);
    EXPECT_NEAR(channel_at(lobe, "yarn_deg", x, y), x % 2 ? 90 : 0, 1e-4);
  }
  EXPECT_TRUE(is_there(report.materials[0].folder / "preview.png"));
  EXPECT_TRUE(is_there(report.materials[0].folder / "mips/normal_01.exr"));
}

TEST(Build, OfThreeLayersIsTheBlendByHand) {
  const Bench bench;
  std::array<MadeSet, 3> sets;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    sets[i].seed = static_cast<int>(1 + 100 * i);
    sets[i].write(bench / ("set" + std::to_string(i)));
    bench.material("m" + std::to_string(i) + ".toml", "scan = \"set" + std::to_string(i) + "\"\n");
  }
  bench.material("dark.toml", "[surface]\nalbedo = [0.1, 0.05, 0.02]\nroughness = 0.3\ncloth = 1\n");
  bench.material("stack.toml",
                 "inherits = \"m0.toml\"\n"
                 "[[layer]]\nname = \"a\"\nmaterial = \"m1.toml\"\nmask = { scan = \"set2\", map = "
                 "\"occlusion\" }\nalpha = 0.8\n"
                 "[[layer]]\nname = \"b\"\nmaterial = \"m2.toml\"\nmask = 0.25\n"
                 "[[layer]]\nname = \"c\"\nmaterial = \"dark.toml\"\nmask = { from = \"height\", kind = "
                 "\"level\", at_mm = 0.01, soft_mm = 0.2 }\n"
                 "only = [\"albedo\", \"roughness\", \"cloth\"]\n");
  const BuildReport report = bench.built({"stack.toml"});
  ASSERT_EQ(report.materials.size(), 1U);
  EXPECT_EQ(report.built, 4);
  const LoadedImage albedo = map_of(report.materials[0], "albedo"),
                    height = map_of(report.materials[0], "height"),
                    normal = map_of(report.materials[0], "normal"),
                    cloth = map_of(report.materials[0], "cloth"),
                    lobe = map_of(report.materials[0], "roughness");
  double worst = 0, worst_deg = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 48; ++x) {
      const double m1 = 0.8 * noise_at(x, y, sets[2].seed + 40), m2 = 0.25;
      const auto two = [&](double below, double first, double second) {
        const double lower = (1 - m1) * below + m1 * first;
        return (1 - m2) * lower + m2 * second;
      };
      const double h = two(sets[0].height(x, y), sets[1].height(x, y), sets[2].height(x, y));
      const double t = std::clamp((h - 0.01) / 0.2 + 0.5, 0.0, 1.0), m3 = t * t * (3 - 2 * t);
      worst = std::max(worst, std::abs(h - channel_at(height, "height", x, y)));
      worst = std::max(worst, std::abs(m3 - channel_at(cloth, "cloth", x, y)));
      const double below = two(sets[0].albedo(x, y, 2), sets[1].albedo(x, y, 2), sets[2].albedo(x, y, 2));
      worst = std::max(worst, std::abs((1 - m3) * below + m3 * 0.02 - channel_at(albedo, "B", x, y)));
      const auto root = [&](const MadeSet& set) { return std::sqrt(set.alpha(x, y)); };
      const double r = (1 - m3) * two(root(sets[0]), root(sets[1]), root(sets[2])) + m3 * 0.3;
      worst = std::max(worst, std::abs(r * r - channel_at(lobe, "alpha", x, y)));
      const auto slope = [&](int axis) {
        return two(sets[0].slope(x, y, axis), sets[1].slope(x, y, axis), sets[2].slope(x, y, axis));
      };
      worst_deg = std::max(worst_deg, angle_deg({-slope(0), -slope(1), 1},
                                                {channel_at(normal, "X", x, y), channel_at(normal, "Y", x, y),
                                                 channel_at(normal, "Z", x, y)}));
    }
  }
  EXPECT_LT(worst, 1e-6);
  EXPECT_LT(worst_deg, 1e-4);
}

TEST(Build, IsTheSameBytesForAnyThreads) {
  Bench bench;
  bench.draws = true;
  MadeSet().write(bench / "cloth");
  bench.material("dusty.toml",
                 "scan = \"cloth\"\n[[layer]]\nname = \"dust\"\nmaterial = \"library:dust\"\nmask = { from = "
                 "\"height\", kind = \"cavity\", radius_mm = 1 }\n");
  ASSERT_TRUE(bench.build({"dusty.toml"}, {.threads = 1}));
  const auto one = digests_below(bench / "build");
  fs::remove_all(bench / "build");
  ASSERT_TRUE(bench.build({"dusty.toml"}, {.threads = 4}));
  EXPECT_EQ(one, digests_below(bench / "build"));
  EXPECT_GT(one.size(), 10U);
}

// Four materials, two of them asked for: jacket lies on red twill and dust, bag on twill; red inherits twill.
struct Wardrobe {
  Bench bench;
  Wardrobe() {
    MadeSet().write(bench / "cloth");
    bench.material("twill.toml", "scan = \"cloth\"\n");
    bench.material("red.toml", "inherits = \"twill.toml\"\n[surface]\nalbedo_tint = [1, 0.1, 0.1]\n");
    bench.material("dust.toml", "[surface]\nalbedo = [0.3, 0.3, 0.3]\n");
    bench.material(
        "jacket.toml",
        "inherits = \"red.toml\"\n[[layer]]\nname = \"dust\"\nmaterial = \"dust.toml\"\nmask = 0.5\n");
    bench.material("bag.toml", "[[layer]]\nname = \"cloth\"\nmaterial = \"twill.toml\"\n");
  }
  BuildReport build() const { return bench.built({"jacket.toml", "bag.toml"}); }
};

TEST(Rebuild, MakesNothingWhereNothingChanged) {
  const Wardrobe wardrobe;
  const BuildReport first = wardrobe.build();
  EXPECT_EQ(first.built, 4) << "jacket, dust, bag, twill";
  const BuildReport second = wardrobe.build();
  EXPECT_EQ(second.built, 0);
  EXPECT_EQ(second.kept, 4);
  EXPECT_TRUE(second.materials[0].was_there);
}

TEST(Rebuild, OfABaseMakesItsDependantsAlone) {
  const Wardrobe wardrobe;
  const BuildReport first = wardrobe.build();
  wardrobe.bench.material("twill.toml", "scan = \"cloth\"\n[surface]\nspecular = 0.6\n");
  const BuildReport edited = wardrobe.build();
  EXPECT_EQ(edited.built, 3) << "jacket through red, bag and twill; dust stays";
  EXPECT_EQ(edited.kept, 1);
  wardrobe.bench.material("twill.toml", "scan = \"cloth\"\n");
  const BuildReport undone = wardrobe.build();
  EXPECT_EQ(undone.built, 0) << "what was built before is found again";
  EXPECT_EQ(undone.materials[0].id, first.materials[0].id);
  wardrobe.bench.material("dust.toml", "[surface]\nalbedo = [0.2, 0.3, 0.3]\n");
  EXPECT_EQ(wardrobe.build().built, 2) << "dust and the jacket on which it lies";
}

TEST(Rebuild, OfTouchedFilesMakesNothing) {
  const Wardrobe wardrobe;
  wardrobe.build();
  for (const auto& entry : fs::recursive_directory_iterator(wardrobe.bench / ".")) {
    if (entry.is_regular_file())
      fs::last_write_time(entry.path(), fs::file_time_type::clock::now() - std::chrono::hours(1));
  }
  const BuildReport touched = wardrobe.build();
  EXPECT_EQ(touched.built, 0);
  EXPECT_GT(touched.hashed, 0);
  const BuildReport again = wardrobe.build();
  EXPECT_EQ(again.built, 0);
  EXPECT_EQ(again.hashed, 0) << "files that lie as they lay are not read again";
}

TEST(Rebuild, OfAScanThatWasSolvedAgainReachesAllAboveIt) {
  const Wardrobe wardrobe;
  const BuildReport first = wardrobe.build();
  MadeSet again;
  again.seed = 7;
  again.write(wardrobe.bench / "cloth");
  const BuildReport second = wardrobe.build();
  EXPECT_EQ(second.built, 3);
  EXPECT_NE(second.materials[0].id, first.materials[0].id);
  EXPECT_NE(second.materials[1].id, first.materials[1].id);
}

TEST(Build, IsNotNamedByWhereItLies) {
  const Wardrobe here, there;
  EXPECT_EQ(here.build().materials[0].id, there.build().materials[0].id);
}

TEST(Build, DustLiesInWhatIsDeep) {
  const Bench bench;
  const MadeSet set;
  set.write(bench / "cloth");
  bench.material(
      "dusty.toml",
      "scan = \"cloth\"\n[[layer]]\nname = \"dust\"\nmaterial = \"library:dirt/dust\"\nonly = [\"albedo\"]\n"
      "mask = { from = \"height\", kind = \"cavity\", radius_mm = 2 }\n");
  const BuildReport report = bench.built({"dusty.toml"});
  const LoadedImage albedo = map_of(report.materials[0], "albedo");
  int deep = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 48; ++x) {
      const double moved = std::abs(channel_at(albedo, "R", x, y) - set.albedo(x, y, 0));
      if (set.height(x, y) > 0.1) {
        EXPECT_LT(moved, 1e-6) << x << " " << y;
      }
      deep += set.height(x, y) < -0.15 && moved > 0.02;
    }
  }
  EXPECT_GT(deep, 50);
}

TEST(Build, BringsALayerToItsTrueSize) {
  const Bench bench;
  MadeSet base = {.size = {96, 64}, .mm_per_pixel = 0.25};
  base.write(bench / "base");
  MadeSet small = {.size = {48, 32}, .mm_per_pixel = 0.25, .seed = 9};
  small.write(bench / "small");
  bench.material("small.toml", "scan = \"small\"\n");
  bench.material("on.toml", "scan = \"base\"\n[[layer]]\nname = \"weave\"\nmaterial = \"small.toml\"\n");
  const BuildReport report = bench.built({"on.toml"});
  const LoadedImage albedo = map_of(report.materials[0], "albedo");
  EXPECT_NEAR(channel_at(albedo, "R", 7, 5), small.albedo(7, 5, 0), 1e-6);
  EXPECT_NEAR(channel_at(albedo, "R", 55, 37), small.albedo(7, 5, 0), 1e-6);
}

TEST(Build, OfEveryTemplateIsWhole) {
  Bench bench;
  bench.draws = true;
  std::vector<std::string> names;
  for (const ShippedMaterial& each : shipped_materials())
    names.push_back(std::string(kLibraryPrefix) + each.name);
  EXPECT_GE(names.size(), 11U);
  const BuildReport report = bench.built(names);
  ASSERT_EQ(report.materials.size(), names.size());
  for (const BuiltMaterial& each : report.materials) {
    SCOPED_TRACE(each.place.name);
    EXPECT_FALSE(each.document.contains("mm_per_pixel")) << "no size is invented";
    EXPECT_TRUE(each.document["verdicts"].empty()) << each.document["verdicts"].dump();
    const Result<LoadedImage> picture = read_image(each.folder / "preview.png");
    ASSERT_TRUE(picture);
    // A ball that is neither black nor burnt out.
    double sum = 0, most = 0;
    for (int y = 64; y < 192; ++y) {
      for (int x = 64; x < 192; ++x) {
        sum += double{picture->planes(x, y, 1)};
        most = std::max(most, double{picture->planes(x, y, 1)});
      }
    }
    EXPECT_GT(sum / (128 * 128), 0.05);
    EXPECT_LT(sum / (128 * 128), 0.95);
  }
}

TEST(Build, ThatIsStoppedLeavesNothing) {
  const Bench bench;
  MadeSet().write(bench / "cloth");
  bench.material("plain.toml", "scan = \"cloth\"\n");
  std::stop_source stop;
  int steps = 0;
  const auto progress = [&](std::string_view phase, double) {
    if (phase == "compose" && ++steps == 4) stop.request_stop();
  };
  const Result<BuildReport> report =
      bench.build({"plain.toml"}, {.stop = stop.get_token(), .progress = progress});
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().kind, ErrorKind::kInterrupted);
  EXPECT_FALSE(fs::exists(bench / "build"));
  EXPECT_EQ(bench.built({"plain.toml"}).built, 1);
}

// Runs in a process of its own, which KilledInTheMiddle kills.
TEST(Build, DISABLED_OfALargeMaterial) {
  const char* folder = std::getenv("WEFT_TEST_FOLDER");
  ASSERT_NE(folder, nullptr);
  const Result<MaterialPlace> place = find_material(std::string(folder) + "/large.toml", {});
  ASSERT_TRUE(place);
  static_cast<void>(build_materials({.materials = {*place}}, {.threads = 1}));
}

TEST(Build, KilledInTheMiddleIsWholeTheNextTime) {
  const Bench bench;
  MadeSet({.size = {640, 640}, .mm_per_pixel = 0.05}).write(bench / "cloth");
  bench.material("large.toml", "scan = \"cloth\"\n");
  const std::string folder = (bench / ".").string();
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::setenv("WEFT_TEST_FOLDER", folder.c_str(), 1);
    ::execl("/proc/self/exe", "test", "--gtest_filter=*OfALargeMaterial", "--gtest_also_run_disabled_tests",
            "--gtest_brief=1", nullptr);
    ::_exit(1);
  }
  // It is killed once it has begun to write its maps.
  const auto has_begun = [&] {
    std::error_code failure;
    for (const auto& entry : fs::recursive_directory_iterator(bench / "build", failure)) {
      if (entry.path().extension() == ".exr") return true;
    }
    return false;
  };
  for (int i = 0; i < 10000 && !has_begun(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "it was quicker than its murderer";
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(bench / "build", failure))
    EXPECT_TRUE(entry.path().filename().string().starts_with(".")) << entry.path() << " looks whole";
  const BuildReport report = bench.built({"large.toml"});
  EXPECT_EQ(report.built, 1);
  EXPECT_TRUE(is_there(report.materials[0].folder / "material.json"));
}

TEST(Watch, BuildsAgainWhenAFileChanges) {
  const Wardrobe wardrobe;
  std::stop_source stop;
  std::vector<int> built;
  const Result<MaterialPlace> place = find_material((wardrobe.bench / "jacket.toml").string(), {});
  ASSERT_TRUE(place);
  const WatchOptions options = {
      .build = {.materials = {*place}, .output = wardrobe.bench / "build", .compose = {}}, .every_ms = 5};
  watch_materials(options, {.stop = stop.get_token()}, [&](const Result<BuildReport>& report) {
    built.push_back(report ? report->built : -1);
    if (built.size() == 1) wardrobe.bench.material("dust.toml", "nonsense");
    if (built.size() == 2) wardrobe.bench.material("dust.toml", "[surface]\nalbedo = [0.1, 0.1, 0.1]\n");
    if (built.size() == 3) stop.request_stop();
  });
  EXPECT_EQ(built, (std::vector<int>{2, -1, 2}));
}

TEST(Graph, NamesWhatEverythingDependsOn) {
  const Wardrobe wardrobe;
  DigestCache digests({});
  const Result<MaterialPlace> place = find_material((wardrobe.bench / "jacket.toml").string(), {});
  const Result<MaterialTree> tree = plan_materials({*place}, materials_on_disk(), digests);
  ASSERT_TRUE(tree) << tree.error().message();
  const std::string graph = graph_of(*tree);
  EXPECT_THAT(graph, HasSubstr("digraph"));
  EXPECT_THAT(graph, HasSubstr("red.toml\" -> \"" + (wardrobe.bench / "jacket.toml").string() +
                               "\" [label=\"inherits\""));
  EXPECT_THAT(graph, HasSubstr("albedo.exr\" -> "));
  EXPECT_THAT(graph, HasSubstr("[label=\"dust\", style=solid]"));
}

}  // namespace
}  // namespace weft::material
