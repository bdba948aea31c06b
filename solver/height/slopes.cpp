// SPDX-License-Identifier: Apache-2.0
#include "solver/height/slopes.h"

#include <cmath>
#include <utility>

#include "solver/height/row_bands.h"

namespace weft::solver {
namespace {

// One over the mean of the variances of two slopes whose weights are one over their variance.
float joint_weight(float a, float b) {
  return a + b > 0 ? 2 * a * b / (a + b) : 0.0f;
}

struct Tally {
  std::int64_t pixels = 0, clamped = 0;
  double right = 0, down = 0;
  float least = 0, most = 0;
  bool any = false;

  friend Tally operator+(const Tally& a, const Tally& b) {
    if (!a.any) return b;
    return {a.pixels + b.pixels,
            a.clamped + b.clamped,
            a.right + b.right,
            a.down + b.down,
            std::min(a.least, b.least),
            std::max(a.most, b.most),
            true};
  }
};

}  // namespace

void Slopes::read(int y, SlopeRow& row) const {
  const int width = size().width;
  for (auto* values : {&row.right, &row.down, &row.weight}) values->resize(static_cast<std::size_t>(width));
  row.clamped = 0;
  const float *nx = normal_[0].row(y), *ny = normal_[1].row(y), *nz = normal_[2].row(y);
  const std::uint8_t* mask = mask_.empty() ? nullptr : mask_.row(y);
  const double steepest_squared = steepest_ * steepest_;
  for (int x = 0; x < width; ++x) {
    const auto i = static_cast<std::size_t>(x);
    const double across = nx[x], up = ny[x], toward = nz[x];
    const double tilt_squared = across * across + up * up;
    const bool has_slope = std::isfinite(tilt_squared + toward * toward) && (tilt_squared > 0 || toward > 0);
    const float weight = mask ? static_cast<float>(mask[x]) : 1.0f;
    if (!has_slope || weight == 0) {
      row.right[i] = row.down[i] = row.weight[i] = 0;
      continue;
    }
    double per_tilt = 1 / toward;
    if (toward <= 0 || tilt_squared > steepest_squared * toward * toward) {
      per_tilt = steepest_ / std::sqrt(tilt_squared);
      ++row.clamped;
    }
    row.right[i] = static_cast<float>(-across * per_tilt);
    row.down[i] = static_cast<float>(up * per_tilt);
    row.weight[i] = weight;
  }
}

SlopeSurvey survey_of(const Slopes& slopes, int threads) {
  const Size size = slopes.size();
  const Tally tally = sum_over_bands(size.height, threads, [&](int y0, int y1) {
    Tally sum;
    SlopeRow row;
    for (int y = y0; y < y1; ++y) {
      slopes.read(y, row);
      Tally of_row = {0, row.clamped, 0, 0, row.weight[0], row.weight[0], true};
      for (std::size_t i = 0; i < row.weight.size(); ++i) {
        of_row.pixels += row.weight[i] > 0;
        of_row.right += row.right[i];
        of_row.down += row.down[i];
        of_row.least = std::min(of_row.least, row.weight[i]);
        of_row.most = std::max(of_row.most, row.weight[i]);
      }
      sum = sum + of_row;
    }
    return sum;
  });
  const double pixels = static_cast<double>(std::max<std::int64_t>(tally.pixels, 1));
  return {tally.pixels, tally.clamped, tally.least > 0 && tally.least == tally.most,
          static_cast<float>(tally.right / pixels), static_cast<float>(tally.down / pixels)};
}

StepWalk::StepWalk(const Slopes& slopes, const SlopeSurvey& survey, int first)
    : slopes_(slopes), survey_(survey), y_(std::max(first - 1, 0)) {
  const auto width = static_cast<std::size_t>(slopes.size().width);
  for (StepRow* row : {&above_, &here_}) {
    for (auto* values : {&row->right, &row->right_weight, &row->down, &row->down_weight}) {
      values->assign(width, 0.0f);
    }
  }
  slopes.read(y_, slope_below_);
  fill_here();
  if (y_ < first) advance();
}

void StepWalk::advance() {
  ++y_;
  std::swap(above_, here_);
  fill_here();
}

// Enters with the slopes of row y_ in slope_below_, where the walk read them last.
void StepWalk::fill_here() {
  std::swap(slope_here_, slope_below_);
  const Size size = slopes_.size();
  const bool is_last = y_ + 1 == size.height;
  if (!is_last) slopes_.read(y_ + 1, slope_below_);
  const SlopeRow& here = slope_here_;
  const SlopeRow& below = is_last ? slope_here_ : slope_below_;
  const auto width = static_cast<std::size_t>(size.width);
  for (std::size_t i = 0; i + 1 < width; ++i) {
    const float weight = joint_weight(here.weight[i], here.weight[i + 1]);
    here_.right_weight[i] = weight;
    here_.right[i] = weight > 0 ? (here.right[i] + here.right[i + 1]) / 2 - survey_.mean_right : 0.0f;
  }
  for (std::size_t i = 0; i < width; ++i) {
    const float weight = is_last ? 0.0f : joint_weight(here.weight[i], below.weight[i]);
    here_.down_weight[i] = weight;
    here_.down[i] = weight > 0 ? (here.down[i] + below.down[i]) / 2 - survey_.mean_down : 0.0f;
  }
}

void StepWalk::source(double* values) const {
  const std::size_t width = here_.right.size();
  double from_left = 0;
  for (std::size_t i = 0; i < width; ++i) {
    const double to_right = double{here_.right_weight[i]} * here_.right[i];
    const double to_below = double{here_.down_weight[i]} * here_.down[i];
    const double from_above = double{above_.down_weight[i]} * above_.down[i];
    values[i] = from_left - to_right + from_above - to_below;
    from_left = to_right;
  }
}

}  // namespace weft::solver
