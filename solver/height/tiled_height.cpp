// SPDX-License-Identifier: Apache-2.0
#include "solver/height/tiled_height.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/vec.h"
#include "solver/height/cell_spline.h"
#include "solver/height/slopes.h"

namespace weft::solver {
namespace {

constexpr int kCell = CellSpline::kCell;

Error usage_of_tiles(std::string why, std::string remedy) {
  return {ErrorKind::kUsage, "no height in tiles", "", std::move(why), std::move(remedy)};
}

Result<void> check(const NormalRows& rows, const TiledHeightOptions& options) {
  if (rows.size.width <= 0 || rows.size.height <= 0) {
    return usage_of_tiles("the normal map is empty", "give a normal map");
  }
  if (options.tile_px < 64 || options.halo_px < 8 || options.halo_px > options.tile_px / 2) {
    return usage_of_tiles("the tile is under 64 pixels, or the halo not between 8 and half a tile",
                          "leave them at 512 and 128");
  }
  if (!(options.height.mm_per_pixel > 0) || !(options.height.steepest_deg > 0) ||
      !(options.height.steepest_deg < 90)) {
    return usage_of_tiles("mm_per_pixel or the steepest slope is out of range",
                          "give the millimetres a pixel covers, and a slope below 90 degrees");
  }
  return {};
}

/// Rows of normals as they are read.
struct RawBand {
  Image<float> normal;
  Image<std::uint8_t> weight;

  explicit RawBand(Size size) : normal(size, 3), weight(size) {}
  Result<void> read(const NormalRows& rows, int y0, int count) {
    const Rect part = {0, 0, rows.size.width, count};
    return rows.read(y0, {normal.plane(0).crop(part), normal.plane(1).crop(part), normal.plane(2).crop(part)},
                     weight.plane().crop(part));
  }
  Slopes slopes(double steepest) const {
    return {{normal.plane(0), normal.plane(1), normal.plane(2)}, weight.plane(), steepest};
  }
};

/// Mean slopes of cells as normals (-right, down, 1), and the weight of all their pixels.
struct Cells {
  Image<float> normal, weight;
  std::int64_t pixels = 0, clamped = 0;

