// SPDX-License-Identifier: Apache-2.0
#include "solve/input/photo_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "core/base/files.h"
#include "core/base/number.h"
#include "solve/input/photo_mask.h"
#include "solve/photographs/plane_weights.h"

namespace weft::app {
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

Result<PhotoPlan> read_folder(const fs::path& folder) {
  PhotoPlan plan;
  const fs::path directions_file = folder / "light_directions.txt",
                 intensities_file = folder / "light_intensities.txt";
  const Result<std::string> names = read_text(folder / "filenames.txt");
  if (!names) return names.error();
  std::istringstream lines(*names);
  for (std::string name; std::getline(lines, name);) {
    name.erase(name.find_last_not_of(" \t\r") + 1);
    if (!name.empty()) plan.files.push_back(folder / name);
  }
  const auto directions = read_triples(directions_file);
  if (!directions) return directions.error();
  std::vector<std::array<double, 3>> intensities(directions->size(), {1, 1, 1});
  if (is_there(intensities_file)) {
    auto read = read_triples(intensities_file);
    if (!read) return std::move(read).error();
    intensities = std::move(*read);
  }
  if (directions->size() != plan.files.size() || intensities.size() != plan.files.size()) {
    return bad_lights(
        folder, fmt::format("filenames.txt has {} lines, light_directions.txt {}, light_intensities.txt {}",
                            plan.files.size(), directions->size(), intensities.size()));
  }
  for (std::size_t k = 0; k < plan.files.size(); ++k) {
    const Result<Vec3> direction = direction_of((*directions)[k], directions_file);
    if (!direction) return direction.error();
    for (const double v : intensities[k]) {
      if (!(v > 0) || !std::isfinite(v)) {
        return bad_lights(intensities_file, fmt::format("light {} has an intensity of {}", k + 1, v));
      }
    }
    plan.lights.lights.push_back({*direction, intensities[k]});
  }
  Result<fs::path> mask = find_mask(folder);
  if (!mask) return std::move(mask).error();
  plan.mask = std::move(*mask);
  return plan;
}

Result<PhotoPlan> read_light_file(const fs::path& file) {
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
  PhotoPlan plan;
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
    plan.files.push_back(file.parent_path() / name);
    if (words.size() > 4 && as_number(last) && !is_there(plan.files.back()))
      return bad_lights(file, fmt::format("line {} has more than three numbers", number));
    plan.lights.lights.push_back({*direction, {1, 1, 1}});
  }
  if (plan.files.size() != *count) {
    return bad_lights(file,
                      fmt::format("it announces {} photographs and lists {}", *count, plan.files.size()));
  }
  return plan;
}

Result<void> keep_lights(PhotoPlan& plan, const std::vector<int>& numbers) {
  if (numbers.empty()) return {};
  Result<Lights> lights = select_lights(Lights(plan.lights), numbers);
  if (!lights) return std::move(lights).error();
  std::vector<fs::path> files;
  for (const int number : numbers) files.push_back(plan.files[static_cast<std::size_t>(number) - 1]);
  plan.lights = std::get<DistantLights>(std::move(*lights));
  plan.files = std::move(files);
  return {};
}

}  // namespace

Result<PhotoPlan> plan_photos(const PhotoOptions& options) {
  Result<PhotoPlan> read =
      options.light_file.empty() ? read_folder(options.folder) : read_light_file(options.light_file);
  if (!read) return read;
  PhotoPlan plan = std::move(*read);
  plan.clipped = options.clipped;
  if (Result<void> kept = keep_lights(plan, options.lights); !kept) return std::move(kept).error();
  if (plan.files.size() < 3) {
    return Error{ErrorKind::kBadData, "too few lights", (options.folder / options.light_file).string(),
                 fmt::format("{} photographs; a normal and an albedo are three unknowns", plan.files.size()),
                 "give at least three photographs under different lights"};
  }
  for (std::size_t k = 0; k < plan.files.size(); ++k) {
    const Result<ImageFileInfo> info = read_linear_image_info(plan.files[k]);
    if (!info) return info.error();
    const Transfer transfer = options.transfer == Transfer::kAuto ? transfer_of(*info) : options.transfer;
    if (k == 0) {
      plan.size = info->size;
      plan.transfer = transfer;
    }
    // Each by its own kind, where they differ.
    if (transfer != plan.transfer) plan.transfer = Transfer::kAuto;
    if (info->size != plan.size) {
      return Error{ErrorKind::kBadData, "photographs differ in size", plan.files[k].string(),
                   fmt::format("{} x {} pixels, the first has {} x {}", info->size.width, info->size.height,
                               plan.size.width, plan.size.height),
                   "use photographs of one camera that was not moved"};
    }
    const Result<std::string> digest = sha256_of_file(plan.files[k]);
    if (!digest) return digest.error();
    const DistantLight& light = plan.lights.lights[k];
    plan.input.photographs.push_back(
        {plan.files[k].filename().string(), *digest, light.direction, light.irradiance_rgb});
  }
  plan.input.transfer = name_of(plan.transfer);
  if (!plan.mask.empty()) {
    if (const auto mask = read_mask(plan.mask, plan.size); !mask) return mask.error();
    const Result<std::string> digest = sha256_of_file(plan.mask);
    if (!digest) return digest.error();
    plan.input.mask = *digest;
  }
  return plan;
}

Result<pipeline::Photographs> load_photos(const PhotoPlan& plan, const JobContext& context) {
  const std::uint64_t needed = static_cast<std::uint64_t>(plan.size.pixels()) * 12 * (plan.files.size() + 4);
  const std::uint64_t free = available_memory_bytes();
  if (free != 0 && needed > free) {
    return Error{ErrorKind::kTryAgain, "not enough memory", plan.files.front().string(),
                 fmt::format("{} MB are needed, {} MB are free", needed >> 20, free >> 20),
                 "use fewer or smaller photographs, or a larger machine"};
  }
  pipeline::Photographs photographs;
  photographs.size = plan.size;
  Result<LightField> field = LightField::make(Lights(plan.lights), std::nullopt, plan.size, 0);
  if (!field) return std::move(field).error();
  photographs.field = std::move(*field);

  std::optional<Image<std::uint8_t>> mask;
  if (!plan.mask.empty()) {
    Result<Image<std::uint8_t>> read = read_mask(plan.mask, plan.size);
    if (!read) return std::move(read).error();
    mask = std::move(*read);
  }
  std::vector<Image<float>> rgb(plan.files.size());
  const auto read_photo = [&](std::size_t k) -> Result<void> {
    Result<Image<float>> image = read_linear_image(plan.files[k], plan.transfer, plan.clipped);
    if (!image) return std::move(image).error();
    if (mask) {
      for (int y = 0; y < plan.size.height; ++y) {
        for (int x = 0; x < plan.size.width; ++x) {
          if ((*mask)(x, y) != 0) continue;
          for (int c = 0; c < 3; ++c) (*image)(x, y, c) = std::numeric_limits<float>::quiet_NaN();
        }
      }
    }
    rgb[k] = std::move(*image);
    return {};
  };
  if (Result<void> read = for_each_frame(plan.files.size(), context, read_photo); !read) {
    return std::move(read).error();
  }
  photographs.frames = pipeline::Developed{std::move(rgb)};
  // Figures were published of luminance.
  if (plan.clipped == Clipped::kMark)
    photographs.plane_weights = pipeline::measure_plane_weights(photographs);
  return photographs;
}

}  // namespace weft::app
