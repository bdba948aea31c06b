// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/score.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/jobs/compare.h"
#include "bench/base/bound.h"
#include "core/parallel.h"
#include "pipeline/cut.h"

namespace weft::bench {
namespace {

// The bound of every pixel of a patch, degrees.
Image<float> bounds_of(const Patch& patch, int threads) {
  Image<float> bounds(patch.size());
  const CfaPattern cfa = patch.photographs.planes().cfa;
  parallel_for(static_cast<std::size_t>(bounds.height()), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    std::vector<LightField::Light> lights;
    for (int x = 0; x < bounds.width(); ++x) {
      const int c = cfa.channel_at(x, y);
      lights.clear();
      for (std::size_t k = 0; k < patch.field().count(); ++k) {
        if (patch.visible(x, y, static_cast<int>(k)) > 0) lights.push_back(patch.field().at(k, c, x, y));
      }
      const TangentCovariance bound =
          cramer_rao(lights, {patch.normal(x, y, 0), patch.normal(x, y, 1), patch.normal(x, y, 2)},
                     patch.albedo(x, y, c), *patch.photographs.noise());
      bounds(x, y) = static_cast<float>(bound.rms_deg());
    }
  });
  return bounds;
}

// Sums for the slope of a line.
class Slope {
 public:
  void add(double x, double y) {
    n_ += 1;
    x_ += x;
    y_ += y;
    xx_ += x * x;
    xy_ += x * y;
  }
  double mean_y() const { return y_ / n_; }
  double slope() const {
    const double spread = xx_ - x_ * x_ / n_;
    return spread > 0 ? (xy_ - x_ * y_ / n_) / spread : 0;
  }

 private:
  double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
};

// Errors of one contender on one scene.
class Errors {
 public:
  void add(const Patch& patch, const Image<float>& bounds, const SolvedMaps& maps) {
    const Rect part = patch.measured();
    const CfaPattern cfa = patch.photographs.planes().cfa;
    for (int y = part.y0; y < part.y1; ++y) {
      for (int x = part.x0; x < part.x1; ++x) {
        const double off = angle_deg(maps.normal_at(x, y),
                                     {patch.normal(x, y, 0), patch.normal(x, y, 1), patch.normal(x, y, 2)});
        const double angle = std::isfinite(off) ? off : static_cast<double>(solver::kUnknownAngleDeg);
        angles_.push_back(static_cast<float>(angle));
        if (std::isfinite(bounds(x, y))) {
          over_bound2_ += std::pow(angle / static_cast<double>(bounds(x, y)), 2);
          ++bounded_;
        }
        const int channel = cfa.channel_at(x, y);
        const double real = patch.albedo(x, y, channel);
        const double error = (static_cast<double>(maps.albedo_at(x, y, cfa)) - real) / real;
        albedo_error_ += std::abs(error);
        error_of_channel_[static_cast<std::size_t>(channel)].add(0, std::abs(error));
        leak_.add(patch.openness(x, y), error);
      }
    }
  }

  Json row(const std::string& method) {
    const app::NormalComparison angles = app::summarize(angles_);
    return {{"method", method},
            {"mean_deg", angles.mean_deg},
            {"p95_deg", angles.p95_deg},
            {"ratio_to_bound", bounded_ > 0 ? std::sqrt(over_bound2_ / bounded_) : 0.0},
            {"albedo_mean_rel", albedo_error_ / static_cast<double>(angles.pixels)},
            {"albedo_rel_rgb",
             {error_of_channel_[0].mean_y(), error_of_channel_[1].mean_y(), error_of_channel_[2].mean_y()}},
            {"albedo_bias_rel", leak_.mean_y()},
            {"leak", leak_.slope()}};
  }