  explicit Cells(Size size) : normal(size, 3), weight(size) {}
};

/// One row of pixels: its sums over cells, and counts.
struct CellSums {
  std::vector<double> weight, right, down;
  std::int64_t pixels = 0, clamped = 0;
};

void add_row(const SlopeRow& row, CellSums& sums) {
  for (std::size_t x = 0; x < row.weight.size(); ++x) {
    const std::size_t cell = x / kCell;
    const double w = static_cast<double>(row.weight[x]);
    sums.pixels += w > 0;
    if (cell >= sums.weight.size()) continue;
    sums.weight[cell] += w;
    sums.right[cell] += w * static_cast<double>(row.right[x]);
    sums.down[cell] += w * static_cast<double>(row.down[x]);
  }
  sums.clamped += row.clamped;
}

void write_row(const CellSums& sums, int cell_y, Cells& cells) {
  for (std::size_t cell = 0; cell < sums.weight.size(); ++cell) {
    const int x = static_cast<int>(cell);
    const double sum = sums.weight[cell];
    cells.normal(x, cell_y, 0) = static_cast<float>(sum > 0 ? -sums.right[cell] / sum : 0);
    cells.normal(x, cell_y, 1) = static_cast<float>(sum > 0 ? sums.down[cell] / sum : 0);
    cells.normal(x, cell_y, 2) = 1;
    cells.weight(x, cell_y) = static_cast<float>(sum);
  }
}

Result<Cells> cells_of(const NormalRows& rows, double steepest, int threads) {
  constexpr int kBandRows = 64 * kCell;
  Cells cells(CellSpline::cells_of(rows.size));
  RawBand band({rows.size.width, std::min(rows.size.height, kBandRows)});
  for (int y0 = 0; y0 < rows.size.height; y0 += kBandRows) {
    const int count = std::min(kBandRows, rows.size.height - y0);
    if (Result<void> done = band.read(rows, y0, count); !done) return std::move(done).error();
    const Slopes slopes = band.slopes(steepest);
    std::vector<CellSums> sums(static_cast<std::size_t>((count + kCell - 1) / kCell));
    parallel_for(sums.size(), threads, [&](std::size_t i, int) {
      const auto cell_count = static_cast<std::size_t>(cells.weight.width());
      for (auto* values : {&sums[i].weight, &sums[i].right, &sums[i].down}) values->resize(cell_count);
      SlopeRow row;
      const int first = static_cast<int>(i) * kCell, cell_y = y0 / kCell + static_cast<int>(i);
      for (int y = first; y < std::min(first + kCell, count); ++y) {
        slopes.read(y, row);
        add_row(row, sums[i]);
      }
      if (cell_y < cells.weight.height()) write_row(sums[i], cell_y, cells);
    });
    for (const CellSums& row : sums) {
      cells.pixels += row.pixels;
      cells.clamped += row.clamped;
    }
  }
  return cells;
}

bool counts_anywhere(View<const std::uint8_t> weight) {
  for (int y = 0; y < weight.height(); ++y) {
    if (std::any_of(weight.row(y), weight.row(y) + weight.width(), [](std::uint8_t w) { return w > 0; })) {
      return true;
    }
  }
  return false;
}

// Weights in 255ths of the largest.
Image<std::uint8_t> eight_bits(const Image<float>& weight) {
  float most = 0;
  for (int y = 0; y < weight.height(); ++y) {
    for (int x = 0; x < weight.width(); ++x) most = std::max(most, weight(x, y));
  }
  Image<std::uint8_t> bits(weight.size());
  if (most == 0) return bits;
  for (int y = 0; y < weight.height(); ++y) {
    for (int x = 0; x < weight.width(); ++x) {
      bits(x, y) = static_cast<std::uint8_t>(std::ceil(255 * weight(x, y) / most));
    }
  }
  return bits;
}

// A cell beside known ones takes their mean, as far out as pixels of a known cell draw on it: else the
// surface would fall to 0 around every hole.
void grow_into_holes(View<float> height, Image<std::uint8_t> known) {
  constexpr int kReach = 3;
  for (int round = 0; round < kReach; ++round) {
    Image<std::uint8_t> next(known.size());
    for (int y = 0; y < height.height(); ++y) {
      for (int x = 0; x < height.width(); ++x) {
        next(x, y) = known(x, y);
        if (known(x, y) != 0) continue;
        float sum = 0, count = 0;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height.height() - 1); ++v) {
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, height.width() - 1); ++u) {
            if (known(u, v) == 0) continue;
            sum += height(u, v);
            count += 1;
          }
        }
        if (count == 0) continue;
        height(x, y) = sum / count;
        next(x, y) = 1;
      }
    }
    known = std::move(next);
  }
}

Result<CellSpline> slow_part(const Cells& cells, HeightOptions options) {
  options.mm_per_pixel = kCell;  // heights in pixels of the frame
  options.steepest_deg = 89.99;  // pixels were held already
  Image<std::uint8_t> weight = eight_bits(cells.weight);
  if (cells.pixels > 0 && !counts_anywhere(weight.plane())) return CellSpline(cells.weight.plane());
  Result<Height> height = height_from_normals(
      {cells.normal.plane(0), cells.normal.plane(1), cells.normal.plane(2)}, weight.plane(), options);
  if (!height) return std::move(height).error();
  grow_into_holes(height->height_mm.plane(), std::move(weight));
  return CellSpline(height->height_mm.plane());
}

/// Where tiles begin, and the frame's end. The last is not narrower than a halo.
std::vector<int> tile_edges(int length, int tile, int halo) {
  std::vector<int> edges = {0};
  while (length - edges.back() - tile >= halo) edges.push_back(edges.back() + tile);
  edges.push_back(length);
  return edges;
}

/// What a tile counts at each pixel from its halo's begin on, along one axis.
struct Ramp {
  int begin = 0, end = 0;
  std::vector<float> weight;

