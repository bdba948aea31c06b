// SPDX-License-Identifier: Apache-2.0
#include "solver/frame_fit/frame_misfit.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "solver/frame_fit/tilt_law.h"

namespace weft::solver {
namespace {

constexpr std::size_t kFewestLights = 6;
constexpr double kIsMatt = 0.03;         // of the brightness: who is missed by more shines
constexpr int kAcross = 16, kDown = 12;  // blocks of the frame
constexpr double kPartFrom = 0.15;       // of the brightness: a block that is missed by it does not fit
constexpr double kPartTimes = 6;         // and by so many times the blocks of all frames
constexpr double kLeastPart = 0.015, kMostPart = 0.7;  // of the frame
// What makes a copy or a turned frame where nothing fits well: it is missed by so much more than the others;
// is this share as far from its twin as photographs are from theirs, or from what is predicted turned.
constexpr double kFitsLess = 1.2, kCopyFrom = 0.3, kTurnedFrom = 0.8;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double predicted(const FrameCells& cells, const CellFit& fit, std::size_t cell, std::size_t k) {
  const std::size_t at = cell * cells.count + k;
  return static_cast<double>(cells.value[at]) -
         static_cast<double>(fit.error[at]) * static_cast<double>(fit.brightness[cell]);
}

// Light of the lit cells of a part over what is predicted; 1 where too few tell.
double light_in(const FrameCells& cells, const CellFit& fit, std::size_t k, const Rect& part) {
  constexpr std::size_t kFewest = 20;
  std::vector<double> ratios;
  for (int y = part.y0; y < part.y1; ++y) {
    for (int x = part.x0; x < part.x1; ++x) {
      const std::size_t cell = cells.cell_at(x, y);
      const double expected = predicted(cells, fit, cell, k);
      if (expected > static_cast<double>(kLitFrom * fit.brightness[cell]))
        ratios.push_back(static_cast<double>(cells.value[cell * cells.count + k]) / expected);
    }
  }
  return ratios.size() < kFewest ? 1 : std::max(0.0, median(std::move(ratios)));
}

// What a photograph is missed by, by cell: of the brightness, its gain taken off. NaN where nothing is known.
std::vector<float> errors_of(const FrameCells& cells, const CellFit& fit, std::size_t k, double gain) {
  std::vector<float> errors(cells.cells());
  for (std::size_t cell = 0; cell < errors.size(); ++cell) {
    const double value = static_cast<double>(cells.value[cell * cells.count + k]);
    errors[cell] = static_cast<float>((value - gain * predicted(cells, fit, cell, k)) /
                                      static_cast<double>(fit.brightness[cell]));
  }
  return errors;
}

// The median of what cells beyond a part are missed by.
double missed_beyond(const FrameCells& cells, const std::vector<float>& errors, const Rect& part) {
  std::vector<float> sizes;
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0; x < cells.columns; ++x) {
      const float error = errors[cells.cell_at(x, y)];
      const bool is_beyond = x < part.x0 || x >= part.x1 || y < part.y0 || y >= part.y1;
      if (is_beyond && std::isfinite(error)) sizes.push_back(std::abs(error));
    }
  }
  return static_cast<double>(median(std::move(sizes)));
}

// Medians of the errors of blocks.
std::vector<double> by_blocks(const FrameCells& cells, const std::vector<float>& errors) {
  std::vector<std::vector<float>> of_block(kAcross * kDown);
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0; x < cells.columns; ++x) {
      const auto block =
          static_cast<std::size_t>(y * kDown / cells.rows * kAcross + x * kAcross / cells.columns);
      if (const float error = errors[cells.cell_at(x, y)]; std::isfinite(error))
        of_block[block].push_back(error);
    }
  }
  std::vector<double> medians;
  for (std::vector<float>& block : of_block) medians.push_back(static_cast<double>(median(std::move(block))));
  return medians;
}

// The same where a cell's light is any function of how it leans, one for the whole frame.
std::vector<double> blocks_by_tilt(const FrameCells& cells, const CellFit& fit, std::size_t k) {
  return by_blocks(cells, errors_by_tilt(cells, fit, k, {1, 1}));
}

// The median of what photographs are missed by.
double typical_of(const std::vector<FrameMisfit>& misfits) {
  std::vector<double> all;
  for (const FrameMisfit& misfit : misfits) all.push_back(misfit.missed);
  return median(finite(std::move(all)));
}

