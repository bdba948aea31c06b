// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/map_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/image_io/image_io.h"
#include "exchange/presets/reduce.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using exchange::Plane;
using exchange::SourcePlanes;

std::size_t index_of(Plane plane) {
  return static_cast<std::size_t>(plane);
}

Error unfit_map(const fs::path& file, std::string why) {
  return {ErrorKind::kBadData, "a map cannot be exported", file.string(), std::move(why),
          "make the maps again"};
}

constexpr std::array kLobePlanes = {Plane::kAlpha, Plane::kAlphaAlong, Plane::kYarnDeg};

// How a plane is averaged: what is asked for the same is reduced together.
exchange::Averaging averaging_of(Plane plane) {
  switch (plane) {
    case Plane::kNormalX:
    case Plane::kNormalY:
    case Plane::kNormalZ:
      return exchange::Averaging::kSlopes;
    case Plane::kAlpha:
    case Plane::kAlphaAlong:
      return exchange::Averaging::kSquares;
    case Plane::kYarnDeg:
      return exchange::Averaging::kNearest;
    default:
      return exchange::Averaging::kMean;
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

}  // namespace

SourcePlanes MapPlanes::outline_of(const MapFolder& folder) {
  static const float kNoValue = 0;
  const View<const float> kSomePixel(&kNoValue, {1, 1}, 1);
  SourcePlanes planes;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const PlaneOrigin origin = origin_of(folder, static_cast<Plane>(p));
    if (origin.file.empty()) {
      planes[p].constant = origin.constant;
    } else {
      planes[p].pixels = kSomePixel;
    }
  }
  return planes;
}

Result<void> MapPlanes::read(const std::string& file, const std::vector<Plane>& planes) {
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
    } else if (averaging_of(planes[i]) != exchange::Averaging::kSlopes) {
      exchange::reduce(channel, averaging_of(planes[i]), threads_, plane);
    }
    planes_[index_of(planes[i])] = {.pixels = plane};
  }
  if (size_ != folder_.size && planes.front() == Plane::kNormalX) {
    exchange::reduce_normals({image->channel("X"), image->channel("Y"), image->channel("Z")}, threads_,
                             {kept.plane(0), kept.plane(1), kept.plane(2)});
  }
  loaded_.emplace(file, std::move(kept));
  return {};
}

// Of maps that are made smaller the lobe is the one that the pixels beneath have together.
Result<void> MapPlanes::find_lobe() {
  if (!has_lobe_) {
    Result<LobeOnGrid> lobe = lobe_on_grid(folder_, size_, threads_);
    if (!lobe) return std::move(lobe).error();
    lobe_ = std::move(*lobe);
    has_lobe_ = true;
  }
  if (lobe_.own.planes() == 0 || origin_of(folder_, Plane::kAlpha).file.empty()) return {};
  for (const Plane plane : kLobePlanes)
    planes_[index_of(plane)] = {
        .pixels = lobe_.own.plane(static_cast<int>(plane) - static_cast<int>(Plane::kAlpha))};
  return {};
}

Result<void> MapPlanes::load(const std::set<Plane>& wanted) {
  std::map<std::string, std::vector<Plane>> by_file;
  std::set<std::string> needed;
  for (std::size_t p = 0; p < planes_.size(); ++p) {
    const auto plane = static_cast<Plane>(p);
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
    for (const Plane plane : planes) planes_[index_of(plane)] = {.constant = 0};
  }
  for (const std::string& file : needed) {
    if (loaded_.contains(file)) continue;
    if (Result<void> ok = read(file, by_file[file]); !ok) return ok;
  }
  const bool asks_for_lobe =
      std::ranges::any_of(kLobePlanes, [&](Plane plane) { return wanted.contains(plane); });
  return asks_for_lobe ? find_lobe() : Result<void>();
}

exchange::ChannelFacts channel_facts(const MapFolder& folder, const SourcePlanes& planes) {
  exchange::ChannelFacts facts;
  if (const FolderMap* height = folder.map("height"); height != nullptr) {
    facts.height_least_mm = height->constant.value_or(height->least);
    facts.height_most_mm = height->constant.value_or(height->most);
  }
  const auto pixels = [&](Plane plane) { return planes[index_of(plane)].pixels; };
  if (!pixels(Plane::kAlbedoR).empty())
    facts.mean_luminance =
        exchange::mean_luminance({pixels(Plane::kAlbedoR), pixels(Plane::kAlbedoG), pixels(Plane::kAlbedoB)});
  if (!pixels(Plane::kNormalX).empty())
    facts.mean_slope =
        exchange::mean_slope({pixels(Plane::kNormalX), pixels(Plane::kNormalY), pixels(Plane::kNormalZ)});
  return facts;
}

}  // namespace weft::app