  Ramp(int from, int to, int length, int halo)
      : begin(std::max(from - halo, 0)),
        end(std::min(to + halo, length)),
        weight(static_cast<std::size_t>(end - begin), 1.0f) {
    for (int i = 0; i < 2 * halo; ++i) {
      const double s = std::sin(kPi / 2 * (i + 0.5) / (2 * halo));
      const auto at = static_cast<std::size_t>(i);
      if (from > 0) weight[at] = static_cast<float>(s * s);
      if (to < length) weight[weight.size() - 1 - at] = static_cast<float>(s * s);
    }
  }
};

/// Rows of what the slow part leaves of the slopes, as normals (-right, down, 1), and of the weights. Rows
/// that two rows of tiles share are kept.
class RestBand {
 public:
  RestBand(const NormalRows& rows, const CellSpline& slow, double steepest, int most_rows)
      : rows_(rows),
        slow_(slow),
        steepest_(steepest),
        raw_({rows.size.width, most_rows}),
        normal_({rows.size.width, most_rows}, 2),
        weight_({rows.size.width, most_rows}),
        ones_(static_cast<std::size_t>(rows.size.width) + kRowGroup, 1.0f) {}

  /// Holds rows y0 <= y < y1 then; neither goes back.
  Result<void> move_to(int y0, int y1, int threads) {
    const int kept = std::max(y1_ - y0, 0);
    for (int y = 0; y < kept; ++y) {
      const int from = y + y0 - y0_;
      for (int p = 0; p < 2; ++p) std::copy_n(normal_.plane(p).row(from), width(), normal_.plane(p).row(y));
      std::copy_n(weight_.plane().row(from), width(), weight_.plane().row(y));
    }
    y0_ = y0;
    y1_ = y1;
    const int first = y0 + kept, count = y1 - first;
    if (Result<void> done = raw_.read(rows_, first, count); !done) return done;
    const Slopes slopes = raw_.slopes(steepest_);
    parallel_for(static_cast<std::size_t>(count), threads, [&](std::size_t i, int) {
      fill_row(slopes, static_cast<int>(i), first + static_cast<int>(i));
    });
    return {};
  }

  /// Views of absolute columns and rows.
  std::array<View<const float>, 3> normals(const Ramp& across, const Ramp& down) const {
    const Rect part = {across.begin, down.begin - y0_, across.end, down.end - y0_};
    return {normal_.plane(0).crop(part), normal_.plane(1).crop(part),
            View<const float>(ones_.data(), {part.width(), part.height()}, 0)};
  }
  View<const std::uint8_t> weights(const Ramp& across, const Ramp& down) const {
    return weight_.plane().crop({across.begin, down.begin - y0_, across.end, down.end - y0_});
  }
  const std::uint8_t* weights_of(int y) const { return weight_.plane().row(y - y0_); }

 private:
  int width() const { return rows_.size.width; }

  void fill_row(const Slopes& slopes, int raw_y, int y) {
    SlopeRow pixels;
    CellSpline::Row slow;
    slopes.read(raw_y, pixels);
    slow_.read(y, width(), slow);
    float *nx = normal_.plane(0).row(y - y0_), *ny = normal_.plane(1).row(y - y0_);
    std::uint8_t* weight = weight_.plane().row(y - y0_);
    for (int x = 0; x < width(); ++x) {
      const auto i = static_cast<std::size_t>(x);
      nx[x] = slow.right[i] - pixels.right[i];
      ny[x] = pixels.down[i] - slow.down[i];
      weight[x] = static_cast<std::uint8_t>(pixels.weight[i]);
    }
  }

  const NormalRows& rows_;
  const CellSpline& slow_;
  double steepest_;
  int y0_ = 0, y1_ = 0;
  RawBand raw_;
  Image<float> normal_;
  Image<std::uint8_t> weight_;
  std::vector<float> ones_;
};

std::vector<double> hann_window(int length) {
  std::vector<double> window(static_cast<std::size_t>(length));
  for (std::size_t i = 0; i < window.size(); ++i) {
    const double s = std::sin(kPi * (static_cast<double>(i) + 0.5) / length);
    window[i] = s * s;
  }
  return window;
}

