// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/linear_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/rig/radiometry.h"

namespace weft {
namespace {

// Inverse of the sRGB transfer function (IEC 61966-2-1).
double light_of_srgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

bool is_integer(SampleType type) {
  return type == SampleType::kUint8 || type == SampleType::kUint16;
}

// The first value of a plane that is no number, if any.
Result<void> check_finite(const Image<float>& planes, const std::filesystem::path& file) {
  for (int p = 0; p < planes.planes(); ++p) {
    for (int y = 0; y < planes.height(); ++y) {
      const float* row = planes.plane(p).row(y);
      const float* bad = std::find_if(row, row + planes.width(), [](float v) { return !std::isfinite(v); });
      if (bad == row + planes.width()) continue;
      return Error{ErrorKind::kBadData, "photograph holds values that are no numbers", file.string(),
                   fmt::format("{} at pixel ({}, {})", std::isnan(*bad) ? "NaN" : "infinity", bad - row, y),
                   "export it again without NaN and infinity"};
    }
  }
  return {};
}

}  // namespace

bool is_linear_image(const std::filesystem::path& file) {
  static constexpr std::array<const char*, 6> kExtensions = {".exr", ".tif", ".tiff",
                                                             ".png", ".jpg", ".jpeg"};
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

Transfer transfer_of(const ImageFileInfo& info) {
  switch (info.color) {
    case ColorSpace::kSrgb:
      return Transfer::kSrgb;
    case ColorSpace::kLinearColor:
      return Transfer::kLinear;
    case ColorSpace::kOther:
      return Transfer::kAuto;
    case ColorSpace::kData:
      break;
  }
  return info.type == SampleType::kUint8 ? Transfer::kSrgb : Transfer::kLinear;
}

Result<ImageFileInfo> read_linear_image_info(const std::filesystem::path& file) {
  Result<ImageFileInfo> info = read_image_info(file);
  if (!info) return info;
  if (info->channels.size() != 1 && info->channels.size() != 3 && info->channels.size() != 4) {
    return Error{
        ErrorKind::kBadData, "not a photograph", file.string(),
        fmt::format("it has {} channels; 1 (grey), 3 or 4 (RGB) were expected", info->channels.size()),
        "export it as RGB"};
  }
  return info;
}

Result<Image<float>> read_linear_image(const std::filesystem::path& file, Transfer transfer, Clipped clipped,
                                       NotNumbers not_numbers) {
  Result<ImageFileInfo> info = read_linear_image_info(file);
  if (!info) return std::move(info).error();
  if (info->format == "jpeg" && transfer == Transfer::kLinear) {
    return Error{ErrorKind::kBadData, "a JPEG is not linear", file.string(),
                 "a camera's tone curve and compression cannot be undone",
                 "use raw, TIFF, PNG or EXR frames"};
  }
  if (transfer == Transfer::kAuto) transfer = transfer_of(*info);
  if (transfer == Transfer::kAuto) {
    return Error{ErrorKind::kBadData, "the photograph's light is not known", file.string(),
                 "it says that it went through a curve that is neither that of sRGB nor none",
                 "export it without a curve, or say --transfer"};
  }
  Result<LoadedImage> loaded = read_image(file);
  if (!loaded) return std::move(loaded).error();
  if (not_numbers == NotNumbers::kRefuse) {
    if (Result<void> ok = check_finite(loaded->planes, file); !ok) return std::move(ok).error();
  }

  const bool grey = info->channels.size() == 1;
  const bool saturates = clipped == Clipped::kMark && is_integer(info->type);
  Image<float> rgb(info->size, 3);
  for (int c = 0; c < 3; ++c) {
    const View<const float> from = loaded->planes.plane(grey ? 0 : c);
    for (int y = 0; y < rgb.height(); ++y) {
      const float* in = from.row(y);
      float* out = rgb.plane(c).row(y);
      for (int x = 0; x < rgb.width(); ++x) {
        const double light = transfer == Transfer::kSrgb ? light_of_srgb(in[x]) : in[x];
        const bool full = saturates && in[x] >= static_cast<float>(kSaturatedFrom);
        out[x] = full ? std::numeric_limits<float>::infinity() : static_cast<float>(light);
      }
    }
  }
  return rgb;
}

void subtract(Image<float>& image, const Image<float>& dark) {
  for (int p = 0; p < image.planes(); ++p) {
    for (int y = 0; y < image.height(); ++y) {
      float* row = image.plane(p).row(y);
      const float* less = dark.plane(p).row(y);
      for (int x = 0; x < image.width(); ++x) row[x] -= less[x];
    }
  }
}

void scale(Image<float>& image, double factor) {
  for (int p = 0; p < image.planes(); ++p) {
    for (int y = 0; y < image.height(); ++y) {
      float* row = image.plane(p).row(y);
      for (int x = 0; x < image.width(); ++x) row[x] *= static_cast<float>(factor);
    }
  }
}

}  // namespace weft
