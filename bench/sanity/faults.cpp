// SPDX-License-Identifier: Apache-2.0
#include "bench/sanity/faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "core/base/files.h"
#include "core/image/color_spaces.h"
#include "core/image_io/image_io.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

Vec3 direction_at(double height_deg, double turn) {
  const double height = radians(height_deg);
  return {std::cos(height) * std::cos(turn), std::cos(height) * std::sin(turn), std::sin(height)};
}

// On a dome, on two rings, or on a ring that somebody held by hand.
std::vector<Vec3> draw_directions(Draws& draws) {
  const int count = static_cast<int>(draws.of_ratio(8, 97)), layout = draws.below(3);
  const double low = draws.between(25, 45), high = low + draws.between(15, 30),
               first = draws.between(0, 2 * kPi);
  std::vector<Vec3> all;
  for (int k = 0; k < count; ++k) {
    const double turn = first + 2 * kPi * k / count + 0.3 * draws.normal() / count;
    const double height_deg = layout == 0   ? draws.between(low, high)
                              : layout == 1 ? (k % 2 == 0 ? low : high)
                                            : 0.5 * (low + high) + 4 * draws.normal();
    all.push_back(
        direction_at(std::clamp(height_deg, 15.0, 85.0), layout == 0 ? draws.between(0, 2 * kPi) : turn));
  }
  return all;
}

template <typename Change>
void change(Image<float>& image, const Change& to) {
  for (int c = 0; c < image.planes(); ++c) {
    for (int y = 0; y < image.height(); ++y) {
      float* row = image.plane(c).row(y);
      std::transform(row, row + image.width(), row, to);
    }
  }
}

// So that this share of all samples is below `level`.
void expose(double share, double level, std::vector<Image<float>>& photographs) {
  std::vector<float> samples;
  for (const Image<float>& image : photographs) {
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < image.height(); y += 2) {
        const float* row = image.plane(c).row(y);
        std::copy_if(row, row + image.width(), std::back_inserter(samples), [](float v) { return v > 0; });
      }
    }
  }
  const auto at =
      samples.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(samples.size() - 1));
  std::nth_element(samples.begin(), at, samples.end());
  const float factor = static_cast<float>(level) / *at;
  for (Image<float>& image : photographs) change(image, [&](float v) { return factor * v; });
}

void photograph(DrawnSet& set) {
  set.photographs.clear();
  for (const DrawnLight& light : set.lights) set.photographs.push_back(seen(set.cloth, light));
}

// --- faults

void tell(DrawnSet& set, Vec3 (*as)(Vec3)) {
  std::ranges::transform(set.told, set.told.begin(), as);
}

void take_for_linear(DrawnSet& set, Draws& draws) {
  set.kind = draws.with(0.5) ? DrawnSet::Kind::kPng16 : DrawnSet::Kind::kTiff16;
  set.is_srgb = true;
}

void take_for_srgb(DrawnSet& set, Draws&) {
  set.kind = DrawnSet::Kind::kPng8;
  set.is_srgb = false;
}

void say_linear(DrawnSet& set, Draws&) {
  set.kind = DrawnSet::Kind::kPng8;
  set.is_srgb = true;
  set.said = Transfer::kLinear;
}

void say_srgb(DrawnSet& set, Draws&) {
  set.kind = DrawnSet::Kind::kPng8;
  set.is_srgb = false;
  set.said = Transfer::kSrgb;
}

void bring_near(DrawnSet& set, Draws& draws) {
  const double half_widths = draws.between(2.5, 4);
  for (DrawnLight& light : set.lights) light.distance_px = half_widths * set.cloth.albedo.width() / 2;
  photograph(set);
  expose(0.999, 0.8, set.photographs);
}

void leave_black(DrawnSet& set, Draws& draws) {
  set.black = draws.between(0.02, 0.1);
}

// Full scale times `share`, where the cloth is brightest.
void light_room(DrawnSet& set, double share) {
  DrawnLight room;
  room.strength = 0;
  room.direction = {0, 0, 1};
  room.room = 1;
  std::vector<Image<float>> of_room;
  of_room.push_back(seen(set.cloth, room));
  expose(0.9, share, of_room);
  set.room = std::move(of_room.front());
}

void clip(DrawnSet& set, Draws& draws) {
  set.kind = draws.with(0.5) ? DrawnSet::Kind::kPng16 : DrawnSet::Kind::kTiff16;
  set.is_srgb = false;
  set.full = draws.with(0.5) ? 4095.0 / 65535 : 16383.0 / 65535;
  expose(draws.between(0.95, 0.995), set.full, set.photographs);
  set.noise *= set.full;
  set.shot_noise *= std::sqrt(set.full);
}