// Mean 0 under a Hann window. Without it the part of a repeat that a tile cuts off would lift or lower the
// tile, and so would what makes up at the frame's border for neighbours that the slow part lacks.
void level(View<float> height, View<const std::uint8_t> weight) {
  const std::vector<double> across = hann_window(height.width()), down = hann_window(height.height());
  double sum = 0, total = 0;
  for (int y = 0; y < height.height(); ++y) {
    double of_row = 0, weight_of_row = 0;
    for (int x = 0; x < height.width(); ++x) {
      const double w = weight(x, y) > 0 ? across[static_cast<std::size_t>(x)] : 0;
      of_row += w * static_cast<double>(height(x, y));
      weight_of_row += w;
    }
    sum += down[static_cast<std::size_t>(y)] * of_row;
    total += down[static_cast<std::size_t>(y)] * weight_of_row;
  }
  const auto mean = static_cast<float>(sum / total);
  for (int y = 0; y < height.height(); ++y) {
    std::for_each(height.row(y), height.row(y) + height.width(), [mean](float& h) { h -= mean; });
  }
}

/// Solves rows of tiles and adds them up in a fixed order.
class TileSolver {
 public:
  TileSolver(Size size, const CellSpline& slow, const TiledHeightOptions& options, TiledHeight& result)
      : size_(size), slow_(slow), options_(options), result_(result) {
    const std::vector<int> edges = tile_edges(size.width, options.tile_px, options.halo_px);
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      across_.emplace_back(edges[i], edges[i + 1], size.width, options.halo_px);
    }
    solved_.resize(across_.size());
    options_.height.mm_per_pixel = 1;
    options_.height.steepest_deg = 89.99;  // pixels were held already
    options_.height.threads = 1;           // tiles run beside each other
  }

  Result<void> add_row(const RestBand& band, const Ramp& down) {
    std::vector<std::optional<Error>> failures(across_.size());
    parallel_for(across_.size(), threads_, [&](std::size_t i, int) {
      solved_[i].reset();
      if (!counts_anywhere(band.weights(across_[i], down))) return;
      Result<Height> height = height_from_normals(band.normals(across_[i], down),
                                                  band.weights(across_[i], down), options_.height);
      if (height) {
        solved_[i] = std::move(height).value();
        level(solved_[i]->height_mm.plane(), band.weights(across_[i], down));
      } else {
        failures[i] = std::move(height).error();
      }
    });
    for (std::optional<Error>& failure : failures) {
      if (failure) return *std::move(failure);
    }
    count_tiles();
    parallel_for(down.weight.size(), threads_, [&](std::size_t row, int) { blend_row(down, row); });
    return {};
  }

  /// Adds the slow part to rows that no tile adds to any more.
  void finish_rows(const RestBand& band, int y0, int y1, std::vector<double>& sums) {
    parallel_for(static_cast<std::size_t>(y1 - y0), threads_, [&](std::size_t i, int) {
      const int y = y0 + static_cast<int>(i);
      CellSpline::Row slow;
      slow_.read(y, size_.width, slow);
      float* height = result_.height_mm.plane().row(y);
      const std::uint8_t* weight = band.weights_of(y);
      double sum = 0;
      for (int x = 0; x < size_.width; ++x) {
        height[x] = weight[x] > 0 ? height[x] + slow.height[static_cast<std::size_t>(x)]
                                  : std::numeric_limits<float>::quiet_NaN();
        if (weight[x] > 0) sum += static_cast<double>(height[x]);
      }
      sums[static_cast<std::size_t>(y)] = sum;
    });
  }

 private:
  void count_tiles() {
    for (const std::optional<Height>& tile : solved_) {
      if (!tile) continue;
      ++result_.tiles;
      result_.iterated_tiles += tile->method == HeightMethod::kMultigrid;
      const double pixels = static_cast<double>(tile->pixels);
      residual_squares_ += pixels * tile->slope_residual_rms * tile->slope_residual_rms;
      residual_pixels_ += pixels;
    }
    result_.slope_residual_rms = residual_pixels_ > 0 ? std::sqrt(residual_squares_ / residual_pixels_) : 0;
  }

  void blend_row(const Ramp& down, std::size_t row) {
    float* out = result_.height_mm.plane().row(down.begin + static_cast<int>(row));
    for (std::size_t i = 0; i < across_.size(); ++i) {
      if (!solved_[i]) continue;
      const Ramp& ramp = across_[i];
      const float* tile = solved_[i]->height_mm.plane().row(static_cast<int>(row));
      for (std::size_t x = 0; x < ramp.weight.size(); ++x) {
        out[ramp.begin + static_cast<int>(x)] += down.weight[row] * ramp.weight[x] * tile[x];
      }
    }
  }

  Size size_;
  const CellSpline& slow_;
  TiledHeightOptions options_;
  int threads_ = options_.height.threads;
  TiledHeight& result_;
  std::vector<Ramp> across_;
  std::vector<std::optional<Height>> solved_;
  double residual_squares_ = 0, residual_pixels_ = 0;
};

