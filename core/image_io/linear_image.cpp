// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/linear_image.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/rig/radiometry.h"

namespace weft {
namespace {

// Inverse of the sRGB transfer function (IEC 61966-2-1).
double light_of_srgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

/// The same of a file whose values are few, each worked out once.
class LightOfCounts {
 public:
  LightOfCounts() { light_.fill(-1); }
  double operator()(float v) {
    double& light = light_[static_cast<std::size_t>(std::lround(255 * v))];
    if (light < 0) light = light_of_srgb(static_cast<double>(v));
    return light;
  }

 private:
  std::array<double, 256> light_;
};

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

Error not_light(const std::string& where, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, "not a photograph", where, std::move(why), std::move(remedy)};
}

}  // namespace

bool is_linear_image(const std::filesystem::path& file) {
  static constexpr std::array<const char*, 6> kExtensions = {".exr", ".tif", ".tiff",
                                                             ".png", ".jpg", ".jpeg"};
  const std::string extension = small_letters(file.extension().string());
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

Result<LightChannels> light_channels(const ImageFileInfo& info, const std::string& where) {
  const std::vector<std::string>& names = info.channels;
  if (!info.alike.empty()) {
    return not_light(where,
                     fmt::format("it has {} parts or pages that may be meant; {} is one that was not read",
                                 info.alike.size() + 1, info.alike.front()),
                     "write the one that is the photograph into a file of its own");
  }
  if (info.is_mosaic)
    return not_light(where, "it is a mosaic of counts behind colour filters",
                     "develop it, or give the raw file");
  const auto place = [&](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
  };
  const auto has = [&](const std::string& name) { return place(name) < names.size(); };
  const auto colors_of = [&](const std::string& layer) {
    return has(layer + "R") && has(layer + "G") && has(layer + "B");
  };
  const auto places_of = [&](const std::string& layer) -> LightChannels {
    return {place(layer + "R"), place(layer + "G"), place(layer + "B")};
  };
  const bool is_by_names = info.format == "openexr";
  if (colors_of("") && (is_by_names || names.size() <= 4)) return places_of("");
  if (is_by_names && (has("RY") || has("BY")))
    return not_light(where, "it has luminance and chroma (Y, RY, BY)", "write it as R, G and B");
  std::vector<std::string> layers;
  for (const std::string& name : names) {
    if (!name.ends_with(".R")) continue;
    const std::string layer = name.substr(0, name.size() - 1);
    if (colors_of(layer)) layers.push_back(layer);
  }
  if (layers.size() == 1) return places_of(layers.front());
  const bool is_grey = names.size() == 1 || (names.size() == 2 && has("A"));
  const bool is_direction = has("X") && has("Z");
  if (layers.empty() && has("Y") && (is_grey || (is_by_names && !is_direction)))
    return LightChannels{place("Y"), place("Y"), place("Y")};
  if (names.size() == 1 && names[0] != "Z") return LightChannels{};
  return not_light(where,
                   fmt::format("its {} channels are {}; R, G, B or one of grey were expected", names.size(),
                               fmt::join(names, ", ")),
                   "export it as RGB");
}

Size shown_size(Size stored, int orientation) {
  return orientation >= 5 ? Size{stored.height, stored.width} : stored;
}

Image<float> as_shown(Image<float> stored, int orientation) {
  if (orientation == 1) return stored;
  const bool is_across = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
  const bool is_down = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  const int right = stored.width() - 1, bottom = stored.height() - 1;
  Image<float> shown(shown_size(stored.size(), orientation), stored.planes());
  for (int p = 0; p < shown.planes(); ++p) {
    for (int y = 0; y < shown.height(); ++y) {
      for (int x = 0; x < shown.width(); ++x) {
        const int across = orientation >= 5 ? y : x, down = orientation >= 5 ? x : y;
        shown(x, y, p) = stored(is_across ? right - across : across, is_down ? bottom - down : down, p);
      }
    }
  }
  return shown;
}

const char* orientation_words(int orientation) {
  static constexpr std::array<const char*, 8> kWords = {"as they are",
                                                        "mirrored left to right",
                                                        "turned by half",
                                                        "mirrored top to bottom",
                                                        "mirrored on the falling diagonal",
                                                        "turned right by a quarter",
                                                        "mirrored on the rising diagonal",
                                                        "turned left by a quarter"};
  return kWords[static_cast<std::size_t>(orientation) - 1];
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
  const Result<LightChannels> channels = light_channels(*info, file.string());
  if (!channels) return channels.error();
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

  const Result<LightChannels> channels = light_channels(*info, file.string());
  if (!channels) return channels.error();
  const bool saturates = clipped == Clipped::kMark && is_integer(info->type);
  const bool has_few = info->type == SampleType::kUint8;
  LightOfCounts light_of_count;
  Image<float> rgb(info->size, 3);
  for (int c = 0; c < 3; ++c) {
    const View<const float> from =
        loaded->planes.plane(static_cast<int>((*channels)[static_cast<std::size_t>(c)]));
    for (int y = 0; y < rgb.height(); ++y) {
      const float* in = from.row(y);
      float* out = rgb.plane(c).row(y);
      for (int x = 0; x < rgb.width(); ++x) {
        const double light = transfer == Transfer::kLinear ? in[x]
                             : has_few                     ? light_of_count(in[x])
                                                           : light_of_srgb(in[x]);
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

void brighten(Image<float>& image, double light) {
  for (int p = 0; p < image.planes(); ++p) {
    for (int y = 0; y < image.height(); ++y) {
      float* row = image.plane(p).row(y);
      for (int x = 0; x < image.width(); ++x) row[x] += static_cast<float>(light);
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
