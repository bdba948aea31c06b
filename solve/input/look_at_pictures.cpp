// SPDX-License-Identifier: Apache-2.0
#include "solve/input/look_at_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "capture/frames/picture_meaning.h"
#include "core/base/files.h"
#include "core/rig/exposure_words.h"
#include "solve/input/photo_mask.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;
using capture::PictureMeaning;
using Pictures = std::vector<PictureMeaning>;

Result<Pictures> meanings_of(const SolvePlan& plan) {
  Pictures pictures;
  for (const Shot& shot : plan.lit) {
    Result<PictureMeaning> picture = capture::meaning_of_picture(plan.session.path_of(shot));
    if (!picture) return std::move(picture).error();
    if (picture->unfit) return *std::move(picture->unfit);
    pictures.push_back(std::move(*picture));
  }
  return pictures;
}

Error differs(const PictureMeaning& picture, std::string what, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, std::move(what), picture.file.string(), std::move(why), std::move(remedy)};
}

std::string words_of(Size size) {
  return fmt::format("{} x {}", size.width, size.height);
}

// What must be alike in all of them.
Result<void> check_alike(const PictureMeaning& picture, const PictureMeaning& first, bool as_shown) {
  if (picture.is_raw != first.is_raw) {
    return differs(picture, "photographs mix raw and developed files", "all must be of one kind",
                   "export them all the same way");
  }
  if (as_shown && picture.orientation != first.orientation) {
    return differs(picture, "photographs differ in orientation",
                   fmt::format("it is to be shown {} (orientation {}), the first {} ({})",
                               orientation_words(picture.orientation), picture.orientation,
                               orientation_words(first.orientation), first.orientation),
                   "say --orientation stored if the camera was not turned, or turn the pixels themselves");
  }
  if (picture.size != first.size) {
    return differs(picture, "photographs differ in size",
                   fmt::format("{} pixels, the first has {}", words_of(picture.size), words_of(first.size)),
                   "use photographs of one camera that was not moved");
  }
  if (picture.origin != first.origin) {
    return differs(picture, "photographs differ in their data window",
                   fmt::format("its pixels begin at {}, {} of the picture, the first's at {}, {}",
                               picture.origin[0], picture.origin[1], first.origin[0], first.origin[1]),
                   "write them all with one data window");
  }
  return {};
}

// The light that an exposure gathers over that of another; nothing where one of them does not say.
std::optional<double> exposure_ratio(const PictureMeaning& picture, const PictureMeaning& first) {
  if (!(picture.exposure_us > 0) || !(first.exposure_us > 0)) return {};
  if ((picture.iso > 0) != (first.iso > 0) || (picture.f_number > 0) != (first.f_number > 0)) return {};
  double ratio = picture.exposure_us / first.exposure_us;
  if (picture.iso > 0) ratio *= picture.iso / first.iso;
  if (picture.f_number > 0) ratio *= std::pow(first.f_number / picture.f_number, 2);
  return ratio;
}

constexpr double kSameExposure = 0.01;  // of the ratio: what EXIF rounds away

// Divides by exposures that differ.
void even_out_exposures(const Pictures& pictures, SolvePlan& plan) {
  std::vector<double> ratios;
  bool differ = false;
  for (const PictureMeaning& picture : pictures) {
    const std::optional<double> ratio = exposure_ratio(picture, pictures.front());
    if (!ratio) return;
    differ = differ || std::abs(*ratio - 1) > kSameExposure;
    ratios.push_back(*ratio);
  }
  if (!differ) return;
  std::vector<DistantLight>& lights = std::get<DistantLights>(*plan.calibration.lights).lights;
  const bool are_told = std::ranges::any_of(lights, [](const DistantLight& light) {
    return light.irradiance_rgb != std::array<double, 3>{1, 1, 1};
  });
  std::map<std::string, int> times;
  for (const PictureMeaning& picture : pictures) ++times[exposure_words(picture.exposure_us)];
  std::string words;
  for (const auto& [time, count] : times)
    words += fmt::format("{}{} of {}", words.empty() ? "" : ", ", count, time);
  if (are_told) {
    plan.assumed.push_back("exposures differ (" + words +
                           "): the strengths given are taken to hold with them");
    return;
  }
  for (std::size_t k = 0; k < ratios.size(); ++k) {
    for (double& irradiance : lights[static_cast<std::size_t>(plan.lit[k].led) - 1].irradiance_rgb)
      irradiance *= ratios[k];
  }
  plan.assumed.push_back("exposures differ (" + words + "): each photograph is divided by its own");
}

