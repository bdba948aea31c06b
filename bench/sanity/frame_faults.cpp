// SPDX-License-Identifier: Apache-2.0
#include "bench/sanity/frame_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "bench/oracles/simulated_cloth.h"
#include "bench/sanity/drawn_cloth.h"
#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/base/vec.h"
#include "solve/conditions/conditions.h"
#include "solve/photographs/spread_cells.h"
#include "solver/frame_fit/cell_fit.h"

namespace weft::bench {
namespace {

using test::Lighting;
using test::SimulatedCloth;

// Others than those that thresholds were chosen on: smooth, plain_family, deep, dyed_twill, satin, knit,
// folds, velvet, gloss_satin, gloss_coated.
constexpr std::array kCloths = {
    "cotton",      "twill",        "plain",           "shadows",          "dyes",
    "satin_sheen", "gloss_velvet", "gloss_wool_pair", "gloss_dark_satin", "gloss_satin_weave"};
constexpr int kWidth = 320;
constexpr double kMatters_deg = 0.1, kMattersAlbedo = 0.01;

// A session before it is solved.
struct FramesOfRig {
  std::vector<RawFrame> lit;
  RawFrame dark;
};

// What a fault is drawn from.
struct Take {
  const SimulatedCloth& cloth;
  std::uint32_t seed;

