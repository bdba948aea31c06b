// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "bench/base/bound.h"
#include "core/base/parallel.h"
#include "core/image/tiles.h"
#include "solve/bands/bands.h"
#include "solve/files/normal_comparison.h"
#include "solve/levels/frame.h"
#include "solve/photographs/cut.h"
#include "solve/photographs/tile_reader.h"

namespace weft::bench {
namespace {

// The bound of every pixel of a patch, degrees.
Image<float> bounds_of(const ClothPatch& patch, int threads) {
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
  void add(const ClothPatch& patch, const Image<float>& bounds, const SolvedMaps& maps) {
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
    const solve::NormalComparison angles = solve::summarize(angles_);
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
Result<double> seconds_of(const Contender& contender, const ClothPatch& patch, int threads,
                          SolvedMaps& maps) {
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
Result<double> overhead_of(const Contender& contender, const ClothPatch& patch, int threads) {
  SolvedMaps maps(patch.size());
  const Result<double> whole = seconds_of(contender, patch, threads, maps);
  if (!whole) return whole;
  const int columns = patch.size().width / 4 * 2;
  Result<solve::Photographs> part = cut(patch.photographs, {0, 0, columns, patch.size().height});
  if (!part) return std::move(part).error();
  ClothPatch left;
  left.photographs = std::move(*part);
  SolvedMaps maps_of_left(left.size());
  const Result<double> half = seconds_of(contender, left, threads, maps_of_left);
  if (!half) return half;
  const double share = static_cast<double>(columns) / patch.size().width;
  return std::max(0.0, (*half - share * *whole) / (1 - share));
}

Result<double> seconds_a_pixel(const Contender& contender, const ClothPatch& patch, int threads,
                               double seconds) {
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

BoundedPatches with_bounds(std::vector<ClothPatch> patches, int threads) {
  BoundedPatches scene;
  scene.patches = std::move(patches);
  for (const ClothPatch& patch : scene.patches) scene.bounds.push_back(bounds_of(patch, threads));
  return scene;
}

Result<Json> score(const Contender& contender, const BoundedPatches& scene, int threads) {
  Errors errors;
  double seconds = 0, lobe_seconds = 0, left_out = 0;
  const auto patches = static_cast<double>(scene.patches.size());
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    const ClothPatch& patch = scene.patches[i];
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

namespace {

Result<void> solve_patch(const solver::Method& method, const std::vector<View<const float>>& readings,
                         const ClothPatch& patch, int threads, SolvedMaps& maps) {
  return solve_images(method, readings, patch.field(), patch.photographs.planes().cfa,
                      patch.photographs.noise(), threads, maps);
}

// Puts bands of a frame into maps; albedo in each photosite's own colour where it was measured alone.
solve::BandSink keeper_of(const solve::Planes& planes, SolvedMaps& maps) {
  maps.planes = planes.count;
  return [planes, &maps](const solve::MapBand& band) -> Result<void> {
    for (int y = 0; y < band.rows.height(); ++y) {
      const int row = band.rows.y0 + y;
      for (int c = 0; c < 3; ++c) {
        std::copy_n(band.normal[static_cast<std::size_t>(c)].row(y), band.rows.width(),
                    maps.normal.plane(c).row(row));
      }
      std::copy_n(band.status.row(y), band.rows.width(), maps.status.plane().row(row));
    }
    for (int y = 0; y < band.albedo_rows.height(); ++y) {
      const int row = band.albedo_rows.y0 + y;
      for (int x = 0; x < band.albedo_rows.width(); ++x) {
        for (int p = 0; p < planes.count; ++p) {
          const auto c = static_cast<std::size_t>(planes.channel_at(p, x, row));
          maps.albedo(x, row, p) = band.albedo[c](x, y);
          maps.sigma_albedo(x, row, p) = band.sigma_albedo[c](x, y);
        }
        maps.sigma_normal_deg(x, row) = band.sigma_normal_deg(x, y);
      }
    }
    return {};
  };
}

JobContext on_threads(int threads) {
  JobContext context;
  context.threads = threads;
  return context;
}

// Least squares on what each point truly faces and sees.
Result<void> solve_oracle(const ClothPatch& patch, int threads, SolvedMaps& maps) {
  Image<float> seen(patch.size(), patch.readings.planes());
  for (int k = 0; k < seen.planes(); ++k) {
    for (int y = 0; y < seen.height(); ++y) {
      for (int x = 0; x < seen.width(); ++x) {
        seen(x, y, k) =
            patch.visible(x, y, k) > 0 ? patch.readings(x, y, k) : -std::numeric_limits<float>::infinity();
      }
    }
  }
  return solve_patch(*solver::least_squares_method(), planes_of(seen), patch, threads, maps);
}

// Each pixel as four of twice its size.
void enlarge(const SolvedMaps& half, SolvedMaps& maps) {
  const Size size = maps.status.size();
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const int u = std::min(x / 2, half.status.width() - 1), v = std::min(y / 2, half.status.height() - 1);
      for (int c = 0; c < 3; ++c) {
        maps.normal(x, y, c) = half.normal(u, v, c);
        maps.albedo(x, y, c) = half.albedo(u, v, c);
        maps.sigma_albedo(x, y, c) = half.sigma_albedo(u, v, c);
      }
      maps.sigma_normal_deg(x, y) = half.sigma_normal_deg(u, v);
      maps.residual(x, y) = half.residual(u, v);
      maps.status(x, y) = half.status(u, v);
    }
  }
}

// Each pixel of a preview stands for the four photosites that it was made of.
Result<void> solve_at_half_size(const ClothPatch& patch, const solver::MethodName& level, int threads,
                                SolvedMaps& maps) {
  const Result<solve::Photographs> half = solve::half_size(patch.photographs, threads);
  if (!half) return half.error();
  SolvedMaps solved(half->size);
  const Result<solve::FrameFacts> facts = solve_level(*half, level, threads, solved);
  if (!facts) return facts.error();
  maps.planes = solved.planes;
  maps.left_out_rel = solved.left_out_rel;
  enlarge(solved, maps);
  return {};
}

}  // namespace

Result<solve::FrameFacts> solve_level(const solve::Photographs& photographs, const solver::MethodName& level,
                                      int threads, SolvedMaps& maps) {
  Result<solve::FrameFacts> facts = solve_frame(photographs, level, solve::kSolveTile, on_threads(threads),
                                                keeper_of(photographs.planes(), maps));
  maps.lobe_seconds = facts && facts->gloss ? facts->gloss->seconds : 0;
  if (facts && facts->left_out) maps.left_out_rel = solver::error_of_all(*facts->left_out).median;
  return facts;
}

SolvePatch as_product(std::shared_ptr<const solver::Method> method) {
  return [method](const ClothPatch& patch, int threads, SolvedMaps& maps) -> Result<void> {
    if (!method->wants_rgb()) {
      return solve_patch(*method, planes_of(patch.readings), patch, threads, maps);
    }
    const TileOptions whole = {.width = patch.size().width, .height = patch.size().height};
    solve::TileReader reader(patch.photographs, whole, solve::ReadAs::kRgb);
    maps.planes = 3;
    const auto readings = reader.read(patch.area()).readings;
    return solve_patch(*method, {readings.begin(), readings.end()}, patch, threads, maps);
  };
}

SolvePatch by_level(const solver::MethodName& level) {
  return [level](const ClothPatch& patch, int threads, SolvedMaps& maps) {
    if (level.extent == solver::Extent::kHalfSize) return solve_at_half_size(patch, level, threads, maps);
    const Result<solve::FrameFacts> facts = solve_level(patch.photographs, level, threads, maps);
    return facts ? Result<void>() : facts.error();
  };
}

SolvePatch by_stages(std::vector<solve::Stage> stages) {
  return
      [stages = std::move(stages)](const ClothPatch& patch, int threads, SolvedMaps& maps) -> Result<void> {
        const auto solved = solve_by(stages, patch.photographs, solve::kSolveTile, on_threads(threads),
                                     keeper_of(patch.photographs.planes(), maps));
        return solved ? Result<void>() : solved.error();
      };
}

std::vector<std::string> level_names() {
  std::vector<std::string> names;
  for (const solver::MethodName& name : solver::method_names()) {
    if (name.level) names.emplace_back(name.name);
  }
  return names;
}

std::vector<Contender> contenders() {
  std::vector<Contender> all;
  for (const solver::MethodName& name : solver::method_names()) {
    if (name.level) {
      all.push_back({name.name, by_level(name), true, false, 1});
      continue;
    }
    std::shared_ptr<const solver::Method> method = name.make();
    const int planes = method->wants_rgb() ? 3 : 1;
    all.push_back({name.name, as_product(std::move(method)), false, false, planes});
  }
  all.push_back({"oracle", solve_oracle, false, true, 1});
  return all;
}

Result<std::vector<Contender>> contenders_named(const std::vector<std::string>& names) {
  std::vector<Contender> all = contenders(), chosen;
  if (names.empty()) return all;
  std::vector<std::string> known;
  for (const Contender& contender : all) known.push_back(contender.name);
  for (const std::string& name : names) {
    if (std::count(known.begin(), known.end(), name) == 0) return no_such("method", name, known);
  }
  for (Contender& contender : all) {
    const bool asked = std::count(names.begin(), names.end(), contender.name) > 0;
    if (asked || contender.is_yardstick) chosen.push_back(std::move(contender));
  }
  return chosen;
}

Result<void> solve_images(const solver::Method& method, const std::vector<View<const float>>& readings,
                          const LightField& field, const CfaPattern& cfa,
                          const std::optional<NoiseModel>& noise, int threads, SolvedMaps& maps,
                          const std::array<double, 3>& plane_weights) {
  TileOptions tiles = solve::kSolveTile;
  tiles.threads = threads;
  const Size size = maps.status.size();
  return for_each_tile({0, 0, size.width, size.height}, tiles, {}, [&](Rect tile, int) {
    std::vector<View<const float>> cropped;
    for (const View<const float>& view : readings) cropped.push_back(view.crop(tile));
    method.solve({tile, maps.planes, cfa, cropped, &field, noise, plane_weights}, maps.output(tile));
  });
}

std::vector<View<const float>> planes_of(const Image<float>& readings) {
  std::vector<View<const float>> views;
  for (int k = 0; k < readings.planes(); ++k) views.emplace_back(readings.plane(k));
  return views;
}

Error no_such(const char* what, const std::string& name, const std::vector<std::string>& names) {
  return {ErrorKind::kUsage, fmt::format("no such {}", what), name,
          fmt::format("there are {}", fmt::join(names, ", ")), "choose one of these names"};
}

}  // namespace weft::bench
