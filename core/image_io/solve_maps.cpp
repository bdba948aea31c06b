// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/solve_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace weft {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRemedy = "solve the session again";

struct Map {
  const char* file;
  std::vector<std::string> channels;   // that it has
  std::vector<std::string> more = {};  // that it may have
};

const Map kStatus = {"status.png", {"Y"}};
const Map kNormal = {"normal.exr", {"X", "Y", "Z"}};
const Map kAlbedo = {"albedo.exr", {"R", "G", "B"}};
const Map kSigma = {
    "sigma.exr",
    {"R", "G", "B", "normal_deg"},
    {"R.noise", "G.noise", "B.noise", "normal_deg.noise", "R.model", "G.model", "B.model", "normal_deg.model",
     "R.calibration", "G.calibration", "B.calibration", "normal_deg.calibration"}};

Result<void> check(const Map& map, const ImageFileInfo& info, const fs::path& file, Size size) {
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  const bool has_all =
      std::ranges::all_of(map.channels, [&](const std::string& name) { return has(info.channels, name); });
  const bool knows_all = std::ranges::all_of(
      info.channels, [&](const std::string& name) { return has(map.channels, name) || has(map.more, name); });
  if (!has_all || !knows_all) {
    return Error{ErrorKind::kBadData, "map has other channels than a solve writes", file.string(),
                 fmt::format("it has {}; {} were expected", fmt::join(info.channels, ", "),
                             fmt::join(map.channels, ", ")),
                 kRemedy};
  }
  if (info.size == size) return {};
  return Error{ErrorKind::kBadData, "maps of a solve differ in size", file.string(),
               fmt::format("it has {} x {} pixels, {} {} x {}", info.size.width, info.size.height,
                           kStatus.file, size.width, size.height),
               kRemedy};
}

Result<LoadedImage> read(const Map& map, const fs::path& folder, Size size) {
  Result<LoadedImage> image = read_image(folder / map.file);
  if (!image) return image;
  if (Result<void> ok = check(map, image->info, folder / map.file, size); !ok) return std::move(ok).error();
  return image;
}

}  // namespace

Result<SolveMaps> SolveMaps::open(const fs::path& folder) {
  const Result<ImageFileInfo> status = read_image_info(folder / kStatus.file);
  if (!status) return status.error();
  for (const Map* map : {&kStatus, &kNormal, &kAlbedo, &kSigma}) {
    const fs::path file = folder / map->file;
    const Result<ImageFileInfo> info = read_image_info(file);
    if (!info) return info.error();
    if (Result<void> ok = check(*map, *info, file, status->size); !ok) return std::move(ok).error();
  }
  return SolveMaps(folder, status->size);
}

Result<Image<std::uint16_t>> SolveMaps::status() const {
  const Result<LoadedImage> image = read(kStatus, folder_, size_);
  if (!image) return image.error();
  Image<std::uint16_t> status(size_);
  for (int y = 0; y < size_.height; ++y) {
    for (int x = 0; x < size_.width; ++x)
      status(x, y) = static_cast<std::uint16_t>(std::lround(65535 * image->planes(x, y)));
  }
  return status;
}

Result<LoadedImage> SolveMaps::normal() const {
  return read(kNormal, folder_, size_);
}

Result<LoadedImage> SolveMaps::albedo() const {
  return read(kAlbedo, folder_, size_);
}

Result<LoadedImage> SolveMaps::sigma() const {
  return read(kSigma, folder_, size_);
}

}  // namespace weft
