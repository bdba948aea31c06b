// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>

// An effect that is off costs nothing: a program that holds no other pass runs the same instructions as one
// that holds all of them.

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

/// What a command prints; nothing where it fails.
std::string output_of(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return {};
  std::string text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  return pclose(pipe) == 0 ? text : std::string();
}

std::set<std::string> passes_in(const std::string& program) {
  static const std::regex kPass(R"( T weft::simulator::(\w+_pass)\()");
  const std::string symbols = output_of("nm -C " + program);
  std::set<std::string> passes;
  for (std::sregex_iterator i(symbols.begin(), symbols.end(), kPass), end; i != end; ++i)
    passes.insert((*i)[1]);
  return passes;
}

struct CountedRun {
  std::string digest;
  double instructions = 0;  ///< of one frame
};

CountedRun counted(const std::string& program) {
  const fs::path counts =
      fs::path(testing::TempDir()) / (fs::path(program).filename().string() + ".callgrind");
  CountedRun run;
  run.digest = output_of("valgrind -q --tool=callgrind --toggle-collect=weft_frame --callgrind-out-file=" +
                         counts.string() + " " + program);
  std::ifstream file(counts);
  for (std::string word; file >> word;) {
    if (word == "totals:" || word == "summary:") file >> run.instructions;
  }
  fs::remove(counts);
  run.instructions /= 2;  // the frame that warms up is counted, too
  return run;
}

TEST(ZeroCost, AProgramOfPlainPassesLinksNoEffect) {
  const std::set<std::string> alone = passes_in(LAMBERT_ALONE), among_all = passes_in(LAMBERT_AMONG_ALL);
  EXPECT_THAT(alone, IsSupersetOf({"camera_pass", "geometry_pass", "near_light_pass", "lambert_pass"}));
  for (const char* effect :
       {"cast_shadows_pass", "interreflection_pass", "reflectance_pass", "targets_pass", "vignetting_pass",
        "defocus_pass", "bloom_pass", "stray_pass", "translucency_pass", "field_curvature_pass",
        "chromatic_aberration_pass", "veil_pass"}) {
    EXPECT_TRUE(among_all.contains(effect)) << effect;
    EXPECT_FALSE(alone.contains(effect)) << effect;
  }
  EXPECT_THAT(output_of(std::string("nm ") + LAMBERT_AMONG_ALL), HasSubstr(" rtcNew"));
  EXPECT_THAT(output_of(std::string("nm ") + LAMBERT_ALONE), Not(HasSubstr(" rtcNew"))) << "no Embree";
}

TEST(ZeroCost, EffectsThatAreOffAddNoInstruction) {
  if (output_of("valgrind --version").empty()) GTEST_SKIP() << "valgrind is not installed";
  const CountedRun alone = counted(LAMBERT_ALONE), among_all = counted(LAMBERT_AMONG_ALL);
  std::printf("%.0f instructions alone, %.0f among all passes\n", alone.instructions, among_all.instructions);
  EXPECT_FALSE(alone.digest.empty());
  EXPECT_EQ(alone.digest, among_all.digest);
  EXPECT_GT(alone.instructions, 256 * 256 * 10);
  EXPECT_NEAR(among_all.instructions / alone.instructions, 1, 0.001);
}

}  // namespace