  RawFrame of(const Lighting& lighting, std::uint32_t shot) const {
    return cloth.photograph(lighting, cloth.scene_exposure_us(), 100 * seed + shot);
  }
};

double black_of(const RawFrame& frame) {
  return static_cast<double>(frame.black[0][0]);
}

template <typename Change>
void change_counts(RawFrame& frame, const Change& change) {
  const double white = static_cast<double>(frame.white);
  for (int y = 0; y < frame.counts.height(); ++y) {
    for (int x = 0; x < frame.counts.width(); ++x) {
      const double count = change(x, y, static_cast<double>(frame.counts(x, y)));
      frame.counts(x, y) = static_cast<std::uint16_t>(std::lround(std::clamp(count, 0.0, white)));
    }
  }
}

void flicker(FramesOfRig& frames, Draws& draws, bool is_square, bool all) {
  const double share = draws.of_ratio(0.002, 0.2);
  const double period = draws.of_ratio(9, 0.4 * frames.lit.front().counts.height());
  const auto only = static_cast<std::size_t>(draws.below(static_cast<int>(frames.lit.size())));
  for (std::size_t k = 0; k < frames.lit.size(); ++k) {
    const double phase = draws.between(0, 2 * kPi);
    if (!all && k != only) continue;
    const double black = black_of(frames.lit[k]);
    change_counts(frames.lit[k], [&](int, int y, double count) {
      const double wave = std::sin(2 * kPi * y / period + phase);
      return black + (count - black) * (1 + share * (is_square ? (wave < 0 ? -1 : 1) : wave));
    });
  }
}

struct FrameFault {
  const char* name;
  std::vector<const char*> verdicts;
  void (*make)(FramesOfRig&, const Take&, Draws&);
};

std::size_t any_light(const FramesOfRig& frames, Draws& draws) {
  return static_cast<std::size_t>(draws.below(static_cast<int>(frames.lit.size())));
}

void add_room(FramesOfRig& frames, const Take& take, Draws& draws) {
  const double room = draws.of_ratio(0.002, 0.3);
  for (std::size_t k = 0; k < frames.lit.size(); ++k) {
    frames.lit[k] = take.of({{{static_cast<int>(k) + 1, 1.0}}, room}, static_cast<std::uint32_t>(k));
  }
}

const std::vector<FrameFault>& faults() {
  static const std::vector<FrameFault> all = {
      {"none", {}, [](FramesOfRig&, const Take&, Draws&) {}},
      {"room light, cap on for the dark shot", {"ROOM_LIGHT", "DARK_SHOT"}, add_room},
      {"lamp in the dark shot alone",
       {"ROOM_LIGHT", "DARK_SHOT"},
       [](FramesOfRig& frames, const Take& take, Draws& draws) {
         frames.dark = take.of({{}, draws.of_ratio(0.002, 0.3)}, 50);
       }},
      {"LED on in the dark shot",
       {"ROOM_LIGHT", "DARK_SHOT"},
       [](FramesOfRig& frames, const Take& take, Draws& draws) {
         frames.dark =
             take.of({{{static_cast<int>(any_light(frames, draws)) + 1, draws.of_ratio(0.02, 1)}}, 0}, 50);
       }},
      {"flicker of all lamps",
       {"ROWS_FLICKER"},
       [](FramesOfRig& frames, const Take&, Draws& draws) { flicker(frames, draws, false, true); }},
      {"square flicker of all lamps",
       {"ROWS_FLICKER"},
       [](FramesOfRig& frames, const Take&, Draws& draws) { flicker(frames, draws, true, true); }},
      {"flicker of one lamp",
       {"ROWS_FLICKER"},
       [](FramesOfRig& frames, const Take&, Draws& draws) { flicker(frames, draws, false, false); }},
      {"frame of another LED",
       {"FRAME_FITS_NOTHING"},
       [](FramesOfRig& frames, const Take& take, Draws& draws) {
         const std::size_t k = any_light(frames, draws);
         const auto other =
             (k + 1 + static_cast<std::size_t>(draws.below(static_cast<int>(frames.lit.size()) - 1))) %
             frames.lit.size();
         frames.lit[k] = take.of({{{static_cast<int>(other) + 1, 1.0}}, 0}, 60);
       }},
      {"frame turned by half",
       {"FRAME_FITS_NOTHING"},
       [](FramesOfRig& frames, const Take&, Draws& draws) {
         RawFrame& frame = frames.lit[any_light(frames, draws)];
         const RawFrame old = copy_of(frame);
         const int w = old.counts.width() - 1, h = old.counts.height() - 1;
         change_counts(frame,
                       [&](int x, int y, double) { return static_cast<double>(old.counts(w - x, h - y)); });
       }},
      {"rows off by one",
       {"FRAME_FITS_NOTHING"},
       [](FramesOfRig& frames, const Take&, Draws& draws) {
         RawFrame& frame = frames.lit[any_light(frames, draws)];
         const RawFrame old = copy_of(frame);
         change_counts(frame, [&](int x, int y, double) {
           return static_cast<double>(old.counts(x, std::max(0, y - 1)));
         });
       }},
      {"transfer cut",
       {"FRAME_IN_PART"},
       [](FramesOfRig& frames, const Take&, Draws& draws) {
         RawFrame& frame = frames.lit[any_light(frames, draws)];
         const double from = draws.between(0.05, 0.95) * frame.counts.height();
         change_counts(frame, [&](int, int y, double count) { return y < from ? count : 0; });
       }},
      {"LED late under a slit",
       {"FRAME_IN_PART", "FRAME_FITS_NOTHING"},
       [](FramesOfRig& frames, const Take&, Draws& draws) {
         RawFrame& frame = frames.lit[any_light(frames, draws)];
         const double black = black_of(frame), to = draws.between(0.03, 0.8) * frame.counts.height();
         change_counts(frame, [&](int, int y, double count) { return y < to ? black : count; });
       }},
      {"hand before a lamp",
       {"FRAME_IN_PART", "FRAME_FITS_NOTHING"},
       [](FramesOfRig& frames, const Take&, Draws& draws) {
         RawFrame& frame = frames.lit[any_light(frames, draws)];
         const double black = black_of(frame), light = draws.between(0, 0.6);
         const int w = frame.counts.width(), h = frame.counts.height();
         const double width = draws.between(0.15, 0.6) * w, height = draws.between(0.15, 0.6) * h;
         const double left = draws.between(-0.1, 0.8) * w, top = draws.between(-0.1, 0.8) * h;
         change_counts(frame, [&](int x, int y, double count) {
           const bool inside = x >= left && x < left + width && y >= top && y < top + height;
           return inside ? black + light * (count - black) : count;
         });
       }},
  };
  return all;
}

// A session in memory, as it is loaded.
class Loaded {
 public:
  static Result<Loaded> make(const SimulatedCloth& cloth, FramesOfRig frames) {
    Loaded loaded;
    loaded.plan_.calibration = cloth.calibration();
    loaded.plan_.asks_frames = true;
    loaded.plan_.size = frames.lit.front().counts.size();
    const double exposure_us = cloth.scene_exposure_us();
    for (std::size_t k = 0; k < frames.lit.size(); ++k) {
      Shot shot;
      shot.led = static_cast<int>(k) + 1;
      shot.exposure_us = exposure_us;
      loaded.plan_.lit.push_back(shot);
      loaded.photographs_.leds.push_back(shot.led);
    }
    solve::Mosaics mosaics(std::move(frames.lit), std::move(frames.dark), *cloth.calibration().response,
                           {exposure_us, 100});
    loaded.beside_.repeats = mosaics.alike({});
    loaded.photographs_.frames = std::move(mosaics);
    loaded.photographs_.size = loaded.plan_.size;
    loaded.photographs_.camera = cloth.calibration().camera;
    Result<LightField> field =
        LightField::make(*cloth.calibration().lights, cloth.calibration().camera, loaded.plan_.size, 0);
    if (!field) return std::move(field).error();
    loaded.photographs_.field = std::move(*field);
    return loaded;
  }
  Result<void> meet_conditions() {
    const JobContext context = {.threads = 1};
    return solve::meet_conditions({plan_, beside_, photographs_, context});
  }
  solver::CellFit fit() const { return solver::fit_cells(solve::spread_cells(photographs_, 1), 1); }
  const std::vector<Verdict>& verdicts() const { return photographs_.conditions.of_frames; }

