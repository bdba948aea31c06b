// SPDX-License-Identifier: Apache-2.0
#include "solver/left_out/block_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace weft::solver {
namespace {

// Half a block: inside a cell of this side that begins at a multiple of it, four weights decide.
constexpr int kHalf = kBlock / 2;

template <typename T>
std::array<View<T>, 3> crop(const std::array<View<T>, 3>& views, Rect r) {
  std::array<View<T>, 3> part;
  for (std::size_t c = 0; c < 3; ++c) part[c] = views[c].empty() ? views[c] : views[c].crop(r);
  return part;
}

// The maps of one plane more or less, as large as a cell.
struct CellMaps {
  Image<float> planes{{kHalf, kHalf}, 8};
  Image<std::uint16_t> status{{kHalf, kHalf}};

  TileOutput output(Rect r, SolveTally* tally) {
    TileOutput out;
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(c);
      out.normal[i] = planes.plane(c).crop(r);
      out.albedo[i] = planes.plane(3 + c).crop(r);
    }
    out.sigma_normal_deg = planes.plane(6).crop(r);
    out.residual = planes.plane(7).crop(r);
    for (int c = 0; c < 3; ++c) out.sigma_albedo[static_cast<std::size_t>(c)] = sigma.plane(c).crop(r);
    out.status = status.plane().crop(r);
    out.tally = tally;
    return out;
  }
  Image<float> sigma{{kHalf, kHalf}, 3};
};

// `views` keeps those of its readings.
TileInput part_of(const TileInput& input, Rect part, std::vector<View<const float>>& views) {
  const Rect local = {part.x0 - input.tile.x0, part.y0 - input.tile.y0, part.x1 - input.tile.x0,
                      part.y1 - input.tile.y0};
  views.clear();
  for (const auto& readings : {input.readings, input.parallel}) {
    for (const View<const float>& reading : readings) views.push_back(reading.crop(local));
  }
  TileInput cropped = input;
  cropped.tile = part;
  cropped.readings = std::span(views).first(input.readings.size());
  cropped.parallel = std::span(views).subspan(input.readings.size());
  return cropped;
}

TileOutput part_of(const TileOutput& output, Rect tile, Rect part) {
  const Rect local = {part.x0 - tile.x0, part.y0 - tile.y0, part.x1 - tile.x0, part.y1 - tile.y0};
  return {crop(output.normal, local),
          crop(output.albedo, local),
          output.sigma_normal_deg.crop(local),
          crop(output.sigma_albedo, local),
          output.residual.crop(local),
          output.status.crop(local),
          output.tally};
}

float lerp(float a, float b, float weight) {
  return a + weight * (b - a);
}

// `into` towards `better` by `weight`, at one pixel.
void blend_pixel(const TileOutput& into, const TileOutput& better, int x, int y, int planes, float weight) {
  std::array<float, 3> n;
  for (std::size_t c = 0; c < 3; ++c) n[c] = lerp(into.normal[c](x, y), better.normal[c](x, y), weight);
  const float norm = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (std::size_t c = 0; c < 3 && norm > 0; ++c) into.normal[c](x, y) = n[c] / norm;
  const auto move = [&](const View<float>& a, const View<float>& b) {
    a(x, y) = lerp(a(x, y), b(x, y), weight);
  };
  for (std::size_t p = 0; p < static_cast<std::size_t>(planes); ++p) {
    move(into.albedo[p], better.albedo[p]);
    move(into.sigma_albedo[p], better.sigma_albedo[p]);
  }
  move(into.sigma_normal_deg, better.sigma_normal_deg);
  move(into.residual, better.residual);
  if (weight >= 0.5F) into.status(x, y) = better.status(x, y);
}

class Blended : public Method {
 public:
  Blended(const Method& base, const Method& better, BlockChoice choice)
      : base_(base), better_(better), choice_(std::move(choice)) {}

