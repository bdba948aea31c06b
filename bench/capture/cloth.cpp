// SPDX-License-Identifier: Apache-2.0
#include "bench/capture/capture_studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bench/oracles/simulated_cloth.h"
#include "capture/framing/focus.h"
#include "capture/scan/light_evidence.h"

namespace weft::bench {
namespace {

using capture::LightFinding;
using capture::PatchLights;
using capture::ScanEvidence;
using test::Lighting;
using test::SimulatedCloth;

constexpr int kSide = 480;      // photosites
constexpr int kRepeat = -1;     // in the place of a LED: its shot is LED 1 once more
constexpr int kDarkAgain = -2;  // the dark shot at the end

/// What lights the shot of a LED (0: dark).
using Story = std::function<Lighting(int led)>;

Lighting plain(int led) {
  if (led == 0 || led == kDarkAgain) return {};
  return {{{led == kRepeat ? 1 : led, 1.0}}, 0};
}

/// What a scan says of a story.
struct Told {
  LightFinding finding = LightFinding::kAgrees;
  std::string sentence;
  bool warned = false;
  double least_level = std::numeric_limits<double>::infinity(), most_level = 0, misfit = 0;

  bool is_refused() const { return finding != LightFinding::kAgrees; }
};

/// A cloth of which sessions are told. Light adds up, and so do glances at it: each LED is photographed
/// twice, and every story of a session is a sum.
class Stage {
 public:
  Stage(const SimulatedCloth& cloth, PatchLights model) : cloth_(cloth), model_(std::move(model)) {
    const ScanEvidence evidence(model_.grid, model_);
    std::uint32_t take = 1;
    const auto glance = [&](const Lighting& lighting) {
      return evidence.glance(cloth.photograph(lighting, cloth.scene_exposure_us(), take++));
    };
    dark_ = glance({});
    room_ = less_dark(glance({{}, 0.3}), 1 / 0.3);
    for (int led = 1; led <= cloth.leds(); ++led) {
      for (auto& takes : leds_) takes.push_back(less_dark(glance({{{led, 1.0}}, 0}), 1));
    }
  }

  int leds() const { return cloth_.leds(); }

  /// A session as scan() takes it, up to the first frame that is refused.
  Told tell(const Story& story) const {
    ScanEvidence evidence(model_.grid, model_);
    Told told;
    std::vector<int> leds(static_cast<std::size_t>(cloth_.leds()));
    std::iota(leds.begin(), leds.end(), 1);
    for (const auto& shot : capture::plan_shots({leds, true, {}}, {cloth_.scene_exposure_us(), 100, 8}, {})) {
      std::vector<double> light = seen(story(told_as(shot)), shot.role == ShotRole::kRepeat);
      const capture::ShotVerdict verdict = evidence.judge(shot, light);
      if (shot.role == ShotRole::kLit && verdict.level) {
        told.least_level = std::min(told.least_level, *verdict.level);
        told.most_level = std::max(told.most_level, *verdict.level);
        told.misfit = std::max(told.misfit, verdict.misfit.value_or(0));
      }
      told.warned = told.warned || !verdict.warnings.empty();
      told.finding = verdict.finding;
      told.sentence = verdict.sentence;
      if (told.is_refused()) break;
      evidence.accept(shot, std::move(light));
    }
    return told;
  }

  /// Frames that a finished session has of light that was put out: it comes on with a LED's shot, whoever
  /// scans mends it at the first refusal, and what was accused is taken again.
  int wrong_at_the_end(int from, const Story& with_light) const {
    ScanEvidence evidence(model_.grid, model_);
    std::vector<int> leds(static_cast<std::size_t>(cloth_.leds()));
    std::iota(leds.begin(), leds.end(), 1);
    const auto plan = capture::plan_shots({leds, true, {}}, {cloth_.scene_exposure_us(), 100, 8}, {});
    std::set<int> wrong, missing;
    for (const auto& shot : plan) missing.insert(shot.index);
    bool is_mended = false;
    for (int takes = 0; !missing.empty() && takes < 100; ++takes) {
      const auto& shot = plan[static_cast<std::size_t>(*missing.begin())];
      const bool is_repeat = shot.role == ShotRole::kRepeat;
      const bool is_wrong = !is_mended && (is_repeat || shot.led >= from);
      const Story story = is_wrong ? with_light : plain;
      std::vector<double> light = seen(story(told_as(shot)), is_repeat);
      const capture::ShotVerdict verdict = evidence.judge(shot, light);
      if (verdict.finding != LightFinding::kAgrees) {
        is_mended = true;
        for (const auto& accused : plan) {
          if (accused.index == 0 ||
              !(verdict.accuses_all || std::ranges::count(verdict.accused, accused.index)))
            continue;
          evidence.forget(accused.index);
          wrong.erase(accused.index);
          missing.insert(accused.index);
        }
        continue;
      }
      missing.erase(shot.index);
      if (is_wrong) wrong.insert(shot.index);
      evidence.accept(shot, std::move(light));
    }
    return static_cast<int>(wrong.size() + missing.size());
  }