void expose_by_turns(DrawnSet& set, Draws&) {
  for (std::size_t k = 1; k < set.photographs.size(); k += 2)
    change(set.photographs[k], [](float v) { return v / 2; });
}

void sort_as_text(DrawnSet& set, Draws&) {
  for (std::size_t k = 0; k < set.names.size(); ++k) set.names[k] = fmt::format("img_{}", k + 3);
  std::ranges::sort(set.names);  // the light file goes through them so, and the lights do not
  std::vector<Image<float>> sorted;
  for (const std::string& name : set.names)
    sorted.push_back(std::move(set.photographs[std::stoul(name.substr(4)) - 3]));
  set.photographs = std::move(sorted);
}

}  // namespace

DrawnSet draw_set(std::uint32_t seed) {
  Draws draws(seed);
  DrawnSet set;
  const Size size = {64 + draws.below(65), 64 + draws.below(33)};
  set.cloth = draw_cloth(size, draws);
  set.told = draw_directions(draws);
  set.tells_strengths = draws.with(0.5);
  const bool has_zeros = draws.with(0.5);
  for (std::size_t k = 0; k < set.told.size(); ++k) {
    set.lights.push_back({set.told[k], set.tells_strengths ? draws.between(0.6, 1.4) : 1.0, 0, 0});
    set.names.push_back(has_zeros ? fmt::format("img_{:03}", k + 1) : fmt::format("img_{}", k + 1));
  }
  photograph(set);
  expose(0.999, draws.between(0.5, 0.95), set.photographs);
  set.kind = static_cast<DrawnSet::Kind>(draws.below(4));
  set.is_srgb = set.kind == DrawnSet::Kind::kPng8;
  set.noise = draws.of_ratio(0.0005, 0.003);
  set.shot_noise = draws.of_ratio(0.002, 0.01);
  return set;
}

const std::vector<SetFault>& set_faults() {
  static const std::vector<SetFault> kFaults = {
      {"none", {}, {}, [](DrawnSet&, Draws&) {}},
      {"none, 8 bits said to be linear",
       {},
       {},
       [](DrawnSet& set, Draws&) {
         set.kind = DrawnSet::Kind::kPng8;
         set.is_srgb = false;
         set.said = Transfer::kLinear;
       }},
      {"x mirrored",
       {"LIGHTS_MIRRORED"},
       {},
       [](DrawnSet& set, Draws&) { tell(set, [](Vec3 v) {
                                     return Vec3{-v.x, v.y, v.z};
                                   }); }},
      {"y mirrored",
       {"LIGHTS_MIRRORED"},
       {},
       [](DrawnSet& set, Draws&) { tell(set, [](Vec3 v) {
                                     return Vec3{v.x, -v.y, v.z};
                                   }); }},
      {"both mirrored",
       {"LIGHTS_MIRRORED"},
       {},
       [](DrawnSet& set, Draws&) { tell(set, [](Vec3 v) {
                                     return Vec3{-v.x, -v.y, v.z};
                                   }); }},
      {"quarter turned",
       {"LIGHTS_MIRRORED"},
       {},
       [](DrawnSet& set, Draws&) { tell(set, [](Vec3 v) {
                                     return Vec3{-v.y, v.x, v.z};
                                   }); }},
      {"exchanged",
       {"LIGHTS_MIRRORED"},
       {},
       [](DrawnSet& set, Draws&) { tell(set, [](Vec3 v) {
                                     return Vec3{v.y, v.x, v.z};
                                   }); }},
      {"negated",
       {},
       {"below the table"},
       [](DrawnSet& set, Draws&) { tell(set, [](Vec3 v) { return -1.0 * v; }); }},
      {"one below the table",
       {},
       {"below the table"},
       [](DrawnSet& set, Draws& draws) {
         set.told[static_cast<std::size_t>(draws.below(static_cast<int>(set.told.size())))].z *= -1;
       }},
      {"sRGB taken for linear", {"TRANSFER"}, {"values are those of sRGB"}, take_for_linear},
      {"linear taken for sRGB", {"TRANSFER"}, {"values are linear"}, take_for_srgb},
      {"sRGB said to be linear", {"TRANSFER"}, {}, say_linear},
      {"linear said to be sRGB", {"TRANSFER"}, {}, say_srgb},
      {"near lamps", {"LIGHTS_ARE_NEAR"}, {}, bring_near},
      {"black level", {"LIGHT_IN_ALL"}, {}, leave_black},
      {"lit room",
       {"LIGHT_IN_ALL"},
       {},
       [](DrawnSet& set, Draws& draws) { light_room(set, draws.between(0.02, 0.1)); }},
      {"lit room, dark photograph beside",
       {},
       {"dark photograph"},
       [](DrawnSet& set, Draws& draws) {
         light_room(set, draws.between(0.02, 0.1));
         set.has_dark = true;
       }},
      {"clipped below full scale", {}, {"taken as clipped"}, clip},
      {"exposed by turns", {"EXPOSURES_DIFFER"}, {}, expose_by_turns},
      {"one file twice", {}, {"under two lights"}, [](DrawnSet& set, Draws&) { set.first_is_second = true; }},
      {"files in the order of text", {"FILE_ORDER"}, {}, sort_as_text}};
  return kFaults;
}