  void solve(const TileInput& input, const TileOutput& output) const override {
    const Rect& tile = input.tile;
    std::vector<View<const float>> readings;
    for (int y0 = tile.y0; y0 < tile.y1; y0 = next(y0, tile.y1)) {
      for (int x0 = tile.x0; x0 < tile.x1; x0 = next(x0, tile.x1)) {
        const Rect part = {x0, y0, next(x0, tile.x1), next(y0, tile.y1)};
        solve_part(part_of(input, part, readings), part_of(output, tile, part));
      }
    }
  }
  bool wants_rgb() const override { return base_.wants_rgb(); }
  double reflected(const TileInput& input, const TileOutput& output, int x, int y, Vec3 light,
                   double lobe_share) const override {
    const bool is_better = choice_.weight_at(input.tile.x0 + x, input.tile.y0 + y) >= 0.5F;
    return (is_better ? better_ : base_).reflected(input, output, x, y, light, lobe_share);
  }

 private:
  static int next(int at, int end) { return std::min((at / kHalf + 1) * kHalf, end); }

  // A part inside one cell of kHalf pixels.
  void solve_part(const TileInput& input, const TileOutput& output) const {
    const int x0 = input.tile.x0 / kHalf * kHalf, y0 = input.tile.y0 / kHalf * kHalf;
    const std::array<float, 4> corners = {choice_.weight_at(x0, y0), choice_.weight_at(x0 + kHalf - 1, y0),
                                          choice_.weight_at(x0, y0 + kHalf - 1),
                                          choice_.weight_at(x0 + kHalf - 1, y0 + kHalf - 1)};
    if (std::ranges::all_of(corners, [](float w) { return w == 0; })) return base_.solve(input, output);
    if (std::ranges::all_of(corners, [](float w) { return w == 1; })) return better_.solve(input, output);
    thread_local CellMaps maps;
    TileOutput base = output;
    base.tally = nullptr;
    base_.solve(input, base);
    const TileOutput better = maps.output({0, 0, input.tile.width(), input.tile.height()}, output.tally);
    better_.solve(input, better);
    for (int y = 0; y < input.tile.height(); ++y) {
      for (int x = 0; x < input.tile.width(); ++x) {
        blend_pixel(output, better, x, y, input.planes,
                    choice_.weight_at(input.tile.x0 + x, input.tile.y0 + y));
      }
    }
  }

  const Method& base_;
  const Method& better_;
  BlockChoice choice_;
};

}  // namespace

BlockChoice::BlockChoice(BlockGrid grid, std::vector<float> weights)
    : grid_(grid), weights_(std::move(weights)) {}

double BlockChoice::share() const {
  return std::accumulate(weights_.begin(), weights_.end(), 0.0) / static_cast<double>(weights_.size());
}

float BlockChoice::weight_at(int x, int y) const {
  // Centres of blocks lie at (i + 1/2) kBlock. Multiples of 1/512 are exact, so equal weights stay equal.
  struct Place {
    int low, high;
    float share;
  };
  const auto place = [](int at, int count) {
    const int from = 2 * at + 1 - kBlock;  // half pixels from the first centre
    if (from <= 0) return Place{0, 0, 0};
    const int low = std::min(from / (2 * kBlock), count - 1);
    return Place{low, std::min(low + 1, count - 1),
                 static_cast<float>(from - low * 2 * kBlock) / static_cast<float>(2 * kBlock)};
  };
  const Place column = place(x, grid_.columns), row = place(y, grid_.rows);
  const auto weight = [&](int i, int j) { return weights_[static_cast<std::size_t>(j * grid_.columns + i)]; };
  const float upper = lerp(weight(column.low, row.low), weight(column.high, row.low), column.share);
  const float lower = lerp(weight(column.low, row.high), weight(column.high, row.high), column.share);
  return lerp(upper, lower, row.share);
}

std::unique_ptr<Method> blended_method(const Method& base, const Method& better, BlockChoice choice) {
  return std::make_unique<Blended>(base, better, std::move(choice));
}

}  // namespace weft::solver
