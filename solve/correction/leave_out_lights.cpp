// SPDX-License-Identifier: Apache-2.0
#include "solve/correction/leave_out_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "solve/correction/light_correction.h"
#include "solve/photographs/tile_reader.h"
#include "solver/in_double/pixel.h"

namespace weft::solve {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
// Rows of blocks that a correction is traced for.
constexpr int kMostRows = 4;

// Where one pixel and light stand in LeftOut.
struct Slots {
  std::span<float> reading, error, noise;
};

// Leaves lights out of one patch after another; one a worker.
class PatchJudge {
 public:
  PatchJudge(const Photographs& photographs, const SolveVariant& variant)
      : variant_(variant),
        reader_(photographs, {.width = kRowGroup, .height = 1},
                variant.method->wants_rgb() ? ReadAs::kRgb : ReadAs::kTaken),
        lights_(photographs.count()),
        planes_(reader_.planes()),
        of_state_(lights_ * static_cast<std::size_t>(planes_.count)),
        lobe_share_(photographs.lobe_share) {
    if (photographs.parallel && variant.judged_by_parallel) {
      judged_ = static_cast<int>(of_state_);
      lobe_share_ = solver::kParallelLobeShare;
    }
    const int count = static_cast<int>(of_state_) * (photographs.parallel ? 2 : 1);
    taken_ = Image<float>({kRowGroup, 1}, count);
    used_ = Image<float>({kRowGroup, 1}, count);
    left_ = Image<float>({kRowGroup, 1}, count);
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(c);
      output_.normal[i] = maps_.plane(c);
      output_.albedo[i] = maps_.plane(3 + c);
      output_.sigma_albedo[i] = maps_.plane(6 + c);
    }
    output_.sigma_normal_deg = maps_.plane(9);
    output_.residual = maps_.plane(10);
    output_.status = status_.plane();
  }

  // Writes `into` from its pixel `first` on.
  void judge(Rect tile, std::size_t first, solver::LeftOut& into) {
    const solver::TileInput input = prepare(tile);
    const std::size_t turns = solver::turns_of(lights_);
    predicted_.assign(static_cast<std::size_t>(tile.width()) * lights_, kNaN);
    read_lights(input);
    normals_.assign(static_cast<std::size_t>(tile.width()), {});
    for (std::size_t turn = 0; turn < turns; ++turn) predict(input, turn, turns);
    for (int x = 0; x < tile.width(); ++x) {
      const std::size_t pixel = first + static_cast<std::size_t>(x), at = pixel * lights_;
      const std::vector<Vec3>& of_turns = normals_[static_cast<std::size_t>(x)];
      if (of_turns.size() == turns)
        into.turned_deg[pixel] = static_cast<float>(solver::jackknife_deg(of_turns));
      write(input, x, into.scale[pixel],
            {{&into.reading[at], lights_}, {&into.error[at], lights_}, {&into.noise[at], lights_}});
    }
  }

 private:
  static View<float> row_of(Image<float>& image, std::size_t plane, Rect tile) {
    return image.plane(static_cast<int>(plane)).crop({0, 0, tile.width(), 1});
  }

  // Reads the patch: `taken_` as predictions are held against it, `used_` as it is solved.
  solver::TileInput prepare(Rect tile) {
    const solver::TileInput input = reader_.read(tile);
    std::vector<View<float>> taken, used;
    for (const auto& state : {input.readings, input.parallel}) {
      for (std::size_t i = 0; i < state.size(); ++i) {
        const double gain =
            variant_.gains.empty() ? 1 : variant_.gains[i / static_cast<std::size_t>(planes_.count)];
        taken.push_back(row_of(taken_, taken.size(), tile));
        used.push_back(row_of(used_, used.size(), tile));
        for (int x = 0; x < tile.width(); ++x) taken.back()(x, 0) = static_cast<float>(state[i](x, 0) / gain);
      }
    }
    for (std::size_t first = 0; variant_.correction != nullptr && first < taken.size(); first += of_state_)
      variant_.correction->subtract_bounces(tile, std::span(taken).subspan(first, of_state_));
    for (std::size_t i = 0; i < taken.size(); ++i) std::copy_n(taken[i].row(0), tile.width(), used[i].row(0));
    for (std::size_t first = 0; variant_.correction != nullptr && first < taken.size(); first += of_state_)
      variant_.correction->mark_shadows(tile, std::span(used).subspan(first, of_state_));
    return input;
  }

