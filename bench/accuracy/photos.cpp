// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/photos.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

#include "bench/accuracy/score.h"
#include "bench/base/solved_maps.h"
#include "core/base/parallel.h"
#include "core/image_io/image_io.h"
#include "material/read/compare.h"
#include "simulator/sampling/random.h"
#include "solve/input/load.h"
#include "solve/input/photo_input.h"
#include "solve/levels/frame.h"
#include "solve/photographs/cut.h"
#include "solve/photographs/plane_weights.h"
#include "solver/method.h"

namespace weft::bench {
namespace {

struct Truth {
  LoadedImage normal;
  Image<std::uint8_t> counts;  ///< 1 inside the mask where there is a normal
  std::int64_t pixels = 0;
  Rect around;  ///< the least rectangle with all of them
};

Result<Truth> read_truth(const solve::SolvePlan& plan, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "normal_gt.exr";
  Result<LoadedImage> normal = read_image(file);
  if (!normal) return std::move(normal).error();
  if (normal->info.size != plan.size || normal->planes.planes() < 3) {
    return Error{
        ErrorKind::kBadData, "truth does not belong to the photographs", file.string(),
        fmt::format("it has {} x {} pixels and {} channels, the photographs {} x {}", normal->info.size.width,
                    normal->info.size.height, normal->planes.planes(), plan.size.width, plan.size.height),
        "copy the folder again"};
  }
  std::optional<LoadedImage> mask;
  if (!plan.mask.empty()) {
    Result<LoadedImage> read = read_image(plan.mask);
    if (!read) return std::move(read).error();
    mask = std::move(*read);
  }
  Truth truth;
  truth.normal = std::move(*normal);
  truth.counts = Image<std::uint8_t>(plan.size);
  for (int y = 0; y < plan.size.height; ++y) {
    for (int x = 0; x < plan.size.width; ++x) {
      const Image<float>& n = truth.normal.planes;
      const double square = std::hypot(n(x, y, 0), n(x, y, 1), n(x, y, 2));
      const bool counts = std::isfinite(square) && square > 0 && (!mask || mask->planes(x, y) > 0.5F);
      truth.counts(x, y) = counts ? 1 : 0;
      if (!counts) continue;
      ++truth.pixels;
      Rect& r = truth.around;
      r = truth.pixels == 1 ? Rect{x, y, x + 1, y + 1}
                            : Rect{std::min(r.x0, x), r.y0, std::max(r.x1, x + 1), y + 1};
    }
  }
  if (truth.pixels == 0) {
    return Error{ErrorKind::kBadData, "no pixel can be compared", file.string(),
                 "the mask leaves none for which the truth has a normal", "copy the folder again"};
  }
  return truth;
}

struct Solved {
  double mean_deg = 0;
  double seconds = 0;
  std::string gloss;  ///< of a level that looks for a lobe: what it found, or why it found none
};

std::string words_of(const solve::GlossFacts& gloss) {
  const solver::MeasuredLobe& first = gloss.lobes.front();
  if (!first.is_measured()) return solver::name_of(first.refusal);
  return gloss.share > 0 ? solver::name_of(first.lobe.family) : "measured, no gain";
}

// A level by all its steps where it solves a frame of this size, else the method alone.
Result<void> run(const solver::MethodName& name, const solve::Photographs& photographs, int threads,
                 SolvedMaps& maps, std::string& gloss) {
  if (name.level && name.extent != solver::Extent::kHalfSize) {
    const Result<solve::FrameFacts> facts = solve_level(photographs, name, threads, maps);
    if (!facts) return facts.error();
    if (facts->gloss) gloss = words_of(*facts->gloss);
    return {};
  }
  std::vector<View<const float>> readings;
  for (const Image<float>& photo : std::get<solve::Developed>(photographs.frames).rgb) {
    for (const View<const float>& plane : planes_of(photo)) readings.push_back(plane);
  }
  maps.planes = 3;
  return solve_images(*name.make(), readings, *photographs.field, {}, std::nullopt, threads, maps,
                      photographs.plane_weights);
}

// The photographs of these numbers, from 1, where there is truth.
Result<solve::Photographs> choose(const solve::Photographs& all, const std::vector<int>& numbers,
                                  const Truth& truth) {
  std::vector<std::size_t> others;
  for (std::size_t k = 0; k < all.count(); ++k) {
    if (std::ranges::count(numbers, static_cast<int>(k) + 1) == 0) others.push_back(k);
  }
  Result<solve::Photographs> chosen = solve::cut(all, truth.around);
  if (!chosen) return chosen;
  if (Result<void> ok = solve::leave_out(others, *chosen); !ok) return std::move(ok).error();
  return chosen;
}

Result<Solved> solve(const solver::MethodName& name, const solve::Photographs& photographs,
                     const Truth& truth, int threads) {
  const Rect part = truth.around;
  SolvedMaps maps(photographs.size);
  Result<void> solved;
  Solved result;
  result.seconds = least_seconds(1, [&] { solved = run(name, photographs, threads, maps, result.gloss); });
  if (!solved) return std::move(solved).error();
  double sum = 0;
  for (int y = part.y0; y < part.y1; ++y) {
    for (int x = part.x0; x < part.x1; ++x) {
      if (truth.counts(x, y) == 0) continue;
      const Image<float>& n = truth.normal.planes;
      const double angle =
          angle_deg(maps.normal_at(x - part.x0, y - part.y0), {n(x, y, 0), n(x, y, 1), n(x, y, 2)});
      sum += std::isfinite(angle) ? angle : static_cast<double>(solver::kUnknownAngleDeg);
    }
  }
  result.mean_deg = sum / static_cast<double>(truth.pixels);
  return result;
}

Result<Json> row_of(const solver::MethodName& name, const solve::Photographs& photographs,
                    const std::vector<std::vector<int>>& subsets, const Truth& truth, int threads) {
  std::vector<double> means;
  std::map<std::string, int> gloss;  // in how many subsets each was said
  double seconds = 0;
  for (const std::vector<int>& numbers : subsets) {
    Result<solve::Photographs> chosen = choose(photographs, numbers, truth);
    if (!chosen) return std::move(chosen).error();
    if (!name.keeps_clipped) chosen->plane_weights = solve::measure_plane_weights(*chosen);
    const Result<Solved> solved = solve(name, *chosen, truth, threads);
    if (!solved) return solved.error();
    means.push_back(solved->mean_deg);
    if (!solved->gloss.empty()) ++gloss[solved->gloss];
    seconds += solved->seconds;
  }
  const auto count = static_cast<double>(means.size());
  const double mean = std::accumulate(means.begin(), means.end(), 0.0) / count;
  double square = 0;
  for (const double m : means) square += (m - mean) * (m - mean);
  std::string said;
  for (const auto& [words, times] : gloss)
    said += fmt::format("{}{}{}", said.empty() ? "" : ", ", words,
                        means.size() > 1 ? fmt::format(" {}", times) : "");
  return Json{{"method", name.name},
              {"lights", subsets.front().size()},
              {"subsets", means.size()},
              {"pixels", truth.pixels},
              {"mean_deg", mean},
              {"sd_deg", means.size() > 1 ? std::sqrt(square / (count - 1)) : 0.0},
              {"least_deg", *std::min_element(means.begin(), means.end())},
              {"most_deg", *std::max_element(means.begin(), means.end())},
              {"gloss", said},
              {"ns_per_pixel", seconds * 1e9 / (count * static_cast<double>(truth.around.pixels()))},
              {"threads", threads}};
}

Result<std::vector<std::vector<int>>> choose_subsets(const solve::SolvePlan& plan,
                                                     const PhotosOptions& options) {
  std::vector<Vec3> directions;
  for (const DistantLight& light : std::get<DistantLights>(*plan.calibration.lights).lights)
    directions.push_back(light.direction);
  const auto lights = static_cast<int>(directions.size());
  if (options.pick == 0) {
    std::vector<int> all(directions.size());
    std::iota(all.begin(), all.end(), 1);
    return std::vector<std::vector<int>>{all};
  }
  if (options.pick < 3 || options.pick > lights) {
    return Error{ErrorKind::kUsage, "so many lights cannot be picked", fmt::format("--pick {}", options.pick),
                 fmt::format("there are {} lights and three are the fewest", lights),
                 fmt::format("pick 3 to {}, or 0 for all", lights)};
  }
  std::vector<std::vector<int>> subsets;
  for (const int first : first_lights(lights, options.subsets, options.seed)) {
    subsets.push_back(spread_lights(directions, options.pick, first));
  }
  return subsets;
}

Result<std::vector<solver::MethodName>> chosen_methods(const std::vector<std::string>& asked) {
  std::vector<solver::MethodName> chosen;
  std::vector<std::string> names;
  for (const solver::MethodName& name : solver::method_names()) {
    names.emplace_back(name.name);
    if (asked.empty() || std::count(asked.begin(), asked.end(), name.name) > 0) chosen.push_back(name);
  }
  for (const std::string& name : asked) {
    if (std::count(names.begin(), names.end(), name) == 0) return no_such("method", name, names);
  }
  return chosen;
}

}  // namespace

std::vector<int> spread_lights(std::span<const Vec3> directions, int count, int first) {
  std::vector<int> chosen = {first};
  while (static_cast<int>(chosen.size()) < count) {
    int farthest = 0;
    double distance_deg = 0;
    for (int candidate = 1; candidate <= static_cast<int>(directions.size()); ++candidate) {
      double nearest_deg = 180;
      for (const int other : chosen) {
        nearest_deg = std::min(nearest_deg, angle_deg(directions[static_cast<std::size_t>(candidate) - 1],
                                                      directions[static_cast<std::size_t>(other) - 1]));
      }
      if (nearest_deg <= distance_deg) continue;
      distance_deg = nearest_deg;
      farthest = candidate;
    }
    if (farthest == 0) break;  // the rest repeat directions that are chosen
    chosen.push_back(farthest);
  }
  return chosen;
}

std::vector<int> first_lights(int lights, int subsets, std::uint32_t seed) {
  std::vector<int> order(static_cast<std::size_t>(lights)), first;
  std::iota(order.begin(), order.end(), 1);
  // Fisher and Yates, as Durstenfeld's algorithm 235 (1964) has it.
  for (std::size_t i = order.size() - 1; i > 0; --i) {
    const auto bits = simulator::philox({static_cast<std::uint32_t>(i), 0, 0, 0}, {seed, 0});
    const double u = simulator::uniform(bits[0], bits[1]);
    std::swap(order[i], order[static_cast<std::size_t>(u * static_cast<double>(i + 1))]);
  }
  for (int i = 0; i < subsets; ++i) first.push_back(order[static_cast<std::size_t>(i % lights)]);
  return first;
}

Result<Rows> photos_table(const PhotosOptions& options) {
  const Result<std::vector<solver::MethodName>> methods = chosen_methods(options.methods);
  if (!methods) return methods.error();
  solve::PhotoOptions photos;
  photos.folder = options.folder;
  Result<solve::SolvePlan> plan = solve::plan_photos(photos);
  if (!plan) return std::move(plan).error();
  const auto subsets = choose_subsets(*plan, options);
  if (!subsets) return subsets.error();
  const Result<Truth> truth = read_truth(*plan, options.folder);
  if (!truth) return truth.error();
  const int threads = resolved_threads(options.threads);
  Rows rows;
  for (const bool keep : {false, true}) {
    const auto wants_this = [&](const solver::MethodName& name) { return name.keeps_clipped == keep; };
    if (std::none_of(methods->begin(), methods->end(), wants_this)) continue;
    plan->clipped = keep ? Clipped::kKeep : Clipped::kMark;
    JobContext context;
    context.threads = threads;
    const auto photographs = solve::load_photographs(*plan, context);
    if (!photographs) return photographs.error();
    for (const solver::MethodName& name : *methods) {
      if (!wants_this(name)) continue;
      if (Result<void> ok = add_row(rows, row_of(name, *photographs, *subsets, *truth, threads)); !ok)
        return ok.error();
    }
  }
  return rows;
}

}  // namespace weft::bench
