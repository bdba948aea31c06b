// SPDX-License-Identifier: Apache-2.0
// Knocks of random size and direction, and LEDs that fade, told to a virtual rig: what `weft scan` then says
// of its rig, against what the scene says that it costs. `weft bench calibration --part watched` renders the
// same.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "calibration/run/rig_evidence.h"
#include "calibration/run/rig_look.h"
#include "core/base/temporary_folder.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "simulator/sampling/random.h"
#include "simulator/scene/resolution.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_rig.h"
#include "tests/core/places.h"
#include "virtual_rig/rig_process.h"
#include "virtual_rig/table/knock.h"

namespace weft {
namespace {

namespace fs = std::filesystem;
using calibration::MovementCost;

// There are 200 scans in all. With fewer pixels the tags of the table are too coarse.
constexpr int kScans = 40, kLeds = 10;
constexpr double kMegapixels = 0.25, kMostSeconds = 120;
constexpr double kToBeSaid_deg = 0.05, kToBeLeft_deg = 0.02, kToBeLeftAlbedo = 0.005;

/// What befalls a rig, in the words that a virtual one takes.
struct Mishap {
  std::vector<std::string> knock = {};  ///< what follows `knock`; empty: nothing is moved
  std::array<double, kLeds> levels = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1};  ///< of each LED's light
};

/// Random numbers of one scan.
class KnockDraws {
 public:
  explicit KnockDraws(int seed) : key_{static_cast<std::uint32_t>(seed), 0x6B6E6F63} {}
  int led() { return 1 + std::min(static_cast<int>(kLeds * share()), kLeds - 1); }
  /// Evenly in its logarithm.
  double size(double least, double most) { return least * std::pow(most / least, share()); }
  Vec3 direction() {
    const auto [x, y] = simulator::normal_pair(next());
    return normalized({x, y, simulator::normal_pair(next()).first});
  }

 private:
  double share() { return simulator::uniform(next()[0], 0); }
  std::array<std::uint32_t, 4> next() { return simulator::philox({count_++, 0, 0, 0}, key_); }
  std::array<std::uint32_t, 2> key_;
  std::uint32_t count_ = 0;
};

std::string said(const char* axis, double value) {
  return axis + std::string("=") + std::to_string(value);
}

std::vector<std::string> shift(std::vector<std::string> words, Vec3 mm) {
  words.insert(words.end(), {said("x", mm.x), said("y", mm.y), said("z", mm.z)});
  return words;
}

Mishap camera_knocked(KnockDraws& draws) {
  const double mm = draws.size(0.1, 5);
  const Vec3 way = draws.direction();
  return {.knock = {"camera", said("x", mm * way.x), said("y", mm * way.y), said("turn", 0.1 * mm * way.z)}};
}

Mishap led_knocked(KnockDraws& draws) {
  const std::string led = std::to_string(draws.led());
  return {.knock = shift({"led", led}, draws.size(1, 10) * draws.direction())};
}

Mishap table_knocked(KnockDraws& draws) {
  return {.knock = shift({"table"}, draws.size(0.1, 5) * draws.direction())};
}

Mishap led_faded(KnockDraws& draws) {
  Mishap mishap;
  mishap.levels[static_cast<std::size_t>(draws.led() - 1)] -= draws.size(0.005, 0.08);
  return mishap;
}

Mishap all_faded(KnockDraws& draws) {
  Mishap mishap;
  mishap.levels.fill(1 - draws.size(0.005, 0.08));
  return mishap;
}

/// What scanning on costs, after white patches have put levels right, by the scene.
MovementCost true_cost(const Mishap& mishap, const Calibration& known, const calibration::RigLook& look) {
  simulator::Scene scene = *simulator::read_scene(in_sources("testdata/scenes/rig.toml"));
  simulator::resize(scene.camera, kMegapixels);
  const simulator::SceneRig before = *simulator::rig_of(scene);
  virtual_rig::Knocks knocks;
  if (!mishap.knock.empty()) {
    EXPECT_TRUE(virtual_rig::knock(knocks, mishap.knock, kLeds));
  }
  simulator::SceneRig after = *simulator::rig_of(*virtual_rig::knocked(std::move(scene), knocks));
  // In the frame of the table, where tags are.
  after.camera.camera_from_rig_translation_mm =
      after.camera.camera_from_rig_translation_mm + after.camera.camera_from_rig_rotation * knocks.table_mm;
  for (std::size_t k = 0; k < after.leds.leds.size(); ++k) {
    NearLight& led = after.leds.leds[k];
    led.position_mm = led.position_mm - knocks.table_mm;
    for (double& flux : led.flux_rgb) flux *= mishap.levels[k];
  }
  const auto places = calibration::evidence_of(known, look.seen).places;
  return calibration::cost_of(before.camera, calibration::levelled(before.leds, after.leds, places),
                              after.camera, after.leds);
}

std::set<fs::path> files_below(const fs::path& folder) {
  std::set<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.insert(entry.path());
  }
  return files;
}