// The photograph of all lamps off.
Result<void> look_at_dark(const fs::path& dark, const PictureMeaning& first, bool as_shown, SolvePlan& plan) {
  if (dark.empty()) return {};
  const Result<PictureMeaning> picture = capture::meaning_of_picture(dark);
  if (!picture) return picture.error();
  if (picture->unfit) return *picture->unfit;
  if (Result<void> ok = check_alike(*picture, first, as_shown); !ok) return ok;
  const std::optional<double> ratio = exposure_ratio(*picture, first);
  if (ratio && std::abs(*ratio - 1) > kSameExposure) {
    return differs(*picture, "dark photograph was exposed otherwise",
                   fmt::format("it gathered {:.3g} times the light of the first", *ratio),
                   "photograph it again with the exposure of the others");
  }
  const Result<std::string> digest = sha256_of_file(dark);
  if (!digest) return digest.error();
  plan.dark.emplace().file = fs::absolute(dark).string();
  plan.input.dark = *digest;
  return {};
}

// Such a photograph in the folder that nobody named: used if it is the only one and fits.
void look_for_dark(const PhotoOptions& options, const Pictures& pictures, SolvePlan& plan) {
  if (!options.dark.empty() || options.reading.ambient != 0 || plan.raw) return;
  const fs::path& first = pictures.front().file;
  const fs::path folder = options.folder.empty() ? first.parent_path() : options.folder;
  std::vector<fs::path> found = find_dark(folder);
  std::erase_if(found, [&](const fs::path& file) {
    std::error_code ignored;
    return std::ranges::any_of(
        pictures, [&](const PictureMeaning& p) { return fs::equivalent(p.file, file, ignored); });
  });
  if (found.empty()) return;
  const std::string name = found.front().filename().string();
  std::string why = "there are several";
  if (found.size() == 1) {
    const Result<void> ok = look_at_dark(found.front(), pictures.front(),
                                         options.reading.orientation == PictureOrientation::kShown, plan);
    if (ok) {
      plan.assumed.push_back("dark photograph: " + name + " lies beside them, and is taken from each");
      return;
    }
    why = ok.error().what + ", " + ok.error().why;
  }
  plan.assumed.push_back("the dark photograph " + name + " is not used: " + why);
}

// "10 photographs of 96 x 72, sRGB: ..."; files of several kinds are counted by kind.
std::string kinds_in_words(const Pictures& pictures, Transfer wanted) {
  std::map<std::string, int> kinds;
  for (const PictureMeaning& picture : pictures) {
    const std::string transfer = wanted == Transfer::kAuto || picture.is_raw
                                     ? capture::transfer_words(picture)
                                     : fmt::format("{} by --transfer", name_of(wanted));
    ++kinds[fmt::format("{}, taken as {}", picture.samples, transfer)];
  }
  std::string words = fmt::format("{} photographs of {}", pictures.size(), words_of(pictures.front().size));
  if (kinds.size() == 1) return words + ", " + kinds.begin()->first;
  for (const auto& [kind, count] : kinds) words += fmt::format("; {} of {}", count, kind);
  return words;
}

