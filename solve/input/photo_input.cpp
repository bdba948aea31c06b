// SPDX-License-Identifier: Apache-2.0
#include "solve/input/photo_input.h"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "core/base/files.h"
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

Result<SolvePlan> read_photos(const PhotoOptions& options) {
  const Result<LightList> list = find_lights(options.light_file, {options.folder, options.skips_missing});
  if (!list) return list.error();
  const bool has_folder = !options.folder.empty();
  SolvePlan plan = plan_of(*list, has_folder ? options.folder : list->file.parent_path());
  if (!has_folder) return plan;
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

// What a person calls them by: the name of their folder or light file.
fs::path name_of_source(const PhotoOptions& options) {
  const fs::path source =
      fs::absolute(options.folder.empty() ? options.light_file : options.folder).lexically_normal();
  return source.has_filename() ? source.stem() : source.parent_path().filename();
}

Result<void> look_at_mask(SolvePlan& plan) {
  if (plan.mask.empty()) return {};
  if (const auto mask = read_mask(plan.mask, plan.size); !mask) return mask.error();
  const Result<std::string> digest = sha256_of_file(plan.mask);
  if (!digest) return digest.error();
  plan.input.mask = *digest;
  return {};
}

}  // namespace

Result<SolvePlan> plan_photos(const PhotoOptions& options) {
  Result<SolvePlan> plan = read_photos(options);
  if (!plan) return plan;
  plan->clipped = options.clipped;
  plan->ambient = options.ambient;
  if (Result<void> laid = lay_lights(options.flip, options.folder / options.light_file,
                                     std::get<DistantLights>(*plan->calibration.lights));
      !laid)
    return std::move(laid).error();
  if (Result<void> chosen = choose_photos(options.lights, *plan); !chosen) return std::move(chosen).error();
  if (plan->lit.size() < 3) {
    return Error{ErrorKind::kBadData, "too few lights",
                 (options.light_file.empty() ? options.folder : options.light_file).string(),
                 fmt::format("{} photographs; a normal and an albedo are three unknowns", plan->lit.size()),
                 "give at least three photographs under different lights"};
  }
  if (Result<void> looked = look_at_pictures(options, *plan); !looked) return std::move(looked).error();
  if (Result<void> looked = look_at_mask(*plan); !looked) return std::move(looked).error();
  const std::string name = name_of_source(options).string();
  plan->where = plan->session.fabric = name;
  std::error_code ignored;
  plan->solves = fs::current_path(ignored) / (name + "-solve");
  return plan;
}

}  // namespace weft::solve