// Mean 0 and millimetres; pixels that do not count, marked by NaN so far, become 0.
void finish(double mean_px, double mm_per_pixel, View<float> height, int threads) {
  parallel_for(static_cast<std::size_t>(height.height()), threads, [&](std::size_t y, int) {
    float* row = height.row(static_cast<int>(y));
    for (int x = 0; x < height.width(); ++x) {
      const double h = static_cast<double>(row[x]);
      row[x] = std::isnan(h) ? 0.0f : static_cast<float>((h - mean_px) * mm_per_pixel);
    }
  });
}

}  // namespace

NormalRows rows_of(const std::array<View<const float>, 3>& normal, View<const std::uint8_t> mask) {
  return {normal[0].size(),
          [normal, mask](int y0, const std::array<View<float>, 3>& out,
                         View<std::uint8_t> weight) -> Result<void> {
            for (int y = 0; y < weight.height(); ++y) {
              for (std::size_t p = 0; p < 3; ++p) {
                std::copy_n(normal[p].row(y0 + y), weight.width(), out[p].row(y));
              }
              if (mask.empty()) {
                std::fill_n(weight.row(y), weight.width(), std::uint8_t{1});
              } else {
                std::copy_n(mask.row(y0 + y), weight.width(), weight.row(y));
              }
            }
            return {};
          }};
}

Result<TiledHeight> tiled_height(const NormalRows& rows, const TiledHeightOptions& options) {
  if (Result<void> good = check(rows, options); !good) return std::move(good).error();
  const int threads = options.height.threads, halo = options.halo_px;
  const double steepest = std::tan(radians(options.height.steepest_deg));
  const Result<Cells> cells = cells_of(rows, steepest, threads);
  if (!cells) return cells.error();
  const Result<CellSpline> slow = slow_part(*cells, options.height);
  if (!slow) return slow.error();

  TiledHeight result;
  result.height_mm = Image<float>(rows.size);
  result.pixels = cells->pixels;
  result.clamped = cells->clamped;
  TileSolver solver(rows.size, *slow, options, result);
  const int height = rows.size.height;
  RestBand band(rows, *slow, steepest, std::min(options.tile_px + 3 * halo, height));
  std::vector<double> sums(static_cast<std::size_t>(height));
  const std::vector<int> edges = tile_edges(height, options.tile_px, halo);
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const Ramp down(edges[i], edges[i + 1], height, halo);
    if (Result<void> done = band.move_to(down.begin, down.end, threads); !done)
      return std::move(done).error();
    if (Result<void> done = solver.add_row(band, down); !done) return std::move(done).error();
    const bool is_last = edges[i + 1] == height;
    solver.finish_rows(band, down.begin, is_last ? height : edges[i + 1] - halo, sums);
  }
  double sum = 0;
  for (const double row : sums) sum += row;
  finish(sum / static_cast<double>(result.pixels), options.height.mm_per_pixel, result.height_mm.plane(),
         threads);
  return result;
}

}  // namespace weft::solver