void say_what_is_assumed(const Pictures& pictures, const PhotoOptions& options, SolvePlan& plan) {
  plan.assumed.push_back(kinds_in_words(pictures, options.reading.transfer));
  const std::vector<std::string>& channels = pictures.front().channels;
  if (!plan.raw && channels.size() == 1 && channels.front() != "Y")
    plan.assumed.push_back(fmt::format("channel {} is taken as grey", channels.front()));
  const int orientation = pictures.front().orientation;
  if (plan.orientation != 1) {
    plan.assumed.push_back(fmt::format("orientation {}: {} as they are shown, and lights are taken so",
                                       orientation, orientation_words(orientation)));
  } else if (std::ranges::any_of(pictures, [](const PictureMeaning& p) { return p.orientation != 1; })) {
    plan.assumed.push_back("orientation: rows as they are stored");
  }
  std::map<std::string, int> passed_over;
  for (const PictureMeaning& picture : pictures) {
    for (const std::string& what : picture.passed_over) ++passed_over[what];
  }
  for (const auto& [what, count] : passed_over)
    plan.assumed.push_back(fmt::format("passed over in {} of them: {}", count, what));
  if (plan.raw) plan.assumed.push_back("the noise of a usual sensor, since there is no calibration");
}

}  // namespace

Result<void> look_at_pictures(const PhotoOptions& options, SolvePlan& plan) {
  Result<Pictures> pictures = meanings_of(plan);
  if (!pictures) return std::move(pictures).error();
  const PictureMeaning& first = pictures->front();
  const bool as_shown = options.reading.orientation == PictureOrientation::kShown;
  plan.raw = first.is_raw;
  plan.orientation = as_shown && !plan.raw ? first.orientation : 1;
  plan.size = shown_size(first.size, plan.orientation);
  plan.transfer =
      options.reading.transfer == Transfer::kAuto || plan.raw ? first.transfer : options.reading.transfer;
  for (const PictureMeaning& picture : *pictures) {
    if (Result<void> ok = check_alike(picture, first, as_shown); !ok) return ok;
    const Transfer transfer = options.reading.transfer == Transfer::kAuto ? picture.transfer : plan.transfer;
    if (transfer != plan.transfer) plan.transfer = Transfer::kAuto;
  }
  plan.transfer_is_custom = options.reading.transfer == Transfer::kAuto &&
                            std::ranges::all_of(*pictures, [](const PictureMeaning& p) {
                              return p.transfer_by.empty() && p.format != "jpeg";
                            });
  even_out_exposures(*pictures, plan);
  if (Result<void> ok = look_at_dark(options.dark, first, as_shown, plan); !ok) return ok;
  look_for_dark(options, *pictures, plan);
  const std::vector<DistantLight>& lights = std::get<DistantLights>(*plan.calibration.lights).lights;
  std::map<std::string, fs::path> seen;
  for (std::size_t k = 0; k < plan.lit.size(); ++k) {
    const fs::path& file = (*pictures)[k].file;
    const Result<std::string> digest = sha256_of_file(file);
    if (!digest) return digest.error();
    if (const auto [same, is_new] = seen.emplace(*digest, file); !is_new) {
      return differs((*pictures)[k], "one photograph is under two lights",
                     fmt::format("its bytes are those of {}", same->second.filename().string()),
                     "copy the photograph of this light again, or leave it out with --lights");
    }
    const DistantLight& light = lights[static_cast<std::size_t>(plan.lit[k].led) - 1];
    plan.input.photographs.push_back(
        {file.filename().string(), *digest, light.direction, light.irradiance_rgb});
    plan.lit[k].exposure_us = (*pictures)[k].exposure_us;
    plan.lit[k].iso = (*pictures)[k].iso;
  }
  plan.input.transfer = name_of(plan.transfer);
  if (plan.orientation != 1) plan.input.orientation = plan.orientation;
  if (plan.ambient != 0) plan.input.ambient = plan.ambient;
  say_what_is_assumed(*pictures, options, plan);
  return {};
}

}  // namespace weft::solve
