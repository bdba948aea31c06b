// SPDX-License-Identifier: Apache-2.0
#include "bench/calibration/studies.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/oracles/board_views.h"
#include "bench/oracles/paper_oracle.h"
#include "calibration/camera/lens.h"
#include "calibration/lights/physical.h"
#include "calibration/lights/sheet_blocks.h"
#include "core/parallel.h"

namespace weft::bench {
namespace {

using calibration::BoardView;
using calibration::LensFit;
using calibration::LightFit;
using calibration::Pose;
using test::BoardRig;
using test::PaperRig;

constexpr double kCorner_px = 0.1;

/// What a fit that was accepted is off by.
struct Outcome {
  std::vector<double> errors, sigmas;  ///< alike in number
  std::optional<double> chi_square;

  void add(double error, double sigma) {
    errors.push_back(error);
    sigmas.push_back(sigma);
  }
};

struct DegenerateCase {
  std::string name, kind, unit;
  std::function<std::optional<Outcome>(int seed)> run;  ///< nothing: refused
};

/// 8 x 5 blocks, each with the noise of the eleven that it stands for of 26 x 17.
std::optional<Outcome> lights(const PaperRig& rig, int seed) {
  test::PaperErrors errors;
  errors.seed = static_cast<std::uint64_t>(seed);
  errors.noise = 0.002 / std::sqrt(11.0);
  const test::PaperCaptures captures = test::captures_of(rig, errors, 8, 5);
  const Result<LightFit> fit = fit_lights(captures.start, captures.readings, {});
  if (!fit || fit->misfits()) return {};
  Outcome outcome;
  outcome.chi_square = fit->chi_square;
  for (std::size_t k = 0; k < rig.lights.leds.size(); ++k) {
    const Vec3 off = fit->scene.lights.leds[k].position_mm - rig.lights.leds[k].position_mm;
    const Vec3 sigma = fit->position_sigma_mm[k];
    outcome.add(off.x, sigma.x);
    outcome.add(off.y, sigma.y);
    outcome.add(off.z, sigma.z);
  }
  return outcome;
}

std::optional<Outcome> camera(const BoardRig& rig, const std::vector<BoardView>& views,
                              const calibration::LensOptions& options = {}) {
  const Result<LensFit> fit = fit_lens(views, rig.camera.size, options);
  if (!fit) return {};
  Outcome outcome;
  outcome.chi_square = std::pow(fit->corner_sigma_px / kCorner_px, 2);
  const auto add = [&](double CameraModel::*value) {
    outcome.add(fit->camera.*value - rig.camera.*value,
                calibration::propagated(fit->camera, fit->covariance,
                                        [=](const CameraModel& c) { return c.*value; }));
  };
  for (double CameraModel::*value : {&CameraModel::fx, &CameraModel::fy, &CameraModel::cx, &CameraModel::cy})
    add(value);
  return outcome;
}

/// A frame of white paper, every photosite with noise of its own, averaged in blocks and those to one.
std::optional<Outcome> sum(int seed) {
  constexpr Size kFrame = {16384, 6400};
  constexpr int kSide = 16;
  constexpr float kWhite = 1e6f, kNoise = 3e3f;  // a float has 24 bits: its own sum would end at 1.7e13
  calibration::BlockGrid grid(kFrame, kSide);
  Image<float> band({kFrame.width, kSide});
  std::uint64_t state = static_cast<std::uint64_t>(seed);
  std::vector<std::array<int, 2>> places;
  for (int row = 0; row < grid.rows; ++row) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kFrame.width; ++x) {
        state = 6364136223846793005u * state + 1442695040888963407u;  // Knuth, MMIX
        band(x, y) = kWhite + kNoise * (static_cast<float>(state >> 40) * 0x1p-23f - 1);
      }
    }
    average_row(grid, row, band.plane(), CfaPattern{});
    for (int column = 0; column < grid.columns; ++column) places.push_back({column, row});
  }
  const calibration::MergedBlock merged = merge(grid, places);
  Outcome outcome;
  for (std::size_t c = 0; c < 3; ++c)
    outcome.add(merged.reading_rgb[c] / kWhite - 1, merged.relative_sigma[c]);
  return outcome;
}

