// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/map_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/image_io/image_io.h"
#include "exchange/presets/reduce.h"
#include "material/filtering/roughness_mips.h"

namespace weft::exchange {
namespace {

namespace fs = std::filesystem;

std::size_t index_of(MapPlane plane) {
  return static_cast<std::size_t>(plane);
}

Error unfit_map(const fs::path& file, std::string why) {
  return {ErrorKind::kBadData, "a map cannot be exported", file.string(), std::move(why),
          "make the maps again"};
}

constexpr std::array kLobePlanes = {MapPlane::kAlpha, MapPlane::kAlphaAlong, MapPlane::kYarnDeg};

// How a plane is averaged: what is asked for the same is reduced together.
Averaging averaging_of(MapPlane plane) {
  switch (plane) {
    case MapPlane::kNormalX:
    case MapPlane::kNormalY:
    case MapPlane::kNormalZ:
      return Averaging::kSlopes;
    case MapPlane::kAlpha:
    case MapPlane::kAlphaAlong:
      return Averaging::kSquares;
    case MapPlane::kYarnDeg:
      return Averaging::kNearest;
    default:
      return Averaging::kMean;
  }
}

Result<void> check_finite(View<const float> plane, const fs::path& file, const std::string& channel) {
  for (int y = 0; y < plane.height(); ++y) {
    const float* row = plane.row(y);
    for (int x = 0; x < plane.width(); ++x) {
      if (!std::isfinite(row[x]))
        return unfit_map(file, fmt::format("{} of pixel {}, {} is no finite number", channel, x, y));
    }
  }
  return {};
}

// The first of these channels that the file has.
View<const float> channel_of(const LoadedImage& image, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (const View<const float> found = image.channel(name); !found.empty()) return found;
  }
  return {};
}

void copy_plane(View<const float> from, View<float> to) {
  for (int y = 0; y < from.height(); ++y) std::copy_n(from.row(y), from.width(), to.row(y));
}

constexpr float kFlattest = 0.001F;  // a z that is lower counts as this

Result<LoadedImage> read_of_size(const fs::path& path, Size size) {
  Result<LoadedImage> image = read_image(path);
  if (image && image->info.size != size) {
    return unfit_map(path, fmt::format("it is {} x {} pixels, the others {} x {}", image->info.size.width,
                                       image->info.size.height, size.width, size.height));
  }
  return image;
}

// Planes of one file of the folder, or its numbers, into `to` from plane 0 on.
Result<void> fill(const MapFolder& folder, const std::vector<MapPlane>& planes, Image<float>& to) {
  const std::string file = origin_of(folder, planes.front()).file;
  Result<LoadedImage> image = LoadedImage{};
  if (!file.empty()) image = read_of_size(folder.folder / file, folder.size);
  if (!image) return std::move(image).error();
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const PlaneOrigin origin = origin_of(folder, planes[p]);
    const View<const float> from = channel_of(*image, origin.channels);
    if (!file.empty() && from.empty())
      return unfit_map(folder.folder / file, fmt::format("it has no channel {}", kind_of(planes[p]).channel));
    const View<float> plane = to.plane(static_cast<int>(p));
    if (!from.empty()) {
      copy_plane(from, plane);
      continue;
    }
    for (int y = 0; y < plane.height(); ++y)
      std::fill_n(plane.row(y), plane.width(), static_cast<float>(origin.constant.value_or(0)));
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
  if (Result<void> ok = fill(folder, {MapPlane::kNormalX, MapPlane::kNormalY, MapPlane::kNormalZ}, normal);
      !ok)
    return std::move(ok).error();
  surface.slope = slopes_of(normal, threads);
  normal = {};
  surface.lobe = Image<float>(folder.size, 3);
  if (Result<void> ok =
          fill(folder, {MapPlane::kAlpha, MapPlane::kAlphaAlong, MapPlane::kYarnDeg}, surface.lobe);
      !ok)
    return std::move(ok).error();
  if (!origin_of(folder, MapPlane::kOpacity).file.empty()) {
    surface.opacity = Image<float>(folder.size);
    if (Result<void> ok = fill(folder, {MapPlane::kOpacity}, surface.opacity); !ok)
      return std::move(ok).error();
  }
  Result<Image<std::uint16_t>> status = status_of(folder);
  if (!status) return std::move(status).error();
  surface.status = std::move(*status);
  return surface;
}

// `size` is at most the folder's. Nothing where there are no normals, or no roughness that can be wider.
Result<LobeOnGrid> lobe_on_grid(const MapFolder& folder, Size size, int threads) {
  LobeOnGrid lobe;
  const PlaneOrigin alpha = origin_of(folder, MapPlane::kAlpha),
                    along = origin_of(folder, MapPlane::kAlphaAlong);
  const bool has_lobe = !alpha.file.empty() || alpha.constant.has_value();
  const bool can_widen = alpha.constant.value_or(0) < 1 || along.constant.value_or(0) < 1;
  if (!has_lobe || !can_widen || origin_of(folder, MapPlane::kNormalX).file.empty()) return lobe;
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

}  // namespace

SourcePlanes MapPlanes::outline_of(const MapFolder& folder) {
  static const float kNoValue = 0;
  const View<const float> kSomePixel(&kNoValue, {1, 1}, 1);
  SourcePlanes planes;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const PlaneOrigin origin = origin_of(folder, static_cast<MapPlane>(p));
    if (origin.file.empty()) {
      planes[p].constant = origin.constant;
    } else {
      planes[p].pixels = kSomePixel;
    }
  }
  return planes;
}

