// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/coverage.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bench/accuracy/contenders.h"
#include "core/parallel.h"
#include "core/statistics.h"
#include "core/vec.h"
#include "pipeline/frame.h"

namespace weft::bench {
namespace {

constexpr std::size_t kTenths = 10;

struct Coverage {
  double median = 0, beyond = 0;

  explicit Coverage(std::span<const StatedError> pixels) {
    std::vector<double> ratios;
    for (const StatedError& p : pixels) {
      ratios.push_back(static_cast<double>(p.error_deg) / static_cast<double>(p.sigma_deg));
      beyond += ratios.back() > 3;
    }
    beyond /= static_cast<double>(pixels.size());
    median = weft::median(std::move(ratios));
  }
  double off() const { return std::abs(std::log(median)); }
  bool has_median() const { return median >= kLeastMedian && median <= kMostMedian; }
};

// Errors of the rows of a band.
class Gatherer {
 public:
  Gatherer(const Patch& patch, Size maps)
      : patch_(patch),
        scale_(patch.size().width / maps.width),
        normal_(maps, 3),
        sigma_(maps),
        status_(maps) {}

  Result<void> operator()(const pipeline::MapBand& band) {
    const int width = band.rows.width();
    for (int y = 0; y < band.rows.height(); ++y) {
      for (int c = 0; c < 3; ++c) {
        std::copy_n(band.normal[static_cast<std::size_t>(c)].row(y), width,
                    normal_.plane(c).row(band.rows.y0 + y));
      }
      std::copy_n(band.status.row(y), width, status_.plane().row(band.rows.y0 + y));
    }
    for (int y = 0; y < band.albedo_rows.height(); ++y) {
      for (int x = 0; x < width; ++x) {
        sigma_(x, band.albedo_rows.y0 + y) =
            std::hypot(band.sigma_normal_deg(x, y), band.model_normal_deg(x, y));
      }
    }
    return {};
  }

  std::vector<StatedError> errors() const {
    std::vector<StatedError> errors;
    const Rect part = patch_.measured();
    for (int y = part.y0; y < part.y1; ++y) {
      for (int x = part.x0; x < part.x1; ++x) {
        const int u = x / scale_, v = y / scale_;
        if (status_(u, v) & kNoSolution) continue;
        const double off =
            angle_deg({normal_(u, v, 0), normal_(u, v, 1), normal_(u, v, 2)},
                      {patch_.normal(x, y, 0), patch_.normal(x, y, 1), patch_.normal(x, y, 2)});
        errors.push_back({static_cast<float>(off), sigma_(u, v), status_(u, v)});
      }
    }
    return errors;
  }

 private:
  const Patch& patch_;
  int scale_;
  Image<float> normal_, sigma_;
  Image<std::uint16_t> status_;
};

Result<std::vector<const solver::MethodName*>> levels_named(const std::vector<std::string>& names) {
  std::vector<const solver::MethodName*> levels;
  std::vector<std::string> known;
  for (const solver::MethodName& method : solver::method_names()) {
    if (!method.level) continue;
    known.emplace_back(method.name);
    if (names.empty() || std::ranges::count(names, method.name) > 0) levels.push_back(&method);
  }
  for (const std::string& name : names) {
    if (std::ranges::count(known, name) == 0) return no_such("level", name, known);
  }
  return levels;
}

}  // namespace

Json coverage_of(std::span<const StatedError> pixels) {
  std::vector<StatedError> counted(pixels.begin(), pixels.end());
  const auto flagged =
      std::ranges::count_if(pixels, [](const StatedError& p) { return p.status & kNotCounted; });
  const double share = static_cast<double>(flagged) / static_cast<double>(pixels.size());
  const bool left_out = flagged > 0 && share <= kMostFlagged;
  if (left_out) std::erase_if(counted, [](const StatedError& p) { return p.status & kNotCounted; });
  std::ranges::stable_sort(counted, {}, &StatedError::sigma_deg);
  const std::span<const StatedError> all = counted;
  const Coverage whole(all);
  Coverage farthest = whole;
  double most_beyond = 0;
  bool each_holds = true;
  for (std::size_t i = 0; i < kTenths; ++i) {
    const std::size_t from = i * all.size() / kTenths, to = (i + 1) * all.size() / kTenths;
    const Coverage tenth(all.subspan(from, to - from));
    if (i == 0 || tenth.off() > farthest.off()) farthest = tenth;
    most_beyond = std::max(most_beyond, tenth.beyond);
    each_holds &= tenth.has_median();
  }
  return {{"pixels", all.size()},
          {"median_over_sigma", whole.median},
          {"beyond_3", whole.beyond},
          {"worst_tenth", farthest.median},
          {"worst_tenth_beyond_3", most_beyond},
          {"flagged", share},
          {"left_out", left_out},
          {"holds", whole.has_median() && whole.beyond < kMostBeyond},
          {"each_tenth_holds", each_holds}};
}

Result<std::vector<StatedError>> stated_errors(const Patch& patch, const solver::MethodName& level,
                                               int threads) {
  const bool is_half = level.extent == solver::Extent::kHalfSize;
  Result<pipeline::Photographs> half = pipeline::Photographs();
  if (is_half) half = pipeline::half_size(patch.photographs, threads);
  if (!half) return half.error();
  const pipeline::Photographs& photographs = is_half ? *half : patch.photographs;
  Gatherer gatherer(patch, photographs.size);
  JobContext context;
  context.threads = threads;
  const Result<pipeline::FrameFacts> solved =
      pipeline::solve_frame(photographs, level, pipeline::kSolveTile, context, std::ref(gatherer));
  if (!solved) return solved.error();
  return gatherer.errors();
}

Result<Rows> coverage_table(const AccuracyTableOptions& options) {
  const int threads = resolved_threads(options.threads);
  const auto levels = levels_named(options.methods);
  if (!levels) return levels.error();
  const Result<std::vector<AccuracyScene>> scenes = chosen_scenes(options);
  if (!scenes) return scenes.error();
  Rows rows;
  for (const AccuracyScene& scene : *scenes) {
    const Result<std::vector<Patch>> patches = render_patches(scene, threads);
    if (!patches) return patches.error();
    for (const solver::MethodName* level : *levels) {
      std::vector<StatedError> pixels;
      for (const Patch& patch : *patches) {
        const Result<std::vector<StatedError>> errors = stated_errors(patch, *level, threads);
        if (!errors) return errors.error();
        pixels.insert(pixels.end(), errors->begin(), errors->end());
      }
      rows.push_back({{"scene", scene.name}, {"level", level->name}, {"seed", options.seed}});
      rows.back().update(coverage_of(pixels));
    }
  }
  return rows;
}

}  // namespace weft::bench
