// SPDX-License-Identifier: Apache-2.0
#include "material/filtering/texture_mips.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/color_spaces.h"
#include "core/parallel.h"
#include "material/filtering/boxes.h"

namespace weft::material {
namespace {

constexpr std::size_t kMostPlanes = 4;
constexpr double kLeastMipHeight = 0.05;  // of a normal: slopes of 20

using Values = std::array<double, kMostPlanes>;

/// A box of at most three pixels with its shares.
struct Span {
  int first = 0, count = 0;
  std::array<double, 3> share = {};
};

// A side of 1 stays 1, any other is halved: a texel touches three of it at most.
std::vector<Span> spans_of(int coarse, int fine) {
  std::vector<Span> spans(static_cast<std::size_t>(coarse));
  for (int i = 0; i < coarse; ++i) {
    const Box box(i, coarse, fine);
    Span& span = spans[static_cast<std::size_t>(i)];
    span.first = box.first;
    span.count = std::min(box.count, 3);
    for (int k = 0; k < span.count; ++k) span.share[static_cast<std::size_t>(k)] = box.share(k);
  }
  return spans;
}

void to_linear(Values& v) {
  const Rgb linear = rec709_of_srgb({v[0], v[1], v[2]});
  std::copy(linear.begin(), linear.end(), v.begin());
}

void from_linear(Values& v) {
  const Rgb display = srgb_of_rec709({v[0], v[1], v[2]});
  std::copy(display.begin(), display.end(), v.begin());
}

// x and y become slopes; z is left as whether there is a normal.
void to_slopes(Values& v) {
  const double z = std::max(v[2], kLeastMipHeight);
  const bool is_normal = std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
  v[0] = is_normal ? v[0] / z : NAN;
  v[1] = is_normal ? v[1] / z : NAN;
}

void from_slopes(Values& v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + 1);
  v = {v[0] / length, v[1] / length, 1 / length, 0};
}

class Mip {
 public:
  Mip(std::span<const View<const float>> planes, MipMean mean)
      : planes_(planes),
        mean_(mean),
        fine_(planes[0].size()),
        coarse_(size_of_level(fine_, 1)),
        columns_(spans_of(coarse_.width, fine_.width)),
        rows_(spans_of(coarse_.height, fine_.height)),
        image_(coarse_, static_cast<int>(planes.size())) {}

  Image<float> made(int threads) {
    parallel_for(static_cast<std::size_t>(coarse_.height), threads, [&](std::size_t y, int) {
      for (std::size_t x = 0; x < columns_.size(); ++x) {
        const Values mean = mean_of(columns_[x], rows_[y]);
        for (int p = 0; p < image_.planes(); ++p) {
          image_(static_cast<int>(x), static_cast<int>(y), p) =
              static_cast<float>(mean[static_cast<std::size_t>(p)]);
        }
      }
    });
    return std::move(image_);
  }

 private:
  Values at(int x, int y) const {
    Values v = {};
    for (std::size_t p = 0; p < planes_.size(); ++p) v[p] = static_cast<double>(planes_[p](x, y));
    if (mean_ == MipMean::kSrgb) to_linear(v);
    if (mean_ == MipMean::kNormal) to_slopes(v);
    return v;
  }

  Values mean_of(const Span& columns, const Span& rows) const {
    Values sum = {}, weight = {};
    for (int j = 0; j < rows.count; ++j) {
      for (int i = 0; i < columns.count; ++i) {
        const double share =
            columns.share[static_cast<std::size_t>(i)] * rows.share[static_cast<std::size_t>(j)];
        const Values v = at(columns.first + i, rows.first + j);
        for (std::size_t p = 0; p < planes_.size(); ++p) {
          if (!std::isfinite(v[p])) continue;
          sum[p] += share * v[p];
          weight[p] += share;
        }
      }
    }
    for (std::size_t p = 0; p < planes_.size(); ++p) sum[p] = weight[p] > 0 ? sum[p] / weight[p] : 0;
    if (mean_ == MipMean::kSrgb) from_linear(sum);
    if (mean_ == MipMean::kNormal) from_slopes(sum);
    return sum;
  }

  std::span<const View<const float>> planes_;
  MipMean mean_;
  Size fine_, coarse_;
  std::vector<Span> columns_, rows_;
  Image<float> image_;
};

Result<void> check_planes(std::span<const View<const float>> planes, MipMean mean) {
  const auto refused = [&](std::string why) {
    return Error{ErrorKind::kUsage, "no smaller level of these planes", name_of(mean), std::move(why),
                 "give planes of one size"};
  };
  const std::size_t count = planes.size();
  const bool fits = mean == MipMean::kNormal ? count == 3
                    : mean == MipMean::kSrgb ? count == 3 || count == 4
                                             : count >= 1 && count <= kMostPlanes;
  if (!fits) return refused(fmt::format("{} planes", count));
  if (planes[0].width() < 1 || planes[0].height() < 1) return refused("there are no pixels");
  for (const auto& plane : planes) {
    if (plane.size() != planes[0].size()) return refused("their sizes differ");
  }
  return {};
}

}  // namespace

const char* name_of(MipMean mean) {
  return mean == MipMean::kPlain ? "plain" : mean == MipMean::kSrgb ? "srgb" : "normal";
}

std::optional<MipMean> mip_mean_named(std::string_view name) {
  for (const MipMean mean : {MipMean::kPlain, MipMean::kSrgb, MipMean::kNormal}) {
    if (name == name_of(mean)) return mean;
  }
  return std::nullopt;
}

Result<Image<float>> next_mip(std::span<const View<const float>> planes, MipMean mean, int threads) {
  if (const auto good = check_planes(planes, mean); !good) return good.error();
  return Mip(planes, mean).made(threads);
}

Result<std::vector<Image<float>>> mip_chain(std::span<const View<const float>> planes, MipMean mean,
                                            int threads, int most) {
  if (const auto good = check_planes(planes, mean); !good) return good.error();
  std::vector<Image<float>> levels;
  const int last = std::min(last_level(planes[0].size()), most);
  std::vector<View<const float>> finer(planes.begin(), planes.end());
  for (int level = 1; level <= last; ++level) {
    levels.push_back(Mip(finer, mean).made(threads));
    const Image<float>& made = levels.back();
    for (std::size_t p = 0; p < finer.size(); ++p) finer[p] = made.plane(static_cast<int>(p));
  }
  return levels;
}

}  // namespace weft::material
