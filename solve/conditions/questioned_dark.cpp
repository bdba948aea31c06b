// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/questioned_dark.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/percent.h"
#include "core/base/statistics.h"
#include "core/rig/dark_counts.h"
#include "core/rig/radiometry.h"
#include "solve/conditions/frame_words.h"
#include "solve/photographs/cell_noise.h"
#include "solve/photographs/spread_cells.h"
#include "solver/frame_fit/cell_fit.h"
#include "solver/frame_fit/room_light.h"

namespace weft::solve {
namespace {

constexpr double kBrighter = 0.9;   // of the dark shot's sites, in the order of their light
constexpr double kBlackErs = 1e-4;  // of full scale, by which black may lie beside its level
constexpr int kStep = 7;            // sites that are looked at; odd: of every colour

using Cell = std::array<std::array<float, 2>, 2>;

double level_at(const Cell& black, int x, int y) {
  return static_cast<double>(black[static_cast<std::size_t>(y & 1)][static_cast<std::size_t>(x & 1)]);
}

// How a dark shot follows the mean light of the frames, site by site: level + share * light.
struct DarkLight {
  double share = 0, sigma = 0;  // of their light
  double above = 0;             // what lies above the black level, of it, in step with it or not
  double bright = 0;            // its brighter tenth, of full scale above black
};

DarkLight light_of(const Mosaics& mosaics, const Cell& black) {
  const RawFrame& dark = *mosaics.dark;
  double n = 0, x_sum = 0, y_sum = 0, xx = 0, xy = 0, yy = 0;
  std::vector<double> light;
  for (int y = 0; y < dark.counts.height(); y += kStep) {
    for (int x = y % 2; x < dark.counts.width(); x += kStep) {
      const double level = level_at(black, x, y);
      const double own = static_cast<double>(dark.counts(x, y)) - level;
      light.push_back(own / (static_cast<double>(dark.white) - level));
      if (dark.cfa.channel_at(x, y) != 1) continue;
      double mean = 0;
      for (const RawFrame& frame : mosaics.frames)
        mean += (static_cast<double>(frame.counts(x, y)) - level) / static_cast<double>(mosaics.count());
      ++n, x_sum += mean, y_sum += own, xx += mean * mean, xy += mean * own, yy += own * own;
    }
  }
  DarkLight found;
  found.bright = quantile(std::move(light), kBrighter);
  if (x_sum > 0) found.above = std::max(0.0, y_sum - kBlackErs * static_cast<double>(dark.white) * n) / x_sum;
  const double spread = xx - x_sum * x_sum / n, both = xy - x_sum * y_sum / n, rest = yy - y_sum * y_sum / n;
  if (!(spread > 0) || n < 10) return {0, 1, 0, found.bright};
  found.share = both / spread;
  found.sigma = std::sqrt(std::max(0.0, rest - found.share * both) / (n - 2) / spread);
  return found;
}

// The dark shot with `share` of the frames' mean light more.
RawFrame with_room(const Mosaics& mosaics, const Cell& black, double share, int threads) {
  RawFrame dark = blank_like(mosaics.frames.front());
  const RawFrame* before = mosaics.dark ? &*mosaics.dark : nullptr;
  const double each = share / static_cast<double>(mosaics.count());
  parallel_for(static_cast<std::size_t>(dark.counts.height()), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < dark.counts.width(); ++x) {
      const double from =
          before != nullptr ? static_cast<double>(before->counts(x, y)) : level_at(black, x, y);
      double light = 0;
      for (const RawFrame& frame : mosaics.frames) light += static_cast<double>(frame.counts(x, y)) - from;
      constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
      dark.counts(x, y) =
          static_cast<std::uint16_t>(std::lround(std::clamp(from + each * light, 0.0, kMost)));
    }
  });
  return dark;
}

RawFrame without_light(const RawFrame& dark, const Cell& black) {
  RawFrame unlit = blank_like(dark);
  for (int y = 0; y < dark.counts.height(); ++y) {
    for (int x = 0; x < dark.counts.width(); ++x) {
      const double level = level_at(black, x, y);
      unlit.counts(x, y) = static_cast<std::uint16_t>(std::lround(std::max(0.0, level)));
    }
  }
  return unlit;
}

// Photographs looked at with one dark shot or another.
struct Look {
  solver::CellFit fit;
  solver::RoomShare room;
};

Look look_at(const Photographs& photographs, int threads) {
  const solver::FrameCells cells = spread_cells(photographs, threads);
  Look look;
  look.fit = solver::fit_cells(cells, threads);
  const std::vector<solver::FrameMisfit> misfits = solver::frame_misfits(cells, look.fit, threads);
  look.room =
      solver::find_room_light(cells, look.fit, misfits, cell_noise(cells, look.fit, photographs.noise()));
  return look;
}

