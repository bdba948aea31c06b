// SPDX-License-Identifier: Apache-2.0
#include "material/filtering/roughness_mips.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "core/solve/solve_record.h"
#include "material/filtering/boxes.h"
#include "material/filtering/normal_length.h"

namespace weft::material {
namespace {

// Levels up to this one are summed from the pixels, since the sums of a hundred megapixels at level 1 would
// take 4 GB; the rest from the sums of the level before.
constexpr int kLastFromPixels = 3;
constexpr int kSamplesAcross = 4;  // of a pixel whose slopes go on linearly

Vec3 normal_of(double slope_x, double slope_y) {
  return normalized({-slope_x, -slope_y, 1});
}

/// Pixels of a surface as the parts of footprints.
class PixelSums {
 public:
  PixelSums(const Surface& surface, const MipOptions& options)
      : surface_(surface), options_(options), typed_shortening_(length_of(lobe_at(0, 0))) {}

  void add_to(Footprint& sum, double share, int x, int y) const {
    if ((surface_.status(x, y) & kNoSolution) != 0) return;
    const double weight = surface_.opacity.empty() ? share : share * double{surface_.opacity(x, y)};
    if (!(weight > 0)) return;
    const LobeWidth lobe = lobe_at(x, y);
    const double shortening = options_.rule == MipRule::kLengths ? shortening_of(lobe) : 1;
    if (options_.pixels == PixelMeaning::kFacet) {
      add_normal(sum, weight, normal_of(slope(x, y, 0), slope(x, y, 1)), lobe, shortening);
      return;
    }
    constexpr double kShare = 1.0 / (kSamplesAcross * kSamplesAcross);
    for (int j = 0; j < kSamplesAcross; ++j) {
      for (int i = 0; i < kSamplesAcross; ++i) {
        const double u = x + (i + 0.5) / kSamplesAcross - 0.5, v = y + (j + 0.5) / kSamplesAcross - 0.5;
        add_normal(sum, kShare * weight, normal_of(slope_at(u, v, 0), slope_at(u, v, 1)), lobe, shortening);
      }
    }
  }

 private:
  void add_normal(Footprint& sum, double weight, Vec3 n, const LobeWidth& lobe, double shortening) const {
    const double area = options_.weight == NormalWeight::kFacet ? 1 / n.z : 1;
    sum.add(weight * area, n, lobe, shortening);
  }

  LobeWidth lobe_at(int x, int y) const {
    if (surface_.lobe.empty()) return {options_.alpha, options_.alpha * options_.along, 0};
    const auto alpha = [&](int plane) { return std::clamp(double{surface_.lobe(x, y, plane)}, 0.0, 1.0); };
    return {alpha(0), alpha(1), double{surface_.lobe(x, y, 2)}};
  }

  double shortening_of(const LobeWidth& lobe) const {
    return surface_.lobe.empty() ? typed_shortening_ : length_of(lobe);
  }

  static double length_of(const LobeWidth& lobe) {
    return normal_length(std::sqrt((lobe.across * lobe.across + lobe.along * lobe.along) / 2));
  }

  double slope(int x, int y, int plane) const { return double{surface_.slope(x, y, plane)}; }

  // Between pixels; beyond the border of a tile on its other side, else as at the border.
  double slope_at(double x, double y, int plane) const {
    const Size size = surface_.size();
    const auto place = [&](int i, int n) {
      return surface_.is_tile ? (i % n + n) % n : std::clamp(i, 0, n - 1);
    };
    const double x0 = std::floor(x), y0 = std::floor(y), u = x - x0, v = y - y0;
    const int left = place(static_cast<int>(x0), size.width),
              right = place(static_cast<int>(x0) + 1, size.width);
    const int top = place(static_cast<int>(y0), size.height),
              bottom = place(static_cast<int>(y0) + 1, size.height);
    return (1 - v) * ((1 - u) * slope(left, top, plane) + u * slope(right, top, plane)) +
           v * ((1 - u) * slope(left, bottom, plane) + u * slope(right, bottom, plane));
  }

  const Surface& surface_;
  const MipOptions& options_;
  double typed_shortening_;
};

/// The footprints of a level, kept for the next.
struct Sums {
  Size size;
  std::vector<Footprint> footprints;

