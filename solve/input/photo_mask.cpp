// SPDX-License-Identifier: Apache-2.0
#include "solve/input/photo_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/percent.h"
#include "core/base/text.h"
#include "core/image_io/image_io.h"
#include "core/image_io/linear_image.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

Error unfit_mask(const fs::path& file, std::string what, std::string why) {
  return {ErrorKind::kBadData, std::move(what), file.string(), std::move(why),
          "paint white where cloth is and black elsewhere, or take the mask away"};
}

struct Range {
  float least = 0, most = 0;
  bool is_constant() const { return least == most; }
};
Range range_of(View<const float> plane) {
  Range range = {plane(0, 0), plane(0, 0)};
  for (int y = 0; y < plane.height(); ++y) {
    const auto [least, most] = std::minmax_element(plane.row(y), plane.row(y) + plane.width());
    range = {std::min(range.least, *least), std::max(range.most, *most)};
  }
  return range;
}

// The brightest of the colours of each pixel.
Image<float> brightest_of(const LoadedImage& mask) {
  Image<float> brightest(mask.info.size);
  for (int p = 0; p < mask.planes.planes(); ++p) {
    if (mask.info.channels[static_cast<std::size_t>(p)] == "A") continue;
    for (int y = 0; y < brightest.height(); ++y) {
      for (int x = 0; x < brightest.width(); ++x)
        brightest(x, y) = std::max(brightest(x, y), mask.planes(x, y, p));
    }
  }
  return brightest;
}

// Whether the largest count of an integer file is 1.
bool is_count_of_one(float most, SampleType type) {
  const float full = type == SampleType::kUint8 ? 255.0F : type == SampleType::kUint16 ? 65535.0F : 0;
  return std::lround(full * most) == 1;
}

// Whether a picture's name is the word, or ends with it behind a mark.
bool is_named(const fs::path& file, std::string_view word) {
  const std::string stem = small_letters(file.stem().string());
  if (!is_linear_image(file) || !stem.ends_with(word)) return false;
  return stem == word ||
         std::string_view("._-").find(stem[stem.size() - word.size() - 1]) != std::string_view::npos;
}

std::vector<fs::path> found_in(const fs::path& folder, bool (*is_one)(const fs::path&)) {
  std::vector<fs::path> found;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
    if (is_one(entry->path())) found.push_back(entry->path());
  }
  std::ranges::sort(found);
  return found;
}

}  // namespace

bool is_mask_name(const fs::path& file) {
  return is_named(file, "mask");
}

bool is_dark_name(const fs::path& file) {
  return is_named(file, "dark") || is_named(file, "ambient");
}

std::vector<fs::path> find_dark(const fs::path& folder) {
  return found_in(folder, is_dark_name);
}

Result<fs::path> find_mask(const fs::path& folder) {
  const std::vector<fs::path> found = found_in(folder, is_mask_name);
  if (found.empty()) return fs::path();
  if (found.size() == 1) return found.front();
  return Error{ErrorKind::kBadData, "there are several masks", folder.string(),
               fmt::format("{} and {}", found[0].filename().string(), found[1].filename().string()),
               "leave the one that is right"};
}

Result<Image<std::uint8_t>> read_mask(const fs::path& file, Size size, int orientation) {
  Result<LoadedImage> mask = read_image(file);
  if (!mask) return std::move(mask).error();
  mask->planes = as_shown(std::move(mask->planes), orientation);
  mask->info.size = mask->planes.size();
  if (mask->info.size != size) {
    return Error{ErrorKind::kBadData, "mask differs in size", file.string(),
                 fmt::format("{} x {} pixels, the photographs have {} x {}", mask->info.size.width,
                             mask->info.size.height, size.width, size.height),
                 "make the mask again from one of the photographs"};
  }
  const Image<float> color = brightest_of(*mask);
  const View<const float> alpha = mask->channel("A");
  const Range colors = range_of(color.plane());
  const bool alpha_tells = !alpha.empty() && !range_of(alpha).is_constant();
  const bool color_tells = !(alpha_tells && colors.is_constant());
  const bool is_of_one = is_count_of_one(colors.most, mask->info.type);
  if (color_tells && colors.most <= 0.5F && colors.most > 0 && !is_of_one) {
    return unfit_mask(file, "mask says nothing",
                      fmt::format("its brightest pixel has {} percent of white, and from 50 on it is cloth",
                                  percent_words(static_cast<double>(colors.most))));
  }
  const float from = is_of_one ? 0 : 0.5F;
  Image<std::uint8_t> inside(size);
  bool any = false;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const bool is_cloth = (!color_tells || color(x, y) > from) && (!alpha_tells || alpha(x, y) > 0.5F);
      inside(x, y) = is_cloth ? 1 : 0;
      any = any || is_cloth;
    }
  }
  if (!any) return unfit_mask(file, "mask leaves no cloth", "no pixel of it is white");
  return inside;
}

}  // namespace weft::solve