 private:
  solve::SolvePlan plan_;
  solve::FramesBeside beside_;
  solve::Photographs photographs_;
};

Result<FrameOutcome> draw(const FrameFault& fault, const SimulatedCloth& cloth, std::uint32_t seed) {
  Draws draws(seed * 2654435761U + 17);
  const Take take = {cloth, seed};
  const auto frames = [&] {
    FramesOfRig made;
    for (int led = 1; led <= cloth.leds(); ++led)
      made.lit.push_back(take.of({{{led, 1.0}}, 0}, static_cast<std::uint32_t>(led - 1)));
    made.dark = take.of({}, 99);
    return made;
  };
  const Result<Loaded> right = Loaded::make(cloth, frames());
  if (!right) return right.error();
  FramesOfRig changed = frames();
  fault.make(changed, take, draws);
  Result<Loaded> wrong = Loaded::make(cloth, std::move(changed));
  if (!wrong) return wrong.error();
  const solver::CellFit truth = right->fit();
  const solver::CellChange before = solver::change_of(truth, wrong->fit());
  if (Result<void> met = wrong->meet_conditions(); !met) return std::move(met).error();
  FrameOutcome drawn;
  drawn.turned_deg = before.turned_deg;
  drawn.albedo = before.albedo;
  drawn.left_deg = solver::change_of(truth, wrong->fit()).turned_deg;
  for (const Verdict& verdict : wrong->verdicts()) {
    drawn.said += (drawn.said.empty() ? "" : " ") + verdict.name;
    drawn.is_told = true;
    drawn.is_named = drawn.is_named || std::ranges::any_of(fault.verdicts, [&](const char* name) {
                       return verdict.name == name;
                     });
  }
  return drawn;
}

Json row_of_fault(const FrameFault& fault, const std::vector<FrameOutcome>& all) {
  int matter = 0, named = 0, other = 0, rest = 0, told_of_rest = 0;
  std::vector<double> before, after;
  std::map<std::string, int> missed;
  for (const FrameOutcome& drawn : all) {
    const bool matters = drawn.turned_deg > kMatters_deg || std::abs(drawn.albedo) > kMattersAlbedo;
    if (!matters) {
      ++rest;
      told_of_rest += drawn.is_told;
      continue;
    }
    ++matter;
    named += drawn.is_named;
    other += !drawn.is_named && drawn.is_told;
    before.push_back(drawn.turned_deg);
    after.push_back(drawn.left_deg);
    if (!drawn.is_named) ++missed[drawn.cloth];
  }
  std::string on;
  for (const auto& [cloth, times] : missed)
    on += fmt::format("{}{} {}", on.empty() ? "" : ", ", cloth, times);
  const auto middle = [](std::vector<double> values) {
    return values.empty() ? Json() : Json(fmt::format("{:.2f}", median(std::move(values))));
  };
  return {{"fault", fault.name},
          {"matter", matter},
          {"named", named},
          {"otherwise", other},
          {"deg without", middle(before)},
          {"deg with", middle(after)},
          {"too small", rest},
          {"told", told_of_rest},
          {"not named on", on}};
}

}  // namespace

std::vector<std::string> frame_faults() {
  std::vector<std::string> names;
  for (const FrameFault& fault : faults()) names.emplace_back(fault.name);
  return names;
}

Result<FrameOutcome> outcome_of_frames(const std::string& fault, const SimulatedCloth& cloth,
                                       std::uint32_t seed) {
  const auto found = std::ranges::find(faults(), fault, &FrameFault::name);
  if (found == faults().end()) return Error{ErrorKind::kUsage, "no such fault", fault, "", ""};
  return draw(*found, cloth, seed);
}

Result<Rows> frame_faults_table(const FrameFaultOptions& asked, const StudyOptions& options) {
  std::vector<std::optional<SimulatedCloth>> cloths(kCloths.size());
  for (std::size_t i = 0; i < kCloths.size(); ++i) {
    Result<simulator::Scene> scene =
        simulator::read_scene(options.scenes / fmt::format("{}.toml", kCloths[i]));
    if (!scene) return std::move(scene).error();
    cloths[i].emplace(test::seen_from_afar(std::move(*scene), kWidth));
    options.progress(static_cast<int>(i), static_cast<int>(kCloths.size() + faults().size()));
  }
  Rows rows;
  for (const FrameFault& fault : faults()) {
    if (!asked.fault.empty() && asked.fault != fault.name) continue;
    std::vector<std::optional<Result<FrameOutcome>>> outcomes(static_cast<std::size_t>(options.runs));
    parallel_for(outcomes.size(), options.threads, [&](std::size_t i, int) {
      outcomes[i] = draw(fault, *cloths[i % kCloths.size()], static_cast<std::uint32_t>(options.seed + i));
    });
    std::vector<FrameOutcome> all;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      if (!*outcomes[i]) return outcomes[i]->error();
      FrameOutcome drawn = std::move(**outcomes[i]);
      drawn.cloth = kCloths[i % kCloths.size()];
      if (asked.lists)
        rows.push_back({{"fault", fault.name},
                        {"cloth", drawn.cloth},
                        {"deg", fmt::format("{:.3f}", drawn.turned_deg)},
                        {"albedo", fmt::format("{:+.3f}", drawn.albedo)},
                        {"left", fmt::format("{:.3f}", drawn.left_deg)},
                        {"said", drawn.said}});
      all.push_back(std::move(drawn));
    }
    if (!asked.lists) rows.push_back(row_of_fault(fault, all));
    options.progress(static_cast<int>(kCloths.size() + rows.size()),
                     static_cast<int>(kCloths.size() + faults().size()));
  }
  return rows;
}

}  // namespace weft::bench
