// SPDX-License-Identifier: Apache-2.0
#include "solve/input/photo_input.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "capture/frames/picture_meaning.h"
#include "core/base/files.h"
#include "solve/input/light_axes.h"
#include "solve/input/light_list.h"
#include "solve/input/look_at_pictures.h"
#include "solve/input/photo_mask.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

// The photographs of a list and their lights; relative to `folder` where they lie in it.
SolvePlan plan_of(const LightList& list, const fs::path& folder) {
  SolvePlan plan;
  plan.is_of_rig = plan.raw = false;
  plan.session.folder = folder;
  const fs::path base = fs::absolute(folder.empty() ? "." : folder).lexically_normal();
  DistantLights lights;
  for (const ListedLight& light : list.lights) {
    lights.lights.push_back({light.direction(), light.strength_rgb});
    Shot shot;
    shot.led = static_cast<int>(lights.lights.size());
    const fs::path whole = fs::absolute(light.photograph).lexically_normal(),
                   file = whole.lexically_relative(base);
    shot.file = file.empty() || *file.begin() == ".." ? whole.string() : file.string();
    plan.session.shots.push_back(std::move(shot));
  }
  plan.calibration.lights = std::move(lights);
  plan.assumed = list.assumed;
  return plan;
}

Result<SolvePlan> read_photos(const PhotoOptions& options, const LightList& list) {
  const bool has_folder = !options.folder.empty();
  SolvePlan plan = plan_of(list, has_folder ? options.folder : list.file.parent_path());
  plan.mask = options.mask;
  if (!has_folder || !plan.mask.empty()) return plan;
  Result<fs::path> mask = find_mask(options.folder);
  if (!mask) return std::move(mask).error();
  plan.mask = std::move(*mask);
  return plan;
}

// The shots of these numbers, or all of them.
Result<void> choose_photos(const std::vector<int>& numbers, SolvePlan& plan) {
  std::vector<Shot>& all = plan.session.shots;
  if (numbers.empty()) {
    plan.lit = all;
    return {};
  }
  if (Result<Lights> lights = select_lights(*plan.calibration.lights, numbers); !lights)
    return std::move(lights).error();
  for (const int number : numbers) plan.lit.push_back(all[static_cast<std::size_t>(number) - 1]);
  return {};
}

// Lamps at their places over the middle of the picture, which shine alike to all sides. A white surface there
// that faces one reads what its strength says, as under a light far away.
void stand_near(const PhotoOptions& options, const LightList& list, SolvePlan& plan) {
  constexpr double kFarAway_mm = 1e5;
  constexpr double kDegree = std::numbers::pi / 180;
  NearLights near;
  const DistantLights& distant = std::get<DistantLights>(*plan.calibration.lights);
  for (std::size_t k = 0; k < distant.lights.size(); ++k) {
    const double distance_mm = length(list.lights[k].toward);
    NearLight& led = near.leds.emplace_back();
    led.position_mm = distance_mm * distant.lights[k].direction;
    led.aim = -1.0 * distant.lights[k].direction;
    led.mu = 0;
    for (std::size_t c = 0; c < 3; ++c)
      led.flux_rgb[c] = distant.lights[k].irradiance_rgb[c] * distance_mm * distance_mm;
  }
  const double mm_per_pixel = *options.reading.mm_per_pixel, width_mm = plan.size.width * mm_per_pixel;
  const double distance_mm = options.reading.fov_deg
                                 ? width_mm / (2 * std::tan(*options.reading.fov_deg * kDegree / 2))
                                 : kFarAway_mm;
  plan.calibration.camera = overhead_camera(plan.size, distance_mm, mm_per_pixel);
  plan.calibration.lights = std::move(near);
  plan.input.mm_per_pixel = options.reading.mm_per_pixel;
  plan.input.fov_deg = options.reading.fov_deg;
  for (std::size_t k = 0; k < plan.lit.size(); ++k)
    plan.input.photographs[k].distance_mm =
        length(list.lights[static_cast<std::size_t>(plan.lit[k].led) - 1].toward);
  plan.assumed.push_back(
      fmt::format("near lights, in mm over the middle of the picture, of {:g} mm a pixel{}", mm_per_pixel,
                  options.reading.fov_deg ? "" : ", seen from far away"));
}

// What a person calls them by: the name of their folder or light file.
fs::path name_of_source(const PhotoOptions& options) {
  const fs::path source =
      fs::absolute(options.folder.empty() ? options.light_file : options.folder).lexically_normal();
  return source.has_filename() ? source.stem() : source.parent_path().filename();
}

Result<void> look_at_mask(PictureOrientation orientation, SolvePlan& plan) {
  if (plan.mask.empty()) return {};
  const Result<capture::PictureMeaning> picture = capture::meaning_of_picture(plan.mask);
  if (!picture) return picture.error();
  if (orientation == PictureOrientation::kShown) plan.mask_orientation = picture->orientation;
  const auto mask = read_mask(plan.mask, plan.size, plan.mask_orientation);
  if (!mask) return mask.error();
  const Result<std::string> digest = sha256_of_file(plan.mask);
  if (!digest) return digest.error();
  plan.input.mask = *digest;
  return {};
}

}  // namespace

Result<SolvePlan> plan_photos(const PhotoOptions& options) {
  const Result<LightList> list = find_lights(options.light_file, {options.folder, options.skips_missing});
  if (!list) return list.error();
  Result<SolvePlan> plan = read_photos(options, *list);
  if (!plan) return plan;
  plan->clipped = options.clipped;
  plan->ambient = options.reading.ambient;
  if (Result<void> laid = lay_lights(options.reading.flip, options.folder / options.light_file,
                                     std::get<DistantLights>(*plan->calibration.lights));
      !laid)
    return std::move(laid).error();
  if (options.reading.flip != LightFlip::kNone) plan->input.flip = name_of(options.reading.flip);
  if (Result<void> chosen = choose_photos(options.lights, *plan); !chosen) return std::move(chosen).error();
  if (plan->lit.size() < 3) {
    return Error{ErrorKind::kBadData, "too few lights",
                 (options.light_file.empty() ? options.folder : options.light_file).string(),
                 fmt::format("{} photographs; a normal and an albedo are three unknowns", plan->lit.size()),
                 "give at least three photographs under different lights"};
  }
  if (Result<void> looked = look_at_pictures(options, *plan); !looked) return std::move(looked).error();
  if (Result<void> looked = look_at_mask(options.reading.orientation, *plan); !looked)
    return std::move(looked).error();
  if (list->are_positions && options.reading.mm_per_pixel) stand_near(options, *list, *plan);
  const std::string name = name_of_source(options).string();
  plan->where = plan->session.fabric = name;
  std::error_code ignored;
  plan->solves = fs::current_path(ignored) / (name + "-solve");
  return plan;
}

}  // namespace weft::solve