// The largest part of blocks that touch and are too dark. Too bright is a highlight, but in a photograph that
// lacks light of most of its frame.
std::vector<std::size_t> largest_part(const std::vector<double>& blocks, double from, double gain) {
  constexpr double kLacksLight = 0.6;
  std::vector<bool> is_off(blocks.size());
  for (std::size_t i = 0; i < blocks.size(); ++i)
    is_off[i] = gain < kLacksLight ? std::abs(blocks[i]) > from : blocks[i] < -from;
  std::vector<std::size_t> largest;
  for (std::size_t start = 0; start < blocks.size(); ++start) {
    std::vector<std::size_t> part;
    if (is_off[start]) part.push_back(start), is_off[start] = false;
    for (std::size_t next = 0; next < part.size(); ++next) {
      const auto x = static_cast<int>(part[next]) % kAcross, y = static_cast<int>(part[next]) / kAcross;
      for (const auto& [dx, dy] : std::array<std::pair<int, int>, 4>{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}}) {
        const int u = x + dx, v = y + dy;
        if (u < 0 || v < 0 || u >= kAcross || v >= kDown) continue;
        const auto at = static_cast<std::size_t>(v * kAcross + u);
        if (is_off[at]) is_off[at] = false, part.push_back(at);
      }
    }
    if (part.size() > largest.size()) largest = std::move(part);
  }
  return largest;
}

// Cells of the blocks and one block more to each side, which may be half in it.
Rect around(const std::vector<std::size_t>& part, const FrameCells& cells) {
  int x0 = kAcross, y0 = kDown, x1 = 0, y1 = 0;
  for (const std::size_t block : part) {
    const auto x = static_cast<int>(block) % kAcross, y = static_cast<int>(block) / kAcross;
    x0 = std::min(x0, x - 1), x1 = std::max(x1, x + 2), y0 = std::min(y0, y - 1), y1 = std::max(y1, y + 2);
  }
  const auto along = [](int block, int blocks, int length) {
    return std::clamp(block, 0, blocks) * length / blocks;
  };
  return {along(x0, kAcross, cells.columns), along(y0, kDown, cells.rows), along(x1, kAcross, cells.columns),
          along(y1, kDown, cells.rows)};
}

constexpr std::size_t kEnoughCells = 10000;  // to tell photographs from each other

// What is left of photograph k where it is compared with `other`, of the brightness: its readings, through
// the best gain. Looks at up to twice kEnoughCells.
template <typename Other>
double difference(const FrameCells& cells, const CellFit& fit, std::size_t k, const Other& other) {
  const std::size_t step = std::max<std::size_t>(1, cells.cells() / kEnoughCells) | 1U;  // all columns
  double own = 0, both = 0;
  const auto each = [&](const auto& what) {
    for (std::size_t cell = 0; cell < cells.cells(); cell += step) {
      const double a = static_cast<double>(cells.value[cell * cells.count + k]) *
                       static_cast<double>(cells.strength[cell * cells.count + k]);
      const double b = other(cell);
      if (std::isfinite(a) && std::isfinite(b) && fit.brightness[cell] > 0) what(a, b);
    }
  };
  each([&](double a, double b) { own += b * b, both += a * b; });
  const double gain = own > 0 ? both / own : 0;
  std::vector<double> left, all;
  each([&](double a, double b) { left.push_back(std::abs(a - gain * b)), all.push_back(std::abs(a)); });
  return all.empty() ? kNone : median(std::move(left)) / median(std::move(all));
}

// What a photograph is missed by if its light may come from anywhere and be of any strength.
double missed_by_any_light(const FrameCells& cells, const CellFit& fit, std::size_t k) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const auto each = [&](const auto& what) {
    for (std::size_t cell = 0; cell < cells.cells(); ++cell) {
      const float value = cells.value[cell * cells.count + k];
      if (!is_lit(cells, fit, cell, k) || !(length(fit.normal[cell]) > 0)) continue;
      const double scale = 1 / static_cast<double>(fit.brightness[cell]);
      const Vec3 b = scale * fit.normal[cell];
      what(Eigen::Vector3d(b.x, b.y, b.z), scale * static_cast<double>(value));
    }
  };
  each([&](const Eigen::Vector3d& b, double value) { normal += b * b.transpose(), right += value * b; });
  const Eigen::Vector3d light = normal.ldlt().solve(right);
  std::vector<double> left;
  each([&](const Eigen::Vector3d& b, double value) { left.push_back(std::abs(value - b.dot(light))); });
  return median(std::move(left));
}