Result<void> MapPlanes::read(const std::string& file, const std::vector<MapPlane>& planes) {
  const fs::path path = folder_.folder / file;
  const Result<LoadedImage> image = read_image(path);
  if (!image) return image.error();
  if (image->info.size != folder_.size) {
    return unfit_map(path, fmt::format("it is {} x {} pixels, {} says {} x {}", image->info.size.width,
                                       image->info.size.height, folder_.document_file, folder_.size.width,
                                       folder_.size.height));
  }
  Image<float> kept(size_, static_cast<int>(planes.size()));
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const std::vector<std::string> names = origin_of(folder_, planes[i]).channels;
    const View<const float> channel = channel_of(*image, names);
    if (channel.empty()) return unfit_map(path, fmt::format("it has no channel {}", names.front()));
    if (Result<void> ok = check_finite(channel, path, names.front()); !ok) return ok;
    const View<float> plane = kept.plane(static_cast<int>(i));
    if (size_ == folder_.size) {
      copy_plane(channel, plane);
    } else if (averaging_of(planes[i]) != Averaging::kSlopes) {
      reduce(channel, averaging_of(planes[i]), threads_, plane);
    }
    planes_[index_of(planes[i])] = {.pixels = plane};
  }
  if (size_ != folder_.size && planes.front() == MapPlane::kNormalX) {
    reduce_normals({image->channel("X"), image->channel("Y"), image->channel("Z")}, threads_,
                   {kept.plane(0), kept.plane(1), kept.plane(2)});
  }
  loaded_.emplace(file, std::move(kept));
  return {};
}

// The lobe of maps that are made smaller is the one that the pixels beneath have together.
Result<void> MapPlanes::find_lobe() {
  if (!has_lobe_) {
    Result<LobeOnGrid> lobe = lobe_on_grid(folder_, size_, threads_);
    if (!lobe) return std::move(lobe).error();
    lobe_ = std::move(*lobe);
    has_lobe_ = true;
  }
  if (lobe_.own.planes() == 0 || origin_of(folder_, MapPlane::kAlpha).file.empty()) return {};
  for (const MapPlane plane : kLobePlanes)
    planes_[index_of(plane)] = {
        .pixels = lobe_.own.plane(static_cast<int>(plane) - static_cast<int>(MapPlane::kAlpha))};
  return {};
}

Result<void> MapPlanes::load(const std::set<MapPlane>& wanted) {
  std::map<std::string, std::vector<MapPlane>> by_file;
  std::set<std::string> needed;
  for (std::size_t p = 0; p < planes_.size(); ++p) {
    const auto plane = static_cast<MapPlane>(p);
    const PlaneOrigin origin = origin_of(folder_, plane);
    if (origin.file.empty()) {
      planes_[p] = {.constant = origin.constant};
      continue;
    }
    by_file[origin.file].push_back(plane);
    if (wanted.contains(plane)) needed.insert(origin.file);
  }
  for (const auto& [file, planes] : by_file) {
    if (needed.contains(file)) continue;
    loaded_.erase(file);
    for (const MapPlane plane : planes) planes_[index_of(plane)] = {.constant = 0};
  }
  for (const std::string& file : needed) {
    if (loaded_.contains(file)) continue;
    if (Result<void> ok = read(file, by_file[file]); !ok) return ok;
  }
  const bool asks_for_lobe =
      std::ranges::any_of(kLobePlanes, [&](MapPlane plane) { return wanted.contains(plane); });
  return asks_for_lobe ? find_lobe() : Result<void>();
}

ChannelFacts channel_facts(const MapFolder& folder, const SourcePlanes& planes) {
  ChannelFacts facts;
  if (const material::MapFacts* height = folder.map("height"); height != nullptr) {
    facts.height_least_mm = height->constant.value_or(height->least);
    facts.height_most_mm = height->constant.value_or(height->most);
  }
  const auto pixels = [&](MapPlane plane) { return planes[index_of(plane)].pixels; };
  if (!pixels(MapPlane::kAlbedoR).empty())
    facts.mean_luminance =
        mean_luminance({pixels(MapPlane::kAlbedoR), pixels(MapPlane::kAlbedoG), pixels(MapPlane::kAlbedoB)});
  if (!pixels(MapPlane::kNormalX).empty())
    facts.mean_slope =
        mean_slope({pixels(MapPlane::kNormalX), pixels(MapPlane::kNormalY), pixels(MapPlane::kNormalZ)});
  return facts;
}

}  // namespace weft::exchange
