// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "core/image_io/image_io.h"
#include "core/vec.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

struct Pair {
  LoadedImage tested, truth;
  std::optional<LoadedImage> mask;
};

Result<LoadedImage> read_map(const fs::path& file) {
  Result<LoadedImage> map = read_image(file);
  if (map && map->planes.planes() < 3) {
    return Error{ErrorKind::kBadData, "not a map of three channels", file.string(),
                 fmt::format("it has {}", map->planes.planes()), "name a normal or albedo map"};
  }
  return map;
}

Result<Pair> read_pair(const fs::path& tested_file, const fs::path& truth_file, const fs::path& mask_file) {
  Result<LoadedImage> tested = read_map(tested_file);
  if (!tested) return std::move(tested).error();
  Result<LoadedImage> truth = read_map(truth_file);
  if (!truth) return std::move(truth).error();
  Pair pair = {std::move(*tested), std::move(*truth), std::nullopt};
  const auto check_size = [&](const LoadedImage& image, const fs::path& file) -> Result<void> {
    if (image.info.size == pair.tested.info.size) return {};
    return Error{ErrorKind::kBadData, "images differ in size", file.string(),
                 fmt::format("{} x {} pixels, {} has {} x {}", image.info.size.width, image.info.size.height,
                             tested_file.string(), pair.tested.info.size.width, pair.tested.info.size.height),
                 "compare maps of the same photographs"};
  };
  if (Result<void> ok = check_size(pair.truth, truth_file); !ok) return std::move(ok).error();
  if (!mask_file.empty()) {
    Result<LoadedImage> mask = read_image(mask_file);
    if (!mask) return std::move(mask).error();
    if (Result<void> ok = check_size(*mask, mask_file); !ok) return std::move(ok).error();
    pair.mask = std::move(*mask);
  }
  return pair;
}

using Triple = std::array<double, 3>;

// Calls visit(tested, truth) for every pixel that counts, row by row.
void for_each_counted(const Pair& pair, const std::function<void(const Triple&, const Triple&)>& visit) {
  const auto at = [](const LoadedImage& image, int x, int y) {
    return Triple{image.planes(x, y, 0), image.planes(x, y, 1), image.planes(x, y, 2)};
  };
  const auto finite = [](const Triple& t) {
    return std::isfinite(t[0]) && std::isfinite(t[1]) && std::isfinite(t[2]);
  };
  for (int y = 0; y < pair.tested.info.size.height; ++y) {
    for (int x = 0; x < pair.tested.info.size.width; ++x) {
      if (pair.mask && !(pair.mask->planes(x, y) > 0.5f)) continue;
      const Triple a = at(pair.tested, x, y), b = at(pair.truth, x, y);
      if (finite(a) && finite(b) && (b[0] != 0 || b[1] != 0 || b[2] != 0)) visit(a, b);
    }
  }
}

// Integer files hold (n + 1) / 2.
Vec3 normal_of(const Triple& t, const ImageFileInfo& info) {
  const bool encoded = info.type == SampleType::kUint8 || info.type == SampleType::kUint16;
  return encoded ? Vec3{2 * t[0] - 1, 2 * t[1] - 1, 2 * t[2] - 1} : Vec3{t[0], t[1], t[2]};
}

Error nothing_counts(const fs::path& tested) {
  return {ErrorKind::kBadData, "nothing to compare", tested.string(),
          "no pixel is inside the mask and finite", "check the mask and that both files are maps"};
}

}  // namespace

NormalComparison summarize(std::vector<float>& angles_deg) {
  std::sort(angles_deg.begin(), angles_deg.end());
  NormalComparison c;
  c.pixels = static_cast<std::int64_t>(angles_deg.size());
  if (angles_deg.empty()) return c;
  double sum = 0;
  for (const float a : angles_deg) sum += a;
  const auto rank = [&](double share) {
    return angles_deg[static_cast<std::size_t>(
        std::lround(share * static_cast<double>(angles_deg.size() - 1)))];
  };
  c.mean_deg = sum / static_cast<double>(angles_deg.size());
  c.median_deg = rank(0.5);
  c.p95_deg = rank(0.95);
  c.max_deg = angles_deg.back();
  return c;
}

Result<NormalComparison> compare_normals(const fs::path& tested, const fs::path& truth,
                                         const fs::path& mask) {
  const Result<Pair> pair = read_pair(tested, truth, mask);
  if (!pair) return pair.error();
  std::vector<float> angles;
  for_each_counted(*pair, [&](const Triple& a, const Triple& b) {
    angles.push_back(
        static_cast<float>(angle_deg(normal_of(a, pair->tested.info), normal_of(b, pair->truth.info))));
  });
  if (angles.empty()) return nothing_counts(tested);
  return summarize(angles);
}

Result<AlbedoComparison> compare_albedo(const fs::path& tested, const fs::path& truth, const fs::path& mask) {
  const Result<Pair> pair = read_pair(tested, truth, mask);
  if (!pair) return pair.error();
  AlbedoComparison c;
  std::int64_t samples = 0;
  for_each_counted(*pair, [&](const Triple& a, const Triple& b) {
    ++c.pixels;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(b[i] > 0)) continue;
      ++samples;
      c.mean_rel += std::abs(a[i] - b[i]) / b[i];
      c.bias_rel += (a[i] - b[i]) / b[i];
    }
  });
  if (samples == 0) return nothing_counts(tested);
  c.mean_rel /= static_cast<double>(samples);
  c.bias_rel /= static_cast<double>(samples);
  return c;
}

}  // namespace weft::app