// What it is missed by if its light is any function of how a cell leans, as the other photographs tell that;
// and the same of it turned by half.
struct AnyLobe {
  double missed = 0, missed_turned = 0;
};

AnyLobe missed_by_any_lobe(const FrameCells& cells, std::size_t k) {
  FrameCells others = cells, turned = cells;
  for (std::size_t cell = 0; cell < cells.cells(); ++cell) {
    const std::size_t at = cell * cells.count + k, back = (cells.cells() - 1 - cell) * cells.count + k;
    others.value[at] = static_cast<float>(kNone);
    turned.value[at] = cells.value[back] * cells.strength[back] / cells.strength[at];
  }
  const CellFit fit = fit_cells(others, 1);
  return {missed_beyond(cells, errors_by_tilt(cells, fit, k), {}),
          missed_beyond(turned, errors_by_tilt(turned, fit, k), {})};
}

// Whether a photograph that fits nothing is one of this cloth all the same: its light comes from elsewhere,
// or all of the cloth lies in its highlight, which on cloth that is matt to the other lights is a faint one.
bool is_explained(const FrameCells& cells, const CellFit& fit, std::size_t k, const FrameMisfit& misfit) {
  constexpr double kExplained = 0.3, kExplainsFaint = 0.4;  // of what is missed
  constexpr double kFaint = 0.12;                           // of the brightness
  constexpr double kExplainsLittle = 0.4;                   // of its power, noise taken off
  if (missed_by_any_light(cells, fit, k) < kExplained * misfit.missed) return true;
  if (misfit.typical <= kIsMatt && misfit.missed > kFaint) return false;
  const double left = missed_by_any_lobe(cells, k).missed;
  if (misfit.missed > kMissedTimesOfGloss * misfit.typical)
    return left < (misfit.typical <= kIsMatt ? kExplainsFaint : kExplained) * misfit.missed;
  const double noise = std::pow(misfit.typical, 2);
  return left * left - noise < kExplainsLittle * (std::pow(misfit.missed, 2) - noise);
}

// What is left of photograph k beside photograph j.
double from_photograph(const FrameCells& cells, const CellFit& fit, std::size_t k, std::size_t j) {
  return difference(cells, fit, k, [&](std::size_t cell) {
    return static_cast<double>(cells.value[cell * cells.count + j]) *
           static_cast<double>(cells.strength[cell * cells.count + j]);
  });
}

// The same beside what is predicted of light j, and of its own where the photograph is turned.
double from_light(const FrameCells& cells, const CellFit& fit, std::size_t k, std::size_t j) {
  return difference(cells, fit, k, [&](std::size_t cell) {
    return predicted(cells, fit, cell, j) * static_cast<double>(cells.strength[cell * cells.count + j]);
  });
}
double from_turned(const FrameCells& cells, const CellFit& fit, std::size_t k) {
  return difference(cells, fit, k, [&](std::size_t cell) {
    const std::size_t back = cells.cells() - 1 - cell;
    return predicted(cells, fit, back, k) * static_cast<double>(cells.strength[back * cells.count + k]);
  });
}

// The photograph that is most like another one.
struct Twin {
  std::size_t of = 0;
  double difference = std::numeric_limits<double>::infinity();
};

Twin twin_of(const FrameCells& cells, const CellFit& fit, std::size_t k) {
  Twin twin;
  for (std::size_t j = 0; j < cells.count; ++j) {
    if (j == k) continue;
    if (const double left = from_photograph(cells, fit, k, j); left < twin.difference) twin = {j, left};
  }
  return twin;
}

double typical_difference(const std::vector<Twin>& twins) {
  std::vector<double> all;
  for (const Twin& twin : twins) all.push_back(twin.difference);
  return median(std::move(all));
}

// Whether a photograph fits the others better where it is turned by half: by Lambert's law, and not worse by
// any other, which on a weave that looks the same turned tells less.
bool fits_turned(const FrameCells& cells, const CellFit& fit, std::size_t k) {
  constexpr double kClearly = 0.5, kNotWorse = 0.95, kNotMuchWorse = 1.5;
  const double by_lambert = from_turned(cells, fit, k) / from_light(cells, fit, k, k);
  if (!(by_lambert < kTurnedFrom)) return false;
  const AnyLobe lobe = missed_by_any_lobe(cells, k);
  return lobe.missed_turned < (by_lambert < kClearly ? kNotMuchWorse : kNotWorse) * lobe.missed;
}

