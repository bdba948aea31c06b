// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/questioned_frames.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/percent.h"
#include "solve/conditions/frame_words.h"
#include "solve/photographs/cell_noise.h"
#include "solve/photographs/spread_cells.h"
#include "solver/frame_fit/cell_fit.h"
#include "solver/frame_fit/frame_misfit.h"
#include "solver/frame_fit/row_waves.h"

namespace weft::solve {
namespace {

constexpr std::size_t kFewestRest = 5;    // frames that stay
constexpr double kMostAccused = 1.0 / 3;  // of the frames: else it is not the frames

// Rows of a mosaic whose counts are all one, and below black, in bands of rows that follow each other.
std::vector<Rect> rows_without_reading(const RawFrame& frame) {
  const Size size = frame.counts.size();
  const float black = std::min({frame.black[0][0], frame.black[0][1], frame.black[1][0], frame.black[1][1]});
  std::vector<Rect> bands;
  for (int y = 0; y < size.height; ++y) {
    const std::uint16_t* row = frame.counts.plane().row(y);
    if (!(static_cast<float>(row[0]) < black - 1)) continue;
    if (!std::all_of(row, row + size.width, [&](std::uint16_t count) { return count == row[0]; })) continue;
    if (bands.empty() || bands.back().y1 != y) bands.push_back({0, y, size.width, y});
    bands.back().y1 = y + 1;
  }
  return bands;
}

// What was done to frames until now.
std::vector<FrameMend> mends_of(const Photographs& photographs) {
  const Mosaics* mosaics = photographs.mosaics();
  if (mosaics == nullptr || mosaics->mends.empty()) return std::vector<FrameMend>(photographs.count());
  return mosaics->mends;
}

class FrameQuestions {
 public:
  explicit FrameQuestions(const Exposures& exposures)
      : exposures_(exposures),
        photographs_(exposures.photographs),
        threads_(exposures.context.threads),
        mends_(mends_of(photographs_)) {}

  Result<void> ask() {
    look_again();
    even_out_rows();
    note_frames();
    hide_parts();
    return leave_out_strangers();
  }

 private:
  std::string name(std::size_t k) const { return name_of(exposures_, k); }
  std::string again(std::size_t k) const { return how_again(exposures_, number_of(exposures_, k)); }
  void say(Verdict verdict) { photographs_.conditions.of_frames.push_back(std::move(verdict)); }

  void look_again() {
    cells_ = spread_cells(photographs_, threads_);
    fit_ = solver::fit_cells(cells_, threads_);
    misfits_ = solver::frame_misfits(cells_, fit_, threads_);
  }

  std::vector<std::size_t> strangers() const {
    std::vector<std::size_t> all;
    for (std::size_t k = 0; k < misfits_.size(); ++k) {
      if (misfits_[k].fits_nothing) all.push_back(k);
    }
    return all;
  }

  // A lamp that flickers much looks like a stranger until it is evened out; other strangers look like waves.
  void even_out_rows() {
    const std::vector<std::size_t> before = strangers();
    std::optional<solver::RowWaves> waves = solver::find_row_waves(cells_, fit_, {}, threads_);
    if (waves && !before.empty()) {
      const std::vector<FrameMend> kept = mends_;
      divide_by(*waves);
      const bool explains = fit_after_all(before);
      mends_ = kept;
      mend_frames(kept, photographs_.frames);
      look_again();
      if (!explains) waves = solver::find_row_waves(cells_, fit_, before, threads_);
    }
    if (!waves) return;
    const solver::CellFit left_alone = fit_;
    if (waves->are_even) divide_by(*waves);
    waves_ = std::move(waves);
    tell_waves(solver::change_of(fit_, left_alone));
  }

  // Whether some that looked like strangers fit as well as the others do.
  bool fit_after_all(const std::vector<std::size_t>& suspects) const {
    constexpr double kAsWell = 1.5;
    return std::ranges::any_of(suspects, [&](std::size_t k) {
      return !misfits_[k].fits_nothing && misfits_[k].missed < kAsWell * misfits_[k].typical;
    });
  }

