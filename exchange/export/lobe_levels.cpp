// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/lobe_levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/image_io/image_io.h"
#include "exchange/presets/channels.h"
#include "material/filtering/roughness_mips.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using exchange::Plane;

constexpr float kFlattest = 0.001F;  // a z that is lower counts as this

Result<LoadedImage> read_of_size(const fs::path& path, Size size) {
  Result<LoadedImage> image = read_image(path);
  if (image && image->info.size != size) {
    return Error{ErrorKind::kBadData, "a map cannot be exported", path.string(),
                 fmt::format("it is {} x {} pixels, the others {} x {}", image->info.size.width,
                             image->info.size.height, size.width, size.height),
                 "make the maps again"};
  }
  return image;
}

// Planes of one file of the folder, or its numbers, into `to` from plane 0 on.
Result<void> fill(const MapFolder& folder, const std::vector<Plane>& planes, Image<float>& to) {
  const std::string file = origin_of(folder, planes.front()).file;
  Result<LoadedImage> image = LoadedImage{};
  if (!file.empty()) image = read_of_size(folder.folder / file, folder.size);
  if (!image) return std::move(image).error();
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const PlaneOrigin origin = origin_of(folder, planes[p]);
    View<const float> from;
    for (const std::string& name : origin.channels) {
      if (from.empty()) from = image->channel(name);
    }
    if (!file.empty() && from.empty()) {
      return Error{ErrorKind::kBadData, "a map cannot be exported", (folder.folder / file).string(),
                   fmt::format("it has no channel {}", exchange::kind_of(planes[p]).channel),
                   "make the maps again"};
    }
    const View<float> plane = to.plane(static_cast<int>(p));
    for (int y = 0; y < plane.height(); ++y) {
      if (from.empty()) {
        std::fill_n(plane.row(y), plane.width(), static_cast<float>(origin.constant.value_or(0)));
      } else {
        std::copy_n(from.row(y), plane.width(), plane.row(y));
      }
    }
  }
  return {};
}

Image<float> slopes_of(const Image<float>& normal, int threads) {
  Image<float> slope(normal.size(), 2);
  parallel_for(static_cast<std::size_t>(normal.height()), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < normal.width(); ++x) {
      const float z = std::max(normal(x, y, 2), kFlattest);
      for (int p = 0; p < 2; ++p) slope(x, y, p) = -normal(x, y, p) / z;
    }
  });
  return slope;
}

// status.png where the folder has one.
Result<Image<std::uint16_t>> status_of(const MapFolder& folder) {
  Image<std::uint16_t> status(folder.size);
  const fs::path path = folder.folder / "status.png";
  if (!is_there(path)) return status;
  const Result<LoadedImage> image = read_of_size(path, folder.size);
  if (!image) return image.error();
  for (int y = 0; y < status.height(); ++y) {
    const float* from = image->planes.plane(0).row(y);
    std::transform(from, from + status.width(), status.plane().row(y),
                   [](float share) { return static_cast<std::uint16_t>(std::lround(share * 65535)); });
  }
  return status;
}

Result<material::Surface> surface_of(const MapFolder& folder, int threads) {
  material::Surface surface;
  surface.is_tile = folder.is_tile;
  Image<float> normal(folder.size, 3);
  if (Result<void> ok = fill(folder, {Plane::kNormalX, Plane::kNormalY, Plane::kNormalZ}, normal); !ok)
    return std::move(ok).error();
  surface.slope = slopes_of(normal, threads);
  normal = {};
  surface.lobe = Image<float>(folder.size, 3);
  if (Result<void> ok = fill(folder, {Plane::kAlpha, Plane::kAlphaAlong, Plane::kYarnDeg}, surface.lobe); !ok)
    return std::move(ok).error();
  if (!origin_of(folder, Plane::kOpacity).file.empty()) {
    surface.opacity = Image<float>(folder.size);
    if (Result<void> ok = fill(folder, {Plane::kOpacity}, surface.opacity); !ok) return std::move(ok).error();
  }
  Result<Image<std::uint16_t>> status = status_of(folder);
  if (!status) return std::move(status).error();
  surface.status = std::move(*status);
  return surface;
}

}  // namespace

Result<LobeOnGrid> lobe_on_grid(const MapFolder& folder, Size size, int threads) {
  LobeOnGrid lobe;
  const PlaneOrigin alpha = origin_of(folder, Plane::kAlpha), along = origin_of(folder, Plane::kAlphaAlong);
  const bool has_lobe = !alpha.file.empty() || alpha.constant.has_value();
  const bool can_widen = alpha.constant.value_or(0) < 1 || along.constant.value_or(0) < 1;
  if (!has_lobe || !can_widen || origin_of(folder, Plane::kNormalX).file.empty()) return lobe;
  const Result<material::Surface> surface = surface_of(folder, threads);
  if (!surface) return surface.error();
  const bool is_own = size == folder.size;
  Result<std::vector<material::MipLevel>> levels =
      material::roughness_mips(*surface, {.base = size, .finest = is_own ? 1 : 0, .threads = threads});
  if (!levels) return std::move(levels).error();
  for (material::MipLevel& level : *levels) {
    Image<float>& to = level.level == 0 ? lobe.own : lobe.coarser.emplace_back();
    to = std::move(level.lobe);
  }
  return lobe;
}

}  // namespace weft::app