// Whose photograph one that fits nothing is, as far as that tells.
void find_cause(const FrameCells& cells, const CellFit& fit, std::size_t k, bool is_turned,
                FrameMisfit& misfit) {
  constexpr double kSame = 2.5;  // times what the others are missed by
  double least = kSame * misfit.typical;
  const double turned = from_turned(cells, fit, k);
  misfit.is_turned = is_turned || turned < least;
  if (misfit.is_turned) least = turned;
  for (std::size_t j = 0; j < cells.count; ++j) {
    const double left = from_light(cells, fit, k, j);
    if (j == k || !(left < least)) continue;
    least = left;
    misfit.lit_by = j;
    misfit.is_turned = false;
  }
}

}  // namespace

std::vector<FrameMisfit> frame_misfits(const FrameCells& cells, const CellFit& fit, int threads) {
  std::vector<FrameMisfit> all(cells.count);
  if (cells.count < kFewestLights) return all;
  const Rect whole = {0, 0, cells.columns, cells.rows};
  std::vector<std::vector<float>> errors(cells.count);
  std::vector<std::vector<double>> blocks(cells.count);
  parallel_for(cells.count, threads, [&](std::size_t k, int) {
    all[k].gain = light_in(cells, fit, k, whole);
    errors[k] = errors_of(cells, fit, k, all[k].gain);
    all[k].missed = missed_beyond(cells, errors[k], {});
  });
  const bool shines = typical_of(all) > kIsMatt;
  parallel_for(cells.count, threads, [&](std::size_t k, int) {
    blocks[k] = shines ? blocks_by_tilt(cells, fit, k) : by_blocks(cells, errors[k]);
  });
  std::vector<Twin> twins(cells.count);
  parallel_for(cells.count, threads, [&](std::size_t k, int) { twins[k] = twin_of(cells, fit, k); });
  const double typical_twin = typical_difference(twins);
  std::vector<double> sizes;
  for (const std::vector<double>& of_frame : blocks) {
    for (const double block : of_frame) {
      if (std::isfinite(block)) sizes.push_back(std::abs(block));
    }
  }
  constexpr double kMostOfFrames = 0.75;  // one of six may be off all over
  const double part_from = std::max(kPartFrom, kPartTimes * quantile(std::move(sizes), kMostOfFrames));
  parallel_for(cells.count, threads, [&](std::size_t k, int) {
    FrameMisfit& misfit = all[k];
    std::vector<double> others;
    for (std::size_t j = 0; j < cells.count; ++j) {
      if (j != k && std::isfinite(all[j].missed)) others.push_back(all[j].missed);
    }
    misfit.typical = median(std::move(others));
    const double times = misfit.typical > kIsMatt ? kMissedTimesOfGloss : kMissedTimes;
    const double fits_to = std::max(kMissedFrom, times * misfit.typical);
    const auto off = largest_part(
        blocks[k], shines ? part_from : std::max(part_from, kPartTimes * misfit.typical), misfit.gain);
    const double share = static_cast<double>(off.size()) / (kAcross * kDown);
    if (share >= kLeastPart && share <= kMostPart) {
      const Rect part = around(off, cells);
      if (missed_beyond(cells, errors[k], part) <= fits_to) {
        misfit.part = part;
        misfit.part_share = share;
        misfit.part_light = light_in(cells, fit, k, part);
      }
    }
    // Where little fits, what a wrong frame shows still fits it much better than its own place does.
    const Twin& twin = twins[k];
    const bool fits_less = misfit.missed > std::max(kMissedFrom, kFitsLess * misfit.typical);
    const bool is_copy =
        fits_less && twin.difference < kCopyFrom * typical_twin && misfit.missed > all[twin.of].missed;
    const bool is_turned = fits_less && !is_copy && fits_turned(cells, fit, k);
    if (is_copy || is_turned) misfit.part.reset();
    misfit.fits_nothing = is_copy || is_turned || (!misfit.part && misfit.missed > fits_to);
    if (!misfit.fits_nothing) return;
    if (is_copy) misfit.same_as = twin.of;
    if (!is_copy) find_cause(cells, fit, k, is_turned, misfit);
    const bool is_matt = misfit.typical <= kIsMatt;
    const bool is_told = is_copy || is_turned || (is_matt && (misfit.lit_by || misfit.is_turned));
    misfit.fits_nothing = is_told || !is_explained(cells, fit, k, misfit);
  });
  return all;
}

}  // namespace weft::solver