 private:
  static int told_as(const capture::DueShot& shot) {
    if (shot.role != ShotRole::kRepeat) return shot.led;
    return shot.led == 0 ? kDarkAgain : kRepeat;
  }

  std::vector<double> less_dark(std::vector<double> light, double times) const {
    for (std::size_t i = 0; i < light.size(); ++i) light[i] = times * (light[i] - dark_[i]);
    return light;
  }

  std::vector<double> seen(const Lighting& lighting, bool again) const {
    std::vector<double> sum = dark_;
    const auto add = [&](const std::vector<double>& light, double times) {
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += times * light[i];
    };
    for (const auto& [led, share] : lighting.leds)
      add(leds_[again][static_cast<std::size_t>(led - 1)], share);
    if (lighting.room > 0) add(room_, lighting.room);
    std::ranges::replace_if(
        sum, [](double v) { return v >= 1; }, std::numeric_limits<double>::quiet_NaN());
    return sum;
  }

  const SimulatedCloth& cloth_;
  PatchLights model_;
  std::vector<double> dark_, room_;
  std::array<std::vector<std::vector<double>>, 2> leds_;
};

/// Sessions with two LEDs exchanged.
std::string exchanged(const Stage& stage) {
  int named = 0, refused = 0, tried = 0;
  for (int a = 1; a <= stage.leds(); ++a) {
    for (int b = a + 1; b <= stage.leds(); b += 1 + (a + b) % 3) {
      const Told told = stage.tell([=](int led) {
        return plain(led == a ? b : led == b ? a : led == kRepeat && a == 1 ? b : led);
      });
      const auto names = [&](int led) {
        return told.sentence.find(fmt::format("LED {} ", led)) != std::string::npos;
      };
      named += names(a) && names(b);
      refused += told.is_refused();
      ++tried;
    }
  }
  return fmt::format("{}/{}/{}", named, refused, tried);
}

/// Sessions in which a LED stays lit from the shot after its own on.
std::string stays_lit(const Stage& stage) {
  int named = 0, refused = 0;
  for (int a = 1; a <= stage.leds(); ++a) {
    const Told told = stage.tell([=](int led) {
      Lighting light = plain(led);
      if (led > a || led < 0) light.leds[a] = 1;
      return light;
    });
    named += told.sentence == fmt::format("LED {} stays lit", a);
    refused += told.is_refused();
  }
  return fmt::format("{}/{}/{}", named, refused, stage.leds());
}

Json row_of(const std::string& scene, const Stage& stage) {
  const Told right = stage.tell(plain);
  const int n = stage.leds();
  const auto count = [n](const auto& is_found) {
    int found = 0;
    for (int led = 1; led <= n; ++led) found += is_found(led);
    return fmt::format("{}/{}", found, n);
  };
  const auto with_room_light = [&](double light) {
    return count([&](int from) {
      return stage
          .tell([=](int led) {
            Lighting lighting = plain(led);
            if (led >= from || led < 0) lighting.room = light;
            return lighting;
          })
          .is_refused();
    });
  };
  const auto put_out = [&](double light) {
    return count([&](int from) {
      return stage.wrong_at_the_end(from, [=](int led) {
        Lighting lighting = plain(led);
        lighting.room = light;
        return lighting;
      }) == 0;
    });
  };
  const auto replaced = [&](int a) {
    return stage.tell([=](int led) { return plain(led == a ? a % n + 1 : led); }).is_refused();
  };
  const auto dead = [&](int a) {
    return stage.tell([=](int led) { return led == a ? Lighting() : plain(led); }).finding ==
           LightFinding::kDark;
  };
  const auto dim = [&](int a) {
    const Told told = stage.tell([=](int led) {
      Lighting light = plain(led);
      if (led == a) light.leds[a] = 0.4;
      return light;
    });
    return told.warned || told.is_refused();
  };
  return {{"scene", scene},
          {"false_alarm", right.is_refused()},
          {"false_warning", right.warned},
          {"least_level", right.least_level},
          {"most_level", right.most_level},
          {"misfit", right.misfit},
          {"exchanged", exchanged(stage)},
          {"replaced", count(replaced)},
          {"dead", count(dead)},
          {"dim", count(dim)},
          {"stays_lit", stays_lit(stage)},
          {"room_30", with_room_light(0.3)},
          {"room_10", with_room_light(0.1)},
          {"put_out_500", put_out(5)},
          {"put_out_100", put_out(1)},
          {"put_out_30", put_out(0.3)}};
}

}  // namespace

std::vector<std::string> evidence_scenes() {
  return {"flat", "plain",   "twill",           "satin",  "smooth", "plain_family", "deep",
          "demo", "knit",    "satin_sheen",     "velvet", "folds",  "movement",     "drift",
          "dyes", "shadows", "interreflection", "tilted", "rig"};
}

/// How often evidence by light is wrong: a row a scene, with an undisturbed session, and with sessions of
/// mixed-up, dead, weak and stuck LEDs and of room light as "refused/tried" ("exchanged" and "stays_lit":
/// "named rightly/refused/tried"). Errors: those of read_scene().
Result<Rows> capture_evidence_table(const StudyOptions& options) {
  Rows rows;
  const std::vector<std::string> scenes = evidence_scenes();
  for (const std::string& name : scenes) {
    Result<simulator::Scene> scene = simulator::read_scene(options.scenes / (name + ".toml"));
    if (!scene) return std::move(scene).error();
    const SimulatedCloth cloth(test::seen_from_afar(std::move(*scene), kSide));
    Result<PatchLights> model = PatchLights::make(cloth.calibration(), 0);
    if (!model) return std::move(model).error();
    rows.push_back(row_of(name, Stage(cloth, std::move(*model))));
    options.progress(static_cast<int>(rows.size()), static_cast<int>(scenes.size()));
  }
  return rows;
}

namespace {

constexpr std::array kCloths = {"smooth", "plain", "twill", "satin", "deep"};
constexpr std::array kBlurs_px = {0.0, 2.0, 4.0, 8.0};
constexpr double kFinest_px = 2;  // the simulator's disc is of whole pixels: a smaller one is none
constexpr int kRepeats = 20;      // photographs of each blur
constexpr int kWidth = 480, kHeight = 360;

struct Scores {
  double mean = 0, sigma = 0;
};

/// A corner of the cloth at its own scale, by one LED.
simulator::Scene cut(simulator::Scene scene, double blur_px) {
  scene.camera.width = kWidth;
  scene.camera.height = kHeight;
  scene.effects.defocus = true;
  scene.effects.noise = true;
  scene.camera.blur.defocus_px = blur_px;
  scene.lights.rings = {simulator::LedRing()};
  scene.lights.leds.clear();
  return scene;
}

Scores scores_of(const simulator::Scene& scene, int repeats) {
  const test::SimulatedCloth cloth(scene);
  const std::optional<Response>& response = cloth.calibration().response;
  const capture::PhotositeNoise noise = {response->electrons_per_count, response->read_noise_counts};
  double sum = 0, squares = 0;
  for (int i = 0; i < repeats; ++i) {
    const RawFrame frame =
        cloth.photograph({{{1, 1.0}}, 0}, cloth.scene_exposure_us(), static_cast<std::uint32_t>(i + 1));
    const double score = capture::focus_of(frame, noise).score;
    sum += score;
    squares += score * score;
  }
  const double mean = sum / repeats;
  return {mean, std::sqrt(std::max(squares / repeats - mean * mean, 0.0) * repeats / (repeats - 1))};
}

}  // namespace

/// How well the focus score tells blur. A row a cloth and diameter of the disc that blurs it, in raw pixels:
/// "score" (mean of the repeats), "drop" (percent of the score in focus), "sigmas" (that drop over the
/// standard deviation of a photograph's score), and for two pixels across "just_told_px", the diameter whose
/// drop is one sigma, the score falling with its square. By one LED; the lens's own spread is in all of them.
/// Errors: those of read_scene().
Result<Rows> capture_focus_table(const StudyOptions& options) {
  const int repeats = options.runs > 1 ? options.runs : kRepeats;
  Rows rows;
  int done = 0;
  for (const char* cloth : kCloths) {
    Result<simulator::Scene> scene = simulator::read_scene(options.scenes / (std::string(cloth) + ".toml"));
    if (!scene) return std::move(scene).error();
    Scores sharp;
    for (const double blur_px : kBlurs_px) {
      const Scores scores = scores_of(cut(*scene, blur_px), repeats);
      if (blur_px == 0) sharp = scores;
      const double drop = 1 - scores.mean / sharp.mean;
      const double sigmas = drop * sharp.mean / sharp.sigma;
      rows.push_back({{"cloth", cloth},
                      {"blur_px", blur_px},
                      {"score", scores.mean},
                      {"drop", 100 * drop},
                      {"sigmas", sigmas},
                      {"just_told_px",
                       blur_px == kFinest_px && sigmas > 0 ? Json(kFinest_px / std::sqrt(sigmas)) : Json()}});
      options.progress(++done, static_cast<int>(kCloths.size() * kBlurs_px.size()));
    }
  }
  return rows;
}

}  // namespace weft::bench
