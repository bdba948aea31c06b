// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "material/filtering/boxes.h"
#include "material/opacity/opacity.h"

namespace weft::material {
namespace {

// Means of the level before, each by the share of it that a texel covers.
Image<float> shrunk(View<const float> finer, Size size, int threads) {
  Image<float> made(size);
  parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    const Box down(y, size.height, finer.height());
    for (int x = 0; x < size.width; ++x) {
      const Box across(x, size.width, finer.width());
      double sum = 0, weight = 0;
      for (int j = 0; j < down.count; ++j) {
        for (int i = 0; i < across.count; ++i) {
          const double share = across.share(i) * down.share(j);
          sum += share * double{finer(across.first + i, down.first + j)};
          weight += share;
        }
      }
      made(x, y) = static_cast<float>(sum / weight);
    }
  });
  return made;
}

std::vector<float> values_of(View<const float> map) {
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(map.size().pixels()));
  for (int y = 0; y < map.height(); ++y) values.insert(values.end(), map.row(y), map.row(y) + map.width());
  return values;
}

double coverage_of(View<const float> map, double threshold) {
  std::int64_t covered = 0;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) covered += double{map(x, y)} >= threshold;
  }
  return static_cast<double>(covered) / static_cast<double>(map.size().pixels());
}

// What brings so many of the largest values to the threshold.
double scale_for(View<const float> means, double coverage, double threshold) {
  std::vector<float> values = values_of(means);
  const auto covered = static_cast<std::size_t>(std::lround(coverage * static_cast<double>(values.size())));
  if (covered == 0 || covered == values.size()) return 1;
  const double last_in = double{value_of_rank<float>(values, values.size() - covered)};
  const double first_out = double{value_of_rank<float>(values, values.size() - covered - 1)};
  const double between = (last_in + first_out) / 2;
  return between > 0 ? threshold / between : 1;
}

}  // namespace

Result<std::vector<OpacityMip>> opacity_mips(View<const float> opacity, const OpacityMipOptions& options) {
  const auto refused = [](std::string why, std::string remedy) {
    return Error{ErrorKind::kUsage, "no mips of opacity can be made", "mips", std::move(why),
                 std::move(remedy)};
  };
  if (opacity.size().pixels() == 0) return refused("there are no pixels", "give a map that has some");
  if (!(options.threshold > 0 && options.threshold < 1)) {
    return refused(fmt::format("the threshold {:g} is not between 0 and 1", options.threshold), "take 0.5");
  }
  const double coverage = coverage_of(opacity, options.threshold);
  std::vector<OpacityMip> levels;
  Image<float> means;
  for (int level = 1; level <= last_level(opacity.size()); ++level) {
    const Size size = size_of_level(opacity.size(), level);
    means = shrunk(level == 1 ? opacity : std::as_const(means).plane(), size, options.threads);
    OpacityMip mip = {level, Image<float>(size), 1, 0};
    if (options.keep_coverage) mip.scale = scale_for(means.plane(), coverage, options.threshold);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        mip.map(x, y) = static_cast<float>(std::clamp(mip.scale * double{means(x, y)}, 0.0, 1.0));
      }
    }
    mip.coverage = coverage_of(mip.map.plane(), options.threshold);
    levels.push_back(std::move(mip));
  }
  return levels;
}

}  // namespace weft::material
