// SPDX-License-Identifier: Apache-2.0
#include "solve/input/photo_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "core/base/files.h"
#include "core/base/number.h"
#include "solve/input/photo_mask.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestQuote = 40;

Error bad_lights(const fs::path& file, std::string why) {
  return {ErrorKind::kBadData, "lights cannot be read", file.string(), std::move(why),
          "see docs/formats.md for the layout"};
}

Error bad_number(const fs::path& file, int line, std::string_view word) {
  return {ErrorKind::kBadData, "lights cannot be read", file.string(),
          fmt::format("line {} has not three numbers: {}", line, why_no_number(word)),
          "write finite numbers with a point, as in 0.5 or 5e-1; docs/formats.md has the layout"};
}

// The last three words of a line.
Result<std::array<double, 3>> triple_of(const std::vector<std::string_view>& words, const fs::path& file,
                                        int line) {
  std::array<double, 3> t = {};
  for (std::size_t i = 0; i < t.size(); ++i) {
    const std::string_view word = words[words.size() - t.size() + i];
    const std::optional<double> number = as_number(word);
    if (!number) return bad_number(file, line, word);
    t[i] = *number;
  }
  return t;
}

// Three numbers a line of a text file; empty lines are skipped.
Result<std::vector<std::array<double, 3>>> read_triples(const fs::path& file) {
  const Result<std::string> text = read_text(file);
  if (!text) return text.error();
  std::vector<std::array<double, 3>> triples;
  std::istringstream lines(*text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::vector<std::string_view> words = words_of_line(line);
    if (words.empty()) continue;
    if (words.size() != 3) return bad_lights(file, fmt::format("line {} is not three numbers", number));
    const Result<std::array<double, 3>> t = triple_of(words, file, number);
    if (!t) return t.error();
    triples.push_back(*t);
  }
  return triples;
}

// A direction as written, to unit length; its length says nothing.
Result<Vec3> direction_of(const std::array<double, 3>& t, const fs::path& file) {
  const Vec3 v = {t[0], t[1], t[2]};
  if (!(length(v) > 0) || !std::isfinite(length(v))) return bad_lights(file, "a direction has no length");
  return normalized(v);
}

// Photographs in `folder` without any yet.
SolvePlan plan_in(const fs::path& folder) {
  SolvePlan plan;
  plan.is_of_rig = plan.raw = false;
  plan.session.folder = folder;
  plan.calibration.lights = DistantLights();
  return plan;
}

// One more photograph and its light.
void add_photo(const std::string& file, const DistantLight& light, SolvePlan& plan) {
  std::vector<DistantLight>& lights = std::get<DistantLights>(*plan.calibration.lights).lights;
  lights.push_back(light);
  Shot shot;
  shot.led = static_cast<int>(lights.size());
  shot.file = file;
  plan.session.shots.push_back(std::move(shot));
}

Result<SolvePlan> read_folder(const fs::path& folder) {
  SolvePlan plan = plan_in(folder);
  const fs::path directions_file = folder / "light_directions.txt",
                 intensities_file = folder / "light_intensities.txt";
  const Result<std::string> names = read_text(folder / "filenames.txt");
  if (!names) return names.error();
  std::vector<std::string> files;
  std::istringstream lines(*names);
  for (std::string name; std::getline(lines, name);) {
    name.erase(name.find_last_not_of(" \t\r") + 1);
    if (!name.empty()) files.push_back(name);
  }
  const auto directions = read_triples(directions_file);
  if (!directions) return directions.error();
  std::vector<std::array<double, 3>> intensities(directions->size(), {1, 1, 1});
  if (is_there(intensities_file)) {
    auto read = read_triples(intensities_file);
    if (!read) return std::move(read).error();
    intensities = std::move(*read);
  }
  if (directions->size() != files.size() || intensities.size() != files.size()) {
    return bad_lights(
        folder, fmt::format("filenames.txt has {} lines, light_directions.txt {}, light_intensities.txt {}",
                            files.size(), directions->size(), intensities.size()));
  }
  for (std::size_t k = 0; k < files.size(); ++k) {
    const Result<Vec3> direction = direction_of((*directions)[k], directions_file);
    if (!direction) return direction.error();
    for (const double v : intensities[k]) {
      if (!(v > 0) || !std::isfinite(v)) {
        return bad_lights(intensities_file, fmt::format("light {} has an intensity of {}", k + 1, v));
      }
    }
    add_photo(files[k], {*direction, intensities[k]}, plan);
  }
  Result<fs::path> mask = find_mask(folder);
  if (!mask) return std::move(mask).error();
  plan.mask = std::move(*mask);
  return plan;
}