class DarkShot {
 public:
  explicit DarkShot(const Exposures& exposures)
      : exposures_(exposures),
        photographs_(exposures.photographs),
        mosaics_(*exposures.photographs.mosaics()),
        threads_(exposures.context.threads),
        black_(black_counts(mosaics_.frames.front(), mosaics_.response)) {}

  void question() {
    const DarkLight light = mosaics_.dark ? light_of(mosaics_, black_) : DarkLight();
    const Look before = look_at(photographs_, threads_);
    if ((is_lit(light) || is_missed(light, before.room)) && set_aside(before, light)) return;
    if (before.room.is_told() && (before.room.share > 0 || explains(light, before.room))) take_off(before);
  }

 private:
  static bool is_lit(const DarkLight& light) {
    constexpr double kLeastShare = 0.003, kLeast_sigmas = 8;
    return std::abs(light.bright) > kDarkWarns ||
           (light.share > kLeastShare && light.share > kLeast_sigmas * light.sigma);
  }

  // A dark shot can have too much light only where it is seen to have some.
  static bool explains(const DarkLight& light, const solver::RoomShare& room) {
    constexpr double kMostOf = 0.5;
    return is_lit(light) && light.share > kMostOf * std::abs(room.share);
  }

  // A dark shot above black whose frames lack about as much light.
  static bool is_missed(const DarkLight& light, const solver::RoomShare& room) {
    constexpr double kLeastAbove = 0.003, kMostTimes = 3;
    return light.above > kLeastAbove && room.alone < 0 && -room.alone < kMostTimes * light.above;
  }

  // Whether the frames fit better without the light of the dark shot: that they lack it.
  bool set_aside(const Look& before, const DarkLight& light) {
    constexpr double kFitsBetter = 0.8;  // of sigma
    constexpr double kNearer = 0.3;      // of the dark shot's light: by so much nearer to none is the room's
    RawFrame kept = std::move(*mosaics_.dark);
    mosaics_.set_dark(without_light(kept, black_));
    const Look after = look_at(photographs_, threads_);
    const double nearer = std::abs(before.room.alone) - std::abs(after.room.alone);
    const bool is_better = after.fit.sigma < kFitsBetter * before.fit.sigma ||
                           nearer > kNearer * std::abs(after.room.alone - before.room.alone);
    if (!is_better) {
      mosaics_.set_dark(std::move(kept));
      return false;
    }
    const solver::CellChange change = solver::change_of(after.fit, before.fit);
    say({"DARK_SHOT",
         fmt::format(
             "The dark shot is {}: it has {} percent of full scale that the frames have not, which {}; "
             "the black level stands in its place",
             light.bright > 0 ? "lit" : "darker than black", percent_words(std::abs(light.bright)),
             words_of(change)),
         "switch the lamps off; " + again()});
    note(before.room, change);
    return true;
  }

  void take_off(const Look& before) {
    const double share = before.room.share;
    mosaics_.set_dark(with_room(mosaics_, black_, share, threads_));
    const Look after = look_at(photographs_, threads_);
    const solver::CellChange change = solver::change_of(after.fit, before.fit);
    const std::string amount = fmt::format("{} percent of what they gather (sigma {})",
                                           percent_words(std::abs(share)), percent_words(before.room.sigma));
    say({"ROOM_LIGHT",
         share > 0
             ? fmt::format("Light of the room is in all frames and {}: {}, which {}; it was taken off",
                           mosaics_.dark ? "the dark shot lacks it" : "there is no dark shot", amount,
                           words_of(change))
             : fmt::format(
                   "The dark shot has light that the frames have not: {}, which {}; that was given back",
                   amount, words_of(change)),
         share > 0
             ? "darken the room, or leave the light as it is and the cap off for the dark shot; " + again()
             : "darken the room; " + again()});
    note(before.room, change);
  }

  std::string again() const { return how_again(exposures_, 0); }
  void say(Verdict verdict) {
    lend(std::get<Mosaics>(exposures_.beside.repeats));
    for (std::optional<Frames>* more : {&photographs_.parallel, &exposures_.beside.blade}) {
      if (*more) lend(std::get<Mosaics>(**more));
    }
    photographs_.conditions.of_frames.push_back(std::move(verdict));
  }
  void lend(Mosaics& others) const {
    if (!others.frames.empty()) others.lend_dark(mosaics_);
  }
  void note(const solver::RoomShare& room, const solver::CellChange& change) {
    photographs_.conditions.facts.room = {room.share, room.sigma, change.turned_deg, change.albedo};
  }

  const Exposures& exposures_;
  Photographs& photographs_;
  Mosaics& mosaics_;
  int threads_;
  Cell black_;
};

}  // namespace

Result<void> question_dark(const Exposures& exposures) {
  if (!exposures.plan.asks_frames || exposures.photographs.mosaics() == nullptr) return {};
  DarkShot(exposures).question();
  return {};
}

}  // namespace weft::solve