struct KnockKind {
  const char* name;
  Mishap (*draw)(KnockDraws& draws);
};

class KnocksSoak : public testing::TestWithParam<KnockKind> {
 protected:
  void SetUp() override {
    setenv("XDG_CACHE_HOME", cache().c_str(), 1);
    fs::create_directories(cache());
    auto rig = virtual_rig::RigProcess::start({.programs = program_folder(),
                                               .scene = in_sources("testdata/scenes/rig.toml"),
                                               .folder = folder_.path() / "rig",
                                               .megapixels = kMegapixels});
    ASSERT_TRUE(rig) << rig.error().message();
    rig_ = std::move(*rig);
    at_first_ = files_below(cache());
  }
  void TearDown() override { unsetenv("XDG_CACHE_HOME"); }

  fs::path cache() const { return folder_.path() / "cache"; }

  void say(const std::string& line) const {
    const Result<std::string> answer = rig_->say(line);
    ASSERT_TRUE(answer) << line << ": " << answer.error().message();
  }
  void befall(const Mishap& mishap) const {
    say("light normal");
    say("knock nothing");
    std::string line = "knock";
    for (const std::string& word : mishap.knock) line += ' ' + word;
    if (!mishap.knock.empty()) say(line);
    for (std::size_t k = 0; k < mishap.levels.size(); ++k) {
      if (mishap.levels[k] != 1)
        say("light dim " + std::to_string(k + 1) + ' ' + std::to_string(mishap.levels[k]));
    }
  }
  /// The session of a scan; what is rendered for it alone is removed.
  fs::path scan(int number) const {
    const fs::path session = folder_.path() / (std::to_string(number) + ".weft");
    const auto weft =
        rig_->weft({"scan", "--fabric", "twill", "--no-preview", "-q", "-o", session.string()}, "scan.log");
    EXPECT_TRUE(weft) << weft.error().message();
    if (weft) {
      EXPECT_EQ((*weft)->wait(kMostSeconds), 0) << (*weft)->said();
    }
    for (const fs::path& file : files_below(cache())) {
      if (!at_first_.contains(file)) fs::remove(file);
    }
    return session;
  }

  TemporaryFolder folder_;
  std::unique_ptr<virtual_rig::RigProcess> rig_;
  std::set<fs::path> at_first_;
};

TEST_P(KnocksSoak, AreSaidByTheScanAfterThemWhereTheyCostAndNotWhereNothingMoved) {
  int over = 0, over_said = 0, under = 0, under_moved = 0;
  double off_deg = 0;
  for (int number = 1; number <= kScans; ++number) {
    KnockDraws draws(number);
    const Mishap mishap = GetParam().draw(draws);
    befall(mishap);
    const Result<Session> session = read_session(scan(number));
    ASSERT_TRUE(session) << session.error().message();
    const Result<Calibration> known = read_calibration(session->calibration_folder());
    ASSERT_TRUE(known) << known.error().message();
    const auto look = calibration::kept_look(*session);
    ASSERT_TRUE(look) << "scan " << number << " has no look at its rig";
    const MovementCost cost = true_cost(mishap, *known, *look);
    const double albedo = std::max(std::abs(cost.albedo_factor - 1), cost.albedo_unevenness);
    const bool is_said = look->state != RigPlace::kInPlace;
    const bool is_moved = is_said && look->state != RigPlace::kDimmed;
    const std::string what = "scan " + std::to_string(number) + ", " + testing::PrintToString(mishap.knock) +
                             ", costs " + std::to_string(cost.mean_deg) + " degrees and " +
                             std::to_string(albedo) + " of albedo: " + look->says;
    std::puts(what.c_str());
    if (cost.mean_deg > kToBeSaid_deg) {
      ++over;
      over_said += is_said ? 1 : 0;
      EXPECT_TRUE(is_said) << what;
    } else if (cost.mean_deg < kToBeLeft_deg && albedo < kToBeLeftAlbedo) {
      ++under;
      under_moved += is_moved ? 1 : 0;
      EXPECT_FALSE(is_moved) << what;
    }
    if (is_moved) off_deg = std::max(off_deg, std::abs(look->cost.mean_deg - cost.mean_deg));
    fs::remove_all(session->folder);
  }
  std::printf(
      "%s: %d scans, %d over %.2f degrees, %d said; %d under %.2f, %d called moved; cost told off by %.3f\n",
      GetParam().name, kScans, over, kToBeSaid_deg, over_said, under, kToBeLeft_deg, under_moved, off_deg);
}

INSTANTIATE_TEST_SUITE_P(OfAllKinds, KnocksSoak,
                         testing::Values(KnockKind{"Camera", camera_knocked}, KnockKind{"Led", led_knocked},
                                         KnockKind{"Table", table_knocked}, KnockKind{"OneLevel", led_faded},
                                         KnockKind{"AllLevels", all_faded}),
                         [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace weft