namespace {

const char* ending_of(DrawnSet::Kind kind) {
  switch (kind) {
    case DrawnSet::Kind::kPng16:
    case DrawnSet::Kind::kPng8:
      break;
    case DrawnSet::Kind::kTiff16:
      return ".tif";
    case DrawnSet::Kind::kExr:
      return ".exr";
  }
  return ".png";
}

// Photograph k, or where all lamps are off.
Image<float> exposed(const DrawnSet& set, std::optional<std::size_t> k, Draws& draws) {
  Image<float> image(set.cloth.albedo.size(), 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        double light = set.black;
        if (k) light += static_cast<double>(set.photographs[*k](x, y, c));
        if (set.room.width() > 0) light += static_cast<double>(set.room(x, y, c));
        const double read = light + draws.normal() * (set.noise + set.shot_noise * std::sqrt(light));
        const double value = std::clamp(read, 0.0, set.full);
        image(x, y, c) = static_cast<float>(set.is_srgb ? srgb_of_rec709({value, value, value})[0] : value);
      }
    }
  }
  return image;
}

Result<void> write_photograph(const DrawnSet& set, std::optional<std::size_t> k, const fs::path& file,
                              Draws& draws) {
  const Image<float> image = exposed(set, k, draws);
  const SampleType type = set.kind == DrawnSet::Kind::kPng8  ? SampleType::kUint8
                          : set.kind == DrawnSet::Kind::kExr ? SampleType::kFloat
                                                             : SampleType::kUint16;
  const std::array<View<const float>, 3> planes = {image.plane(0), image.plane(1), image.plane(2)};
  return write_image(file, planes, {"R", "G", "B"}, {.type = type});
}

}  // namespace

Result<solve::PhotoOptions> write_set(const DrawnSet& set, const fs::path& folder, Draws& draws) {
  solve::PhotoOptions options;
  options.folder = folder;
  options.light_file = folder / "cloth.lp";
  options.reading.transfer = set.said;
  const char* ending = ending_of(set.kind);
  std::string lights = fmt::format("{}\n", set.told.size());
  for (std::size_t k = 0; k < set.told.size(); ++k) {
    const fs::path file = folder / (set.names[k] + ending);
    const std::size_t shown = k == 0 && set.first_is_second ? 1 : k;
    if (shown == k) {
      if (Result<void> ok = write_photograph(set, k, file, draws); !ok) return std::move(ok).error();
    }
    if (k == 1 && set.first_is_second) fs::copy_file(file, folder / (set.names[0] + ending));
    const Vec3& v = set.told[k];
    lights += fmt::format("{}{} {} {} {}", set.names[k], ending, v.x, v.y, v.z);
    if (set.tells_strengths) lights += fmt::format(" {0} {0} {0}", set.lights[k].strength);
    lights += '\n';
  }
  if (Result<void> ok = write_file(options.light_file, lights); !ok) return std::move(ok).error();
  if (set.has_dark) {
    Result<void> ok = write_photograph(set, std::nullopt, folder / (std::string("dark") + ending), draws);
    if (!ok) return std::move(ok).error();
  }
  if (set.cloth.shape != Shape::kBall) return options;
  const std::array<View<const float>, 1> mask = {set.cloth.inside.plane()};
  Result<void> ok = write_image(folder / "mask.png", mask, {"Y"}, {.type = SampleType::kUint8});
  if (!ok) return std::move(ok).error();
  return options;
}

}  // namespace weft::bench