  bool empty() const { return footprints.empty(); }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
  }
};

// `add`(sum, share, x, y) of all that texel (x, y) of a level covers of a finer one.
template <typename Add>
Footprint gathered(int x, int y, Size size, Size finer, const Add& add) {
  const Box across(x, size.width, finer.width), down(y, size.height, finer.height);
  Footprint sum;
  for (int j = 0; j < down.count; ++j) {
    for (int i = 0; i < across.count; ++i) {
      add(sum, across.share(i) * down.share(j), across.first + i, down.first + j);
    }
  }
  return sum;
}

void store(const MipTexel& texel, MipLevel& level, int x, int y) {
  const std::array<double, 3> normal = {texel.normal.x, texel.normal.y, texel.normal.z};
  const std::array<double, 3> lobe = {texel.lobe.across, texel.lobe.along, texel.lobe.azimuth_deg};
  for (int p = 0; p < 3; ++p) {
    level.normal(x, y, p) = static_cast<float>(normal[static_cast<std::size_t>(p)]);
    level.lobe(x, y, p) = static_cast<float>(lobe[static_cast<std::size_t>(p)]);
  }
}

double mean_alpha(const Image<float>& lobe) {
  double squares = 0;
  for (int y = 0; y < lobe.height(); ++y) {
    for (int x = 0; x < lobe.width(); ++x) {
      const double across = double{lobe(x, y, 0)}, along = double{lobe(x, y, 1)};
      squares += (across * across + along * along) / 2;
    }
  }
  return std::sqrt(squares / static_cast<double>(lobe.size().pixels()));
}

// A level from its footprints; `kept`, where it has room, keeps them.
template <typename FootprintAt>
MipLevel level_of(int level, Size size, const MipOptions& options, Sums& kept, const FootprintAt& at) {
  MipLevel made = {level, Image<float>(size, 3), Image<float>(size, 3), 0};
  parallel_for(static_cast<std::size_t>(size.height), options.threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size.width; ++x) {
      const Footprint sum = at(x, y);
      store(filtered(sum, options.rule), made, x, y);
      if (!kept.empty()) kept.footprints[kept.index(x, y)] = sum;
    }
  });
  made.mean_alpha = mean_alpha(made.lobe);
  return made;
}

Result<void> check(const Surface& surface, const MipOptions& options) {
  const auto refused = [](std::string why, std::string remedy) {
    return Error{ErrorKind::kUsage, "no mips can be made", "mips", std::move(why), std::move(remedy)};
  };
  if (surface.size().pixels() == 0) return refused("the surface has no pixels", "give one that has");
  for (const double each : {options.alpha, options.alpha * options.along}) {
    if (!(each >= 0 && each <= 1))
      return refused(fmt::format("alpha {:g} is not in 0 to 1", each), "give one in that range");
  }
  if (options.finest < 0) return refused("levels begin at 0", "begin at 0 or above");
  if (options.base.width > surface.size().width || options.base.height > surface.size().height) {
    return refused(fmt::format("{} x {} pixels are asked for, the surface has {} x {}", options.base.width,
                               options.base.height, surface.size().width, surface.size().height),
                   "ask for at most as many");
  }
  return {};
}

}  // namespace

Result<std::vector<MipLevel>> roughness_mips(const Surface& surface, const MipOptions& options) {
  if (Result<void> ok = check(surface, options); !ok) return std::move(ok).error();
  const PixelSums pixels(surface, options);
  const Size base = options.base.pixels() > 0 ? options.base : surface.size();
  std::vector<MipLevel> levels;
  Sums before;
  for (int level = options.finest; level <= last_level(base); ++level) {
    const Size size = size_of_level(base, level);
    Sums kept = {size, {}};
    if (level >= kLastFromPixels) kept.footprints.resize(static_cast<std::size_t>(size.pixels()));
    levels.push_back(level_of(level, size, options, kept, [&](int x, int y) {
      if (before.empty()) {
        return gathered(x, y, size, surface.size(),
                        [&](Footprint& sum, double share, int i, int j) { pixels.add_to(sum, share, i, j); });
      }
      return gathered(x, y, size, before.size, [&](Footprint& sum, double share, int i, int j) {
        sum.add(share, before.footprints[before.index(i, j)]);
      });
    }));
    before = std::move(kept);
  }
  return levels;
}

}  // namespace weft::material
