// SPDX-License-Identifier: Apache-2.0
#include "material/run/surface_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/base/files.h"
#include "core/base/vec.h"
#include "core/image_io/image_io.h"
#include "core/image_io/solve_maps.h"
#include "core/solve/solve_record.h"
#include "material/run/map_facts.h"
#include "solve/files/gloss_maps.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

constexpr float kNoSigma_deg = 180;

// A normal that is steeper, or turned away, counts as leaning so far.
const float kLeastUp = static_cast<float>(std::cos(radians(89.0)));

const std::vector<std::string> kNormalChannels = {"X", "Y", "Z"};
const std::vector<std::string> kColourChannels = {"R", "G", "B"};
const std::vector<std::string> kTintedChannels = {"f0", "R", "G", "B"};
const std::vector<std::string> kLobeChannels = {"roughness", "alpha", "alpha_along", "yarn_deg"};

Image<float> slopes_of(const Image<float>& normal, const Image<std::uint16_t>& status) {
  Image<float> slope(normal.size(), 2);
  for (int y = 0; y < normal.height(); ++y) {
    for (int x = 0; x < normal.width(); ++x) {
      if (status(x, y) & kNoSolution) continue;
      const float up = std::max(normal(x, y, 2), kLeastUp);
      slope(x, y, 0) = -normal(x, y, 0) / up;
      slope(x, y, 1) = -normal(x, y, 1) / up;
    }
  }
  return slope;
}

Result<void> check_finite(const Image<float>& map, const fs::path& file) {
  for (int p = 0; p < map.planes(); ++p) {
    for (int y = 0; y < map.height(); ++y) {
      const float* row = map.plane(p).row(y);
      const float* end = row + map.width();
      const float* bad = std::find_if(row, end, [](float v) { return !std::isfinite(v); });
      if (bad == end) continue;
      return Error{ErrorKind::kBadData, "map has a value that is no number", file.string(),
                   fmt::format("at column {}, row {}", bad - row, y), "rectify the solve again"};
    }
  }
  return {};
}

// Planes of a map in the order of `names`. kBadData where one is missing, or the size is another.
Result<Image<float>> read_planes(const fs::path& file, const std::vector<std::string>& names, Size size) {
  const Result<LoadedImage> image = read_image(file);
  if (!image) return image.error();
  Image<float> planes(size, static_cast<int>(names.size()));
  for (std::size_t p = 0; p < names.size(); ++p) {
    const View<const float> channel = image->channel(names[p]);
    if (channel.empty() || !(image->info.size == size)) {
      return Error{
          ErrorKind::kBadData, "map does not fit the others", file.string(),
          fmt::format("channel {} of {} x {} pixels was expected", names[p], size.width, size.height),
          "rectify the solve again"};
    }
    for (int y = 0; y < size.height; ++y)
      std::copy_n(channel.row(y), size.width, planes.plane(static_cast<int>(p)).row(y));
  }
  if (Result<void> ok = check_finite(planes, file); !ok) return std::move(ok).error();
  return planes;
}

// What roughness.exr and, where it is there, specular.exr say; nothing where no lobe was measured.
Result<void> read_lobe(const fs::path& folder, RectifiedSurface& into) {
  if (!is_there(folder / "roughness.exr")) return {};
  const Size size = into.surface.status.size();
  const Result<Image<float>> roughness = read_planes(folder / "roughness.exr", kLobeChannels, size);
  if (!roughness) return roughness.error();
  Image<float> f0(size);
  const fs::path file = folder / "specular.exr";
  into.has_f0 = is_there(file);
  if (into.has_f0) {
    const Result<ImageFileInfo> info = read_image_info(file);
    if (!info) return info.error();
    const bool is_tinted = std::ranges::find(info->channels, "R") != info->channels.end();
    Result<Image<float>> specular =
        read_planes(file, is_tinted ? kTintedChannels : std::vector<std::string>{"f0"}, size);
    if (!specular) return std::move(specular).error();
    f0 = std::move(*specular);
  }
  into.surface.lobe = Image<float>(size, 3 + f0.planes());
  for (int y = 0; y < size.height; ++y) {
    for (int p = 0; p < 3; ++p)
      std::copy_n(roughness->plane(p + 1).row(y), size.width, into.surface.lobe.plane(p).row(y));
    if (!into.has_f0) std::fill_n(f0.plane().row(y), size.width, static_cast<float>(solve::kTypedF0));
    for (int p = 0; p < f0.planes(); ++p)
      std::copy_n(f0.plane(p).row(y), size.width, into.surface.lobe.plane(3 + p).row(y));
  }
  return {};
}

// Roughness as games have it, before the planes that a surface keeps.
Image<float> roughness_of(const Image<float>& lobe) {
  Image<float> out(lobe.size(), 4);
  for (int y = 0; y < lobe.height(); ++y) {
    for (int x = 0; x < lobe.width(); ++x) {
      out(x, y, 0) = std::sqrt(std::sqrt(lobe(x, y, 0) * lobe(x, y, 1)));
      for (int p = 0; p < 3; ++p) out(x, y, p + 1) = lobe(x, y, p);
    }
  }
  return out;
}