std::vector<DegenerateCase> all_cases() {
  const PaperRig common = test::common_rig();
  PaperRig low = common, edge_on = common, on_axis = common, equal = common, one = common;
  low.sheets = test::lies(5, 1.5);
  edge_on.sheets.back().tilt_deg = 84;
  on_axis.lights.leds[0].position_mm = {0, 0, 590};
  on_axis.lights.leds[0].aim = {0, 0, -1};
  equal.sheets.assign(5, {});
  one.sheets = test::lies(1);
  PaperRig one_not_lambertian = one;
  one_not_lambertian.delta = 0.05;
  const auto lights_of = [](const PaperRig& rig) { return [rig](int seed) { return lights(rig, seed); }; };

  BoardRig low_boards, edge_on_board;
  low_boards.tilts_deg = {1.5, 0.9, 0.45};
  edge_on_board.tilts_deg = {30, 84, 25};
  const auto boards = [](const BoardRig& rig, const calibration::LensOptions& options = {}) {
    return [rig, options](int seed) { return camera(rig, views_of(rig, kCorner_px, seed), options); };
  };
  const auto again = [](int seed) {
    const BoardRig rig;
    const std::vector<Pose> poses(static_cast<std::size_t>(rig.boards), poses_of(rig, seed)[1]);
    return camera(rig, views_of(rig, poses, kCorner_px, seed));
  };
  const auto once = [](int seed) {
    const BoardRig rig;
    return camera(rig, views_of(rig, {poses_of(rig, seed)[0]}, kCorner_px, seed));
  };
  return {
      {"all tilts under 2 degrees", "lights", "mm", lights_of(low)},
      {"all tilts under 2 degrees", "camera", "px", boards(low_boards)},
      {"all tilts under 2 degrees, told to accept 3 percent of focal length", "camera", "px",
       boards(low_boards, {.most_focal_sigma = 0.03})},
      {"seen edge-on, 84 degrees: one sheet of five", "lights", "mm", lights_of(edge_on)},
      {"seen edge-on, 84 degrees: every third board", "camera", "px", boards(edge_on_board)},
      {"a LED on the optical axis", "lights", "mm", lights_of(on_axis)},
      {"one pose, five times", "lights", "mm", lights_of(equal)},
      {"one pose, fifteen times", "camera", "px", again},
      {"one flat sheet", "lights", "mm", lights_of(one)},
      {"one flat sheet, paper 5 percent off Lambert's law", "lights", "mm", lights_of(one_not_lambertian)},
      {"one flat board", "camera", "px", once},
      {"mean of 105 megapixels", "sum", "of white", sum}};
}

Json row_of(const DegenerateCase& c, const std::vector<std::optional<Outcome>>& outcomes) {
  double squares = 0, variances = 0, worst = 0, n = 0;
  int refused = 0;
  std::optional<double> least, most;
  for (const auto& outcome : outcomes) {
    if (!outcome) {
      ++refused;
      continue;
    }
    for (std::size_t i = 0; i < outcome->errors.size(); ++i, ++n) {
      const double sigma = outcome->sigmas[i], over = std::abs(outcome->errors[i]) / sigma;
      squares += over * over;
      variances += sigma * sigma;
      worst = std::max(worst, over);
    }
    if (!outcome->chi_square) continue;
    least = std::min(least.value_or(*outcome->chi_square), *outcome->chi_square);
    most = std::max(most.value_or(*outcome->chi_square), *outcome->chi_square);
  }
  const auto told = [](bool known, double value) { return known ? Json(value) : Json(); };
  return {{"case", c.name},
          {"kind", c.kind},
          {"seeds", outcomes.size()},
          {"refused", refused},
          {"predicted sigma, rms", told(n > 0, std::sqrt(variances / n))},
          {"unit", c.unit},
          {"error over sigma, rms", told(n > 0, std::sqrt(squares / n))},
          {"error over sigma, worst", told(n > 0, worst)},
          {"chi-square, least", told(least.has_value(), least.value_or(0))},
          {"chi-square, most", told(most.has_value(), most.value_or(0))},
          {"asked", "refused, or within its sigma"}};
}

}  // namespace

/// Captures that cannot say what is asked of them: all tilts under 2 degrees, a board or sheet seen edge-on,
/// a LED on the optical axis, one pose taken again and again, one sheet or board, the sum of 100 megapixels.
/// A row a case and kind ("lights": positions of LEDs, "camera": focal lengths and principal point, "sum":
/// the mean of white paper by channel), made by formulas of their own (bench/oracles/paper_oracle.h,
/// bench/oracles/board_views.h): in how many of `seeds` it is `refused` (by an error or as a misfit), and of
/// those accepted the predicted sigma (rms, in `unit`), the error over it (rms and worst) and the least and
/// most chi-square a degree of freedom, where the fit has one. The camera's is of the corners' noise that was
/// put in.
Result<Rows> calibration_degenerate_table(const StudyOptions& options) {
  if (options.runs < 1 || options.runs > 1000) {
    return Error{ErrorKind::kUsage, "number of seeds is out of its range", "seeds", "it is 1 to 1000",
                 "give a number in that range"};
  }
  Rows rows;
  for (const DegenerateCase& c : all_cases()) {
    std::vector<std::optional<Outcome>> outcomes(static_cast<std::size_t>(options.runs));
    parallel_for(outcomes.size(), options.threads,
                 [&](std::size_t i, int) { outcomes[i] = c.run(static_cast<int>(i) + 1); });
    rows.push_back(row_of(c, outcomes));
  }
  return rows;
}

}  // namespace weft::bench