 private:
  std::vector<float> angles_;
  double over_bound2_ = 0, bounded_ = 0, albedo_error_ = 0;
  Slope leak_;
  std::array<Slope, 3> error_of_channel_;
};

constexpr double kLong_s = 0.5;  // a solve whose overhead does not count

// Wall time of one solve, the least of five unless the first is long, but for what looking for a lobe takes,
// which is the same for a patch and for a frame of megapixels.
Result<double> seconds_of(const Contender& contender, const Patch& patch, int threads, SolvedMaps& maps) {
  double least = std::numeric_limits<double>::infinity();
  for (int run = 0; run < 5; ++run) {
    Result<void> solved;
    const double seconds = least_seconds(1, [&] { solved = contender.solve(patch, threads, maps); });
    if (!solved) return solved.error();
    least = std::min(least, seconds - maps.lobe_seconds);
    if (seconds > kLong_s) break;
  }
  return least;
}

// What a solve of the patch pays by frame and by row, which is a third of its time and nothing in a frame of
// megapixels: by how much half of its columns take more than half of its time.
Result<double> overhead_of(const Contender& contender, const Patch& patch, int threads) {
  SolvedMaps maps(patch.size());
  const Result<double> whole = seconds_of(contender, patch, threads, maps);
  if (!whole) return whole;
  const int columns = patch.size().width / 4 * 2;
  Result<pipeline::Photographs> part = cut(patch.photographs, {0, 0, columns, patch.size().height});
  if (!part) return std::move(part).error();
  Patch left;
  left.photographs = std::move(*part);
  SolvedMaps maps_of_left(left.size());
  const Result<double> half = seconds_of(contender, left, threads, maps_of_left);
  if (!half) return half;
  const double share = static_cast<double>(columns) / patch.size().width;
  return std::max(0.0, (*half - share * *whole) / (1 - share));
}

Result<double> seconds_a_pixel(const Contender& contender, const Patch& patch, int threads, double seconds) {
  const auto pixels = static_cast<double>(patch.size().pixels());
  if (!contender.is_quality || seconds > kLong_s) return seconds / pixels;
  // Half a patch is too small for robust and what is built on it to choose blocks: they pay what standard
  // does.
  const bool has_blocks = contender.name == "robust" || contender.name == "reference";
  const Result<std::vector<Contender>> as = contenders_named({has_blocks ? "standard" : contender.name});
  if (!as) return as.error();
  const Result<double> overhead = overhead_of(as->front(), patch, threads);
  if (!overhead) return overhead;
  return (seconds - *overhead) / pixels;
}

}  // namespace

BoundedPatches with_bounds(std::vector<Patch> patches, int threads) {
  BoundedPatches scene;
  scene.patches = std::move(patches);
  for (const Patch& patch : scene.patches) scene.bounds.push_back(bounds_of(patch, threads));
  return scene;
}

Result<Json> score(const Contender& contender, const BoundedPatches& scene, int threads) {
  Errors errors;
  double seconds = 0, lobe_seconds = 0, left_out = 0;
  const auto patches = static_cast<double>(scene.patches.size());
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    const Patch& patch = scene.patches[i];
    SolvedMaps maps(patch.size());
    const Result<double> took = seconds_of(contender, patch, threads, maps);
    if (!took) return took.error();
    const Result<double> a_pixel = seconds_a_pixel(contender, patch, threads, *took);
    if (!a_pixel) return a_pixel.error();
    seconds += *a_pixel / patches;
    lobe_seconds += maps.lobe_seconds / patches;
    errors.add(patch, scene.bounds[i], maps);
    left_out += maps.left_out_rel / patches;
  }
  Json row = errors.row(contender.name);
  row["left_out_rel"] = left_out;
  row["ns_per_pixel"] = seconds * 1e9;
  row["lobe_s"] = lobe_seconds;
  row["threads"] = threads;
  return row;
}

Json mean_row(const std::vector<const Json*>& rows) {
  Json mean = *rows.front();
  for (auto& [key, value] : mean.items()) {
    if (!value.is_number_float()) continue;
    double sum = 0;
    for (const Json* row : rows) sum += number(*row, key.c_str());
    value = sum / static_cast<double>(rows.size());
  }
  return mean;
}

double number(const Json& row, const char* key) {
  return row[key].get<double>();
}

}  // namespace weft::bench