Result<SolvePlan> read_light_file(const fs::path& file) {
  const Result<std::string> text = read_text(file);
  if (!text) return text.error();
  std::istringstream lines(*text);
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string_view> first = words_of_line(line);
  const auto count = first.size() == 1 ? as_whole_number<std::size_t>(first[0]) : std::nullopt;
  if (!count) {
    return bad_lights(file, fmt::format("the first line is not the number of photographs: \"{}\"",
                                        line.substr(0, kLongestQuote)));
  }
  SolvePlan plan = plan_in(file.parent_path());
  for (int number = 2; std::getline(lines, line); ++number) {
    const std::vector<std::string_view> words = words_of_line(line);
    if (words.empty()) continue;
    if (words.size() < 4) return bad_lights(file, fmt::format("\"{}\" is not \"file x y z\"", line));
    const Result<std::array<double, 3>> t = triple_of(words, file, number);
    if (!t) return t.error();
    const Result<Vec3> direction = direction_of(*t, file);
    if (!direction) return direction.error();
    // The name may hold spaces.
    const std::string_view last = words[words.size() - 4];
    const std::string name(words.front().data(), last.data() + last.size());
    add_photo(name, {*direction, {1, 1, 1}}, plan);
    if (words.size() > 4 && as_number(last) && !is_there(plan.session.path_of(plan.session.shots.back())))
      return bad_lights(file, fmt::format("line {} has more than three numbers", number));
  }
  const std::size_t listed = plan.session.shots.size();
  if (listed != *count)
    return bad_lights(file, fmt::format("it announces {} photographs and lists {}", *count, listed));
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
      fs::absolute(options.light_file.empty() ? options.folder : options.light_file).lexically_normal();
  return source.has_filename() ? source.stem() : source.parent_path().filename();
}

// Size and transfer of all, from their headers, and what the id is made of.
Result<void> look_at_photos(Transfer wanted, SolvePlan& plan) {
  const std::vector<DistantLight>& lights = std::get<DistantLights>(*plan.calibration.lights).lights;
  for (std::size_t k = 0; k < plan.lit.size(); ++k) {
    const fs::path file = plan.session.path_of(plan.lit[k]);
    const Result<ImageFileInfo> info = read_linear_image_info(file);
    if (!info) return info.error();
    const Transfer transfer = wanted == Transfer::kAuto ? transfer_of(*info) : wanted;
    if (k == 0) {
      plan.size = info->size;
      plan.transfer = transfer;
    }
    // Each by its own kind, where they differ.
    if (transfer != plan.transfer) plan.transfer = Transfer::kAuto;
    if (info->size != plan.size) {
      return Error{ErrorKind::kBadData, "photographs differ in size", file.string(),
                   fmt::format("{} x {} pixels, the first has {} x {}", info->size.width, info->size.height,
                               plan.size.width, plan.size.height),
                   "use photographs of one camera that was not moved"};
    }
    const Result<std::string> digest = sha256_of_file(file);
    if (!digest) return digest.error();
    const DistantLight& light = lights[static_cast<std::size_t>(plan.lit[k].led) - 1];
    plan.input.photographs.push_back(
        {file.filename().string(), *digest, light.direction, light.irradiance_rgb});
  }
  plan.input.transfer = name_of(plan.transfer);
  return {};
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
  Result<SolvePlan> plan =
      options.light_file.empty() ? read_folder(options.folder) : read_light_file(options.light_file);
  if (!plan) return plan;
  plan->clipped = options.clipped;
  if (Result<void> chosen = choose_photos(options.lights, *plan); !chosen) return std::move(chosen).error();
  if (plan->lit.size() < 3) {
    return Error{ErrorKind::kBadData, "too few lights", (options.folder / options.light_file).string(),
                 fmt::format("{} photographs; a normal and an albedo are three unknowns", plan->lit.size()),
                 "give at least three photographs under different lights"};
  }
  if (Result<void> looked = look_at_photos(options.transfer, *plan); !looked)
    return std::move(looked).error();
  if (Result<void> looked = look_at_mask(*plan); !looked) return std::move(looked).error();
  const std::string name = name_of_source(options).string();
  plan->where = plan->session.fabric = name;
  std::error_code ignored;
  plan->solves = fs::current_path(ignored) / (name + "-solve");
  return plan;
}

}  // namespace weft::solve