  void divide_by(const solver::RowWaves& waves) {
    for (std::size_t k = 0; k < mends_.size(); ++k) {
      if (waves.gain[k].empty()) continue;
      std::vector<float>& gain = mends_[k].row_gain;
      gain.assign(static_cast<std::size_t>(photographs_.size.height), waves.gain[k].back());
      for (std::size_t y = 0; y < waves.gain[k].size() * kCellSide; ++y)
        gain[y] = waves.gain[k][y / kCellSide];
    }
    mend_frames(mends_, photographs_.frames);
    look_again();
  }

  // Frames whose light flickers, and by how much: in few words where it is that of all.
  std::string flickering() const {
    constexpr double kAlike = 1.25;
    std::vector<std::string> names;
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (std::size_t k = 0; k < mends_.size(); ++k) {
      if (waves_->gain[k].empty()) continue;
      const double amplitude = waves_->amplitude[k];
      least = std::min(least, amplitude), most = std::max(most, amplitude);
      names.push_back(fmt::format("{} by {} percent", name(k), percent_words(amplitude)));
    }
    if (names.size() == mends_.size() && most <= kAlike * least)
      return fmt::format("all {} frames by {} percent", names.size(), percent_words(most));
    return fmt::format("{}", fmt::join(names, ", "));
  }

  void tell_waves(const solver::CellChange& change) {
    const double period = kCellSide * waves_->period_rows;
    const double travel_s = exposures_.plan.session.shutter_travel_s;
    const double hertz = travel_s > 0 ? (photographs_.size.height - 1) / (travel_s * period) : 0;
    photographs_.conditions.facts.flicker = {period, hertz, waves_->sigma, change.turned_deg};
    const std::string done =
        waves_->are_even
            ? fmt::format("left alone, that turns the normals by {:.2g}\u00b0; it was evened out",
                          change.turned_deg)
            : "it was left as it is";
    say({"ROWS_FLICKER",
         fmt::format("Light flickers along the rows, {:.3g} rows from crest to crest{}: {} (sigma {}); {}",
                     period, hertz > 0 ? fmt::format(", {:.3g} hertz", hertz) : "", flickering(),
                     percent_words(waves_->sigma), done),
         "drive the LEDs by a steady current and not by pulses, and expose for whole periods of the mains"});
  }

  void note_frames() {
    const double noise = cell_noise(cells_, fit_, photographs_.noise());
    for (std::size_t k = 0; k < misfits_.size(); ++k) {
      FrameFitFacts& facts = photographs_.conditions.facts.frames.emplace_back();
      facts.led = number_of(exposures_, k);
      facts.missed = misfits_[k].missed;
      facts.sigma = noise;
      if (waves_ && !waves_->gain[k].empty()) facts.rows = waves_->amplitude[k];
    }
  }

  // Pixels of a part, which has cells.
  Rect pixels_of(const Rect& part) const {
    const std::vector<int> columns = columns_of_cells(photographs_);
    const auto x_of = [&](int column) {
      if (column <= 0) return 0;
      if (column >= static_cast<int>(columns.size())) return photographs_.size.width;
      return columns[static_cast<std::size_t>(column)];
    };
    return {x_of(part.x0), kCellSide * part.y0, x_of(part.x1),
            part.y1 >= cells_.rows ? photographs_.size.height : kCellSide * part.y1};
  }

  void hide_parts() {
    bool hides = false;
    for (std::size_t k = 0; k < misfits_.size(); ++k) {
      const solver::FrameMisfit& misfit = misfits_[k];
      if (!misfit.part) continue;
      const Rect part = pixels_of(*misfit.part);
      const solver::CellChange cost = cost_of(k, *misfit.part);
      mends_[k].missing.push_back(part);
      hides = true;
      FrameFitFacts& facts = photographs_.conditions.facts.frames[k];
      facts.part = {part.x0, part.y0, part.x1, part.y1};
      facts.costs_deg = cost.turned_deg;
      say({"FRAME_IN_PART",
           fmt::format(
               "A part of the frame of {} does not fit the others, {} percent of it, rows {} to {}, columns "
               "{} to {}: it has {} percent of the light that they predict; by least squares it {}; it was "
               "not read",
               name(k), percent_words(misfit.part_share), part.y0, part.y1 - 1, part.x0, part.x1 - 1,
               percent_words(std::max(0.0, misfit.part_light)), words_of(cost)),
           "see whether something lay before the lamp, or the LED came late; " + again(k)});
    }
    if (hides) mend_frames(mends_, photographs_.frames);
  }