Result<void> write_status(const fs::path& file, const Image<std::uint16_t>& status) {
  Result<ImageWriter> writer = ImageWriter::open(file, status.size(), {"Y"}, {.type = SampleType::kUint16});
  if (!writer) return std::move(writer).error();
  if (Result<void> ok = writer->write_rows(status.plane()); !ok) return ok;
  return writer->finish();
}

}  // namespace

std::vector<View<const float>> planes_of(const Image<float>& map) {
  std::vector<View<const float>> views;
  for (int p = 0; p < map.planes(); ++p) views.push_back(map.plane(p));
  return views;
}

Image<float> normals_of(const Image<float>& slope) {
  Image<float> normal(slope.size(), 3);
  for (int y = 0; y < slope.height(); ++y) {
    for (int x = 0; x < slope.width(); ++x) {
      const Vec3 n = normalized(Vec3{-slope(x, y, 0), -slope(x, y, 1), 1});
      normal(x, y, 0) = static_cast<float>(n.x);
      normal(x, y, 1) = static_cast<float>(n.y);
      normal(x, y, 2) = static_cast<float>(n.z);
    }
  }
  return normal;
}

Result<RectifiedSurface> read_surface(const fs::path& rectified, double mm_per_pixel) {
  const Result<SolveMaps> maps = SolveMaps::open(rectified);
  if (!maps) return maps.error();
  RectifiedSurface rectified_surface;
  Surface& surface = rectified_surface.surface;
  surface.mm_per_pixel = mm_per_pixel;
  Result<Image<std::uint16_t>> status = maps->status();
  if (!status) return std::move(status).error();
  surface.status = std::move(*status);
  const Size size = maps->size();
  const Result<Image<float>> normal = read_planes(rectified / "normal.exr", kNormalChannels, size);
  if (!normal) return normal.error();
  surface.slope = slopes_of(*normal, surface.status);
  Result<Image<float>> albedo = read_planes(rectified / "albedo.exr", kColourChannels, size);
  if (!albedo) return std::move(albedo).error();
  surface.albedo = std::move(*albedo);
  Result<Image<float>> sigma = read_planes(rectified / "sigma.exr", {"normal_deg"}, size);
  if (!sigma) return std::move(sigma).error();
  surface.sigma_deg = std::move(*sigma);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (surface.status(x, y) & kNoSolution) surface.sigma_deg(x, y) = kNoSigma_deg;
    }
  }
  if (Result<void> ok = read_lobe(rectified, rectified_surface); !ok) return std::move(ok).error();
  return rectified_surface;
}

Result<void> write_surface(const fs::path& folder, const RectifiedSurface& rectified,
                           Compression compression) {
  const Surface& surface = rectified.surface;
  const auto write = [&](const char* name, SampleType type, const char* unit,
                         const std::vector<View<const float>>& planes,
                         const std::vector<std::string>& channels) {
    const MapFacts facts = {.unit = unit, .source = MapSource::kMeasured};
    const double mm = rectified.is_size_known ? surface.mm_per_pixel : 0;
    const WriteOptions options = {.type = type,
                                  .compression = compression,
                                  .attributes = attributes_of(facts, mm),
                                  .pitch_mm = {mm, mm}};
    return planes.empty() ? Result<void>() : write_image(folder / name, planes, channels, options);
  };
  using enum SampleType;
  const Image<float> normal = normals_of(surface.slope);
  if (Result<void> ok = write_status(folder / "status.png", surface.status); !ok) return ok;
  if (Result<void> ok = write("normal.exr", kFloat, "", planes_of(normal), kNormalChannels); !ok) return ok;
  if (Result<void> ok = write("albedo.exr", kHalf, "share", planes_of(surface.albedo), kColourChannels); !ok)
    return ok;
  if (Result<void> ok = write("sigma.exr", kHalf, "deg", planes_of(surface.sigma_deg), {"normal_deg"}); !ok)
    return ok;
  if (Result<void> ok = write("opacity.exr", kHalf, "share", planes_of(surface.opacity), {"opacity"}); !ok)
    return ok;
  if (surface.lobe.empty()) return {};
  const Image<float> roughness = roughness_of(surface.lobe);
  if (Result<void> ok = write("roughness.exr", kHalf, "", planes_of(roughness), kLobeChannels); !ok)
    return ok;
  if (!rectified.has_f0) return {};
  std::vector<View<const float>> f0 = planes_of(surface.lobe);
  f0.erase(f0.begin(), f0.begin() + 3);
  return write("specular.exr", kHalf, "share", f0,
               f0.size() == 1 ? std::vector<std::string>{"f0"} : kTintedChannels);
}

}  // namespace weft::material