  // Solves without the lights of one turn and predicts them.
  void predict(const solver::TileInput& input, std::size_t turn, std::size_t turns) {
    const Rect tile = input.tile;
    const auto planes = static_cast<std::size_t>(planes_.count);
    views_.clear();
    for (std::size_t i = 0; i < input.readings.size() + input.parallel.size(); ++i) {
      const View<float> left = row_of(left_, i, tile);
      if (i / planes % lights_ % turns == turn) {
        std::fill_n(left.row(0), tile.width(), kNaN);
      } else {
        std::copy_n(row_of(used_, i, tile).row(0), tile.width(), left.row(0));
      }
      views_.emplace_back(left);
    }
    solver::TileInput others = input;
    others.readings = std::span(views_).first(of_state_);
    others.parallel = std::span(views_).subspan(of_state_);
    variant_.method->solve(others, output_);
    for (int x = 0; x < tile.width(); ++x) {
      if (output_.status(x, 0) & kNoSolution) continue;
      const auto& n = output_.normal;
      normals_[static_cast<std::size_t>(x)].push_back({n[0](x, 0), n[1](x, 0), n[2](x, 0)});
      for (std::size_t k = turn; k < lights_; k += turns) {
        const bool hidden = std::isinf(used(k, x)) && used(k, x) < 0;
        const double sent =
            hidden ? 0
                   : variant_.method->reflected(others, output_, x, 0, light(k, x).direction, lobe_share_);
        predicted_[static_cast<std::size_t>(x) * lights_ + k] = static_cast<float>(sent);
      }
    }
  }

  void write(const solver::TileInput& input, int x, float& scale, const Slots& slots) {
    directions_.assign(lights_, {});
    variances_.assign(lights_, std::numeric_limits<double>::quiet_NaN());
    const std::optional<NoiseModel> noise = input.noise;
    usable_.clear();
    for (std::size_t k = 0; k < lights_; ++k) {
      const LightField::Light& lit = light(k, x);
      const double gain = variant_.gains.empty() ? 1 : variant_.gains[k];
      const double taken = taken_(x, 0, plane(k)) / lit.strength;
      const double predicted = predicted_[static_cast<std::size_t>(x) * lights_ + k];
      const bool is_usable = lit.strength > 0 && std::isfinite(taken);
      slots.reading[k] = is_usable ? static_cast<float>(gain * taken) : kNaN;
      slots.error[k] = is_usable ? static_cast<float>(gain * (taken - predicted)) : kNaN;
      directions_[k] = lit.direction;
      if (!is_usable) continue;
      usable_.push_back(slots.reading[k]);
      if (noise) variances_[k] = noise->variance(predicted * lit.strength) / (lit.strength * lit.strength);
    }
    const auto rank = static_cast<std::size_t>(solver::bright_rank(lights_));
    scale = usable_.size() < rank ? kNaN : value_of_rank<float>(usable_, usable_.size() - rank);
    if (noise) solver::left_out_noise(directions_, variances_, slots.noise);
  }

  void read_lights(const solver::TileInput& input) {
    light_.clear();
    for (int px = input.tile.x0, py = input.tile.y0; px < input.tile.x1; ++px) {
      const int channel = planes_.channel_at(planes_.speaker(), px, py);
      for (std::size_t k = 0; k < lights_; ++k) light_.push_back(input.field->at(k, channel, px, py));
    }
  }
  const LightField::Light& light(std::size_t k, int x) const {
    return light_[static_cast<std::size_t>(x) * lights_ + k];
  }
  int plane(std::size_t k) const { return judged_ + static_cast<int>(k) * planes_.count + planes_.speaker(); }
  float used(std::size_t k, int x) const { return used_(x, 0, plane(k)); }

  SolveVariant variant_;
  TileReader reader_;
  std::size_t lights_;
  Planes planes_;
  std::size_t of_state_;              // planes of one state of the films
  double lobe_share_;                 // of the readings that are predicted
  int judged_ = 0;                    // their first plane
  Image<float> taken_, used_, left_;  // [state][k * planes + p], one row
  Image<float> maps_{{kRowGroup, 1}, 11};
  Image<std::uint16_t> status_{{kRowGroup, 1}};
  solver::TileOutput output_;  // of one row, views of the two
  std::vector<View<const float>> views_;
  std::vector<LightField::Light> light_;  // [x * lights + k], as the next
  std::vector<float> predicted_;
  std::vector<std::vector<Vec3>> normals_;  // by pixel, of each turn
  std::vector<float> usable_;
  std::vector<Vec3> directions_;
  std::vector<double> variances_;
};

}  // namespace

