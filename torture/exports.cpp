// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/temporary_folder.h"
#include "core/base/vec.h"
#include "core/image_io/image_io.h"
#include "exchange/presets/loss.h"
#include "exchange/presets/mips.h"
#include "exchange/presets/pack.h"
#include "exchange/presets/reduce.h"
#include "torture/hard_case.h"

namespace weft::torture {
namespace {

using exchange::MapPlane;
using exchange::PresetFile;
using exchange::SourcePlanes;

/// Maps that are one number each.
SourcePlanes planes_of(std::initializer_list<std::pair<MapPlane, double>> numbers) {
  SourcePlanes planes;
  for (const auto& [plane, number] : numbers) planes[static_cast<std::size_t>(plane)].constant = number;
  return planes;
}

SourcePlanes normal_planes(Vec3 n) {
  return planes_of({{MapPlane::kNormalX, n.x}, {MapPlane::kNormalY, n.y}, {MapPlane::kNormalZ, n.z}});
}

/// One pixel of a file, as it comes back from one that was written. Empty: it could not be written.
struct Stored {
  std::vector<float> samples;
  exchange::Loss loss;
};

Stored stored(const PresetFile& file, const SourcePlanes& planes, SampleType type) {
  Image<float> pixel({1, 1}, static_cast<int>(file.channels.size()));
  std::vector<View<float>> views;
  std::vector<View<const float>> written;
  for (int p = 0; p < pixel.planes(); ++p) {
    views.push_back(pixel.plane(p));
    written.emplace_back(pixel.plane(p));
  }
  exchange::pack_values(file, planes, {}, 0, views);
  exchange::to_samples(file, {}, views);
  const TemporaryFolder scratch;
  const auto path = scratch.path() / (type == SampleType::kHalf ? "pixel.exr" : "pixel.png");
  WriteOptions options;
  options.type = type;
  if (!write_image(path, written, exchange::channel_names(file.channels.size()), options)) return {};
  Result<LoadedImage> read = read_image(path);
  if (!read) return {};
  Stored back;
  for (int p = 0; p < pixel.planes(); ++p) back.samples.push_back(read->planes(0, 0, p));
  back.loss = exchange::measure_loss(file, planes, {}, std::move(read->planes));
  return back;
}

PresetFile file_with(std::vector<std::string> channels, exchange::Encoding encoding, int bits) {
  PresetFile file;
  file.channels = std::move(channels);
  file.stored.encoding = encoding;
  file.stored.bits = bits;
  return file;
}

std::string lost(const exchange::Loss& loss) {
  return loss.normal ? fmt::format("{:.2f} degrees lost", loss.normal->max_deg) : "";
}

HardCase steep_slope() {
  const double tilt = radians(89);
  const Vec3 n = {-std::sin(tilt), 0, std::cos(tilt)};
  const auto in_eight_bits = [](double part) { return std::nearbyint(255 * (part + 1) / 2) / 255 * 2 - 1; };
  const double x = in_eight_bits(n.x), y = in_eight_bits(n.y);
  const Vec3 plain = {x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))};
  const Stored back = stored(file_with({"normal.x", "normal.y", "normal.z"}, exchange::Encoding::kPng, 8),
                             normal_planes(n), SampleType::kUint8);
  return {.stage = "export",
          .what = "a slope of 89 degrees in 8 bits, z made of x and y",
          .unit = "degrees",
          .plain = angle_deg(plain, n),
          .ours = back.loss.normal ? std::optional(back.loss.normal->max_deg) : std::nullopt,
          .flag = lost(back.loss),
          .within = 0.4,  // half a step of each part
          .must_say = "lost"};
}

HardCase flat_cloth() {
  const double truth = degrees(std::atan(std::sqrt(2.0) / 255));
  const Stored back = stored(file_with({"normal.x", "normal.y", "normal.z"}, exchange::Encoding::kPng, 8),
                             normal_planes({0, 0, 1}), SampleType::kUint8);
  return {
      .stage = "export",
      .what = "flat cloth in 8 bits, which have no 0: the tilt that nobody tells",
      .unit = "degrees",
      .plain = truth,
      .ours = back.loss.normal ? std::optional(std::abs(back.loss.normal->max_deg - truth)) : std::nullopt,
      .flag = lost(back.loss),
      .within = 1e-4,
      .must_say = "0.32 degrees lost"};
}