  // What cells of a photograph do where every reading counts alike.
  solver::CellChange cost_of(std::size_t k, const Rect& part) const {
    solver::FrameCells without = cells_;
    for (int y = part.y0; y < part.y1; ++y) {
      for (int x = part.x0; x < part.x1; ++x)
        without.value[without.cell_at(x, y) * without.count + k] = std::numeric_limits<float>::quiet_NaN();
    }
    return solver::change_of(solver::plain_fit(without, threads_), solver::plain_fit(cells_, threads_));
  }

  // Two frames that show each other's LEDs are told by the diagnosis.
  bool are_exchanged(std::size_t k) const {
    const std::optional<std::size_t> other = misfits_[k].lit_by;
    return other && misfits_[*other].lit_by == k;
  }

  std::string cause_of(const solver::FrameMisfit& misfit) const {
    if (misfit.same_as) return fmt::format("; it shows what that of {} shows", name(*misfit.same_as));
    if (misfit.lit_by) return fmt::format("; it would be right for {}", name(*misfit.lit_by));
    if (misfit.is_turned) return "; it would fit if it were turned by half";
    return "";
  }

  Result<void> leave_out_strangers() {
    std::vector<std::size_t> accused = strangers();
    std::erase_if(accused, [&](std::size_t k) { return are_exchanged(k); });
    const std::size_t count = photographs_.count();
    if (accused.empty() || count - accused.size() < kFewestRest ||
        static_cast<double>(accused.size()) > kMostAccused * static_cast<double>(count))
      return {};
    for (const std::size_t k : accused) {
      const solver::FrameMisfit& misfit = misfits_[k];
      const solver::CellChange cost = cost_of(k, {0, 0, cells_.columns, cells_.rows});
      photographs_.conditions.facts.frames[k].costs_deg = cost.turned_deg;
      say({"FRAME_FITS_NOTHING",
           fmt::format(
               "The frame of {} fits none of the others: what they predict is missed by {} percent, in the "
               "others by {}{}; by least squares it {}; it was left out",
               name(k), percent_words(misfit.missed), percent_words(misfit.typical), cause_of(misfit),
               words_of(cost)),
           "see whether it is the right photograph and nothing moved; " + again(k)});
      photographs_.conditions.facts.left_out.push_back({number_of(exposures_, k), "fits nothing"});
    }
    return leave_out(accused, photographs_);
  }

  const Exposures& exposures_;
  Photographs& photographs_;
  int threads_;
  std::vector<FrameMend> mends_;
  solver::FrameCells cells_;
  solver::CellFit fit_;
  std::optional<solver::RowWaves> waves_;
  std::vector<solver::FrameMisfit> misfits_;
};

}  // namespace

Result<void> hide_unread_rows(const Exposures& exposures) {
  Photographs& photographs = exposures.photographs;
  const Mosaics* mosaics = photographs.mosaics();
  if (mosaics == nullptr) return {};
  std::vector<FrameMend> mends(mosaics->count());
  parallel_for(mends.size(), exposures.context.threads,
               [&](std::size_t k, int) { mends[k].missing = rows_without_reading(mosaics->frames[k]); });
  bool hides = false;
  for (std::size_t k = 0; k < mends.size(); ++k) {
    const std::vector<Rect>& bands = mends[k].missing;
    if (bands.empty()) continue;
    hides = true;
    int rows = 0;
    for (const Rect& band : bands) rows += band.height();
    photographs.conditions.of_frames.push_back(
        {"FRAME_IN_PART",
         fmt::format("The frame of {} holds one count, below black, in {} rows from {} to {}: its transfer "
                     "broke off; "
                     "they are not read",
                     name_of(exposures, k), rows, bands.front().y0, bands.back().y1 - 1),
         how_again(exposures, number_of(exposures, k))});
  }
  if (hides) mend_frames(std::move(mends), photographs.frames);
  return {};
}

Result<void> question_frames(const Exposures& exposures) {
  if (!exposures.plan.asks_frames || exposures.photographs.mosaics() == nullptr) return {};
  return FrameQuestions(exposures).ask();
}

}  // namespace weft::solve