Result<solver::LeftOut> leave_out_lights(const Photographs& photographs, const SolveVariant& variant,
                                         std::span<const solver::Patch> patches, const JobContext& context) {
  solver::LeftOut left_out;
  left_out.grid = solver::blocks_of(photographs.size);
  left_out.lights = photographs.count();
  left_out.patches.assign(patches.begin(), patches.end());
  std::vector<std::size_t> first = {0};  // pixel of each patch
  for (const solver::Patch& patch : patches) {
    first.push_back(first.back() + static_cast<std::size_t>(patch.pixels.pixels()));
  }
  for (std::vector<float>* values : {&left_out.scale, &left_out.turned_deg})
    values->assign(first.back(), kNaN);
  for (std::vector<float>* values : {&left_out.reading, &left_out.error, &left_out.noise}) {
    values->assign(first.back() * left_out.lights, kNaN);
  }
  std::vector<PatchJudge> judges;
  for (int i = 0; i < resolved_threads(context.threads); ++i) judges.emplace_back(photographs, variant);

  const auto columns = static_cast<std::size_t>(left_out.grid.columns);
  for (std::size_t begin = 0, end = 0; begin < patches.size(); begin = end) {
    if (context.stop.stop_requested()) return interrupted();
    const std::size_t row = patches[begin].block / columns;
    while (end < patches.size() && patches[end].block / columns == row) ++end;
    if (variant.correction != nullptr) {
      const int y0 = static_cast<int>(row) * solver::kBlock;
      const Rect rows = {0, y0, photographs.size.width,
                         std::min(y0 + solver::kBlock, photographs.size.height)};
      std::vector<Rect> tiles;
      for (std::size_t i = begin; i < end; ++i) tiles.push_back(patches[i].pixels);
      if (Result<void> ok = variant.correction->prepare_only(rows, tiles); !ok) return std::move(ok).error();
    }
    parallel_for(end - begin, context.threads, [&](std::size_t i, int worker) {
      judges[static_cast<std::size_t>(worker)].judge(patches[begin + i].pixels, first[begin + i], left_out);
    });
  }
  return left_out;
}

std::vector<solver::Patch> of_few_rows(std::span<const solver::Patch> patches, Size size) {
  std::vector<solver::Patch> few;
  for (const std::vector<solver::Patch>& row : patches_of_few_rows(patches, size))
    few.insert(few.end(), row.begin(), row.end());
  return few;
}

std::vector<std::vector<solver::Patch>> patches_of_few_rows(std::span<const solver::Patch> patches,
                                                            Size size) {
  const solver::BlockGrid grid = solver::blocks_of(size);
  const int count = std::min(grid.rows, kMostRows);
  std::vector<std::vector<solver::Patch>> rows(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const int row = (2 * i + 1) * grid.rows / (2 * count);
    for (const solver::Patch& patch : patches) {
      if (static_cast<int>(patch.block) / grid.columns == row)
        rows[static_cast<std::size_t>(i)].push_back(patch);
    }
  }
  return rows;
}

Result<solver::BlockChoice> choose_by_block(const Photographs& photographs, const SolveVariant& base,
                                            const SolveVariant& better, const JobContext& context) {
  std::vector<solver::Patch> patches = solver::patches_of(photographs.size, solver::PatchUse::kChoose);
  if (base.correction != nullptr) patches = of_few_rows(patches, photographs.size);
  const auto judged = [&](const SolveVariant& variant) {
    return leave_out_lights(photographs, variant, patches, context);
  };
  const Result<solver::LeftOut> of_base = judged(base);
  if (!of_base) return of_base.error();
  const Result<solver::LeftOut> of_better = judged(better);
  if (!of_better) return of_better.error();
  const solver::Comparison comparison = solver::compare(*of_base, *of_better);
  if (comparison.frame.patches < solver::kLeastPatches)
    return solver::BlockChoice(comparison.grid, std::vector<float>(comparison.grid.count(), 1.0F));
  return comparison.choice();
}

}  // namespace weft::solve