HardCase too_high_for_half() {
  constexpr double kLargestHalf = 65504, kValue = 1e6;
  const double plain = kValue >= 65520 ? std::numeric_limits<double>::infinity() : kValue;  // IEEE 754
  const Stored back = stored(file_with({"height"}, exchange::Encoding::kExr, 16),
                             planes_of({{MapPlane::kHeight, kValue}}), SampleType::kHalf);
  HardCase hard = {.stage = "export",
                   .what = "a million in half floats, off the largest there is",
                   .unit = "of the value",
                   .plain = std::isfinite(plain) ? std::optional(plain - kLargestHalf) : std::nullopt,
                   .ours = {},
                   .within = 0,
                   .must_say = "1 pixel cut"};
  if (back.samples.empty()) return hard;
  hard.ours = std::abs(back.samples[0] - kLargestHalf);
  hard.flag = fmt::format("{} pixel cut", back.loss.channels[0].cut);
  return hard;
}

HardCase too_bright_for_bytes() {
  constexpr double kAlbedo = 1.4;
  const auto plain = static_cast<std::uint8_t>(static_cast<int>(255 * kAlbedo));
  const Stored back =
      stored(file_with({"albedo.r", "albedo.g", "albedo.b"}, exchange::Encoding::kPng, 8),
             planes_of({{MapPlane::kAlbedoR, kAlbedo}, {MapPlane::kAlbedoG, 1}, {MapPlane::kAlbedoB, 1}}),
             SampleType::kUint8);
  HardCase hard = {.stage = "export",
                   .what = "an albedo of 1.4 in 8 bits, off white",
                   .unit = "% of white",
                   .plain = 100 * std::abs(plain / 255.0 - 1),
                   .ours = {},
                   .within = 0,
                   .must_say = "1 pixel cut"};
  if (back.samples.empty()) return hard;
  hard.ours = 100 * std::abs(back.samples[0] - 1.0);
  hard.flag = fmt::format("{} pixel cut", back.loss.channels[0].cut);
  return hard;
}

HardCase level_height() {
  constexpr double kHeight = 0.25, kLeast = 0.25, kMost = 0.25;
  const double plain = (kHeight - kLeast) / (kMost - kLeast);
  Image<float> pixel({1, 1});
  const std::array<View<float>, 1> views = {pixel.plane()};
  const PresetFile file = file_with({"height"}, exchange::Encoding::kPng, 16);
  const exchange::ChannelFacts facts = {.height_least_mm = kLeast, .height_most_mm = kMost};
  exchange::pack_values(file, planes_of({{MapPlane::kHeight, kHeight}}), facts, 0, views);
  exchange::to_samples(file, facts, views);
  return {.stage = "export",
          .what = "the height of cloth that has none, as integers",
          .unit = "of the range, off its middle",
          .plain = std::isfinite(plain) ? std::optional(std::abs(plain - 0.5)) : std::nullopt,
          .ours = std::abs(pixel(0, 0) - 0.5),
          .within = 0};
}

HardCase folded_mip() {
  Image<float> fine({2, 1}, 3), coarse({1, 1}, 3);
  fine(0, 0, 0) = 1;
  fine(1, 0, 0) = -1;
  const double plain = angle_deg(normalized(Vec3{1, 0, 0} + Vec3{-1, 0, 0}), {0, 0, 1});
  exchange::reduce_normals({fine.plane(0), fine.plane(1), fine.plane(2)}, 1,
                           {coarse.plane(0), coarse.plane(1), coarse.plane(2)});
  return {.stage = "export",
          .what = "a mip over a fold, whose normals cancel",
          .unit = "degrees",
          .plain = std::isfinite(plain) ? std::optional(plain) : std::nullopt,
          .ours = angle_deg({coarse(0, 0, 0), coarse(0, 0, 1), coarse(0, 0, 2)}, {0, 0, 1}),
          .within = 1e-4};
}

HardCase odd_mip() {
  constexpr int kTextureSide = 5;
  Image<float> fine({kTextureSide, kTextureSide});
  double truth = 0, plain = 0;
  for (int y = 0; y < kTextureSide; ++y) {
    for (int x = 0; x < kTextureSide; ++x) {
      fine(x, y) = static_cast<float>(1 + x);
      truth += (1.0 + x) / (kTextureSide * kTextureSide);
      if (x < 4 && y < 4) plain += (1.0 + x) / 16;
    }
  }
  const Image<float> coarse =
      exchange::next_level(file_with({"cavity"}, exchange::Encoding::kPng, 8), fine, 1);
  double ours = 0;
  for (int y = 0; y < coarse.height(); ++y) {
    for (int x = 0; x < coarse.width(); ++x) ours += coarse(x, y) / double(coarse.size().pixels());
  }
  return {.stage = "export",
          .what = "the mip of a texture of odd sides: its mean",
          .unit = "%",
          .plain = 100 * std::abs(plain / truth - 1),
          .ours = 100 * std::abs(ours / truth - 1),
          .within = 1e-4};
}

}  // namespace

std::vector<HardCase> hard_exports() {
  return {steep_slope(), flat_cloth(), too_high_for_half(), too_bright_for_bytes(), level_height(),
          folded_mip(),  odd_mip()};
}

}  // namespace weft::torture
