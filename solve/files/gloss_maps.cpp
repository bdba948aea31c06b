// SPDX-License-Identifier: Apache-2.0
#include "solve/files/gloss_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/image_io/image_io.h"
#include "core/solve/solve_record.h"
#include "core/solve/status_blend.h"
#include "report/downsampler.h"
#include "report/preview.h"
#include "solve/files/pictures.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

// Roughness, alpha, alpha along the yarn, azimuth of the yarn, f0 and that of R, G, B.
constexpr std::size_t kValues = 8, kRoughnessChannels = 4;
using Values = std::array<float, kValues>;

Values values_of(double alpha, double along, double yarn_deg, const std::array<double, 3>& f0) {
  Values values = {static_cast<float>(std::sqrt(std::sqrt(alpha * along))), static_cast<float>(alpha),
                   static_cast<float>(along), static_cast<float>(yarn_deg),
                   static_cast<float>(*std::ranges::max_element(f0))};
  for (std::size_t c = 0; c < 3; ++c) values[5 + c] = static_cast<float>(f0[c]);
  return values;
}

std::array<double, 3> f0_of(const GlossFacts& facts, std::size_t lobe) {
  const bool is_tinted = lobe < facts.f0_of_channels.size() && facts.f0_of_channels[lobe];
  const double f0 = facts.lobes[lobe].lobe.f0;
  return is_tinted ? facts.f0_of_channels[lobe]->f0 : std::array<double, 3>{f0, f0, f0};
}

bool has_tint(const GlossFacts& facts) {
  return std::ranges::any_of(facts.f0_of_channels, [](const auto& f0) { return f0.has_value(); });
}

// An azimuth from 0 to 180, as a yarn has no head.
double of_half_turn(double deg) {
  return deg - 180 * std::floor(deg / 180);
}

bool has_yarn(const solver::Lobe& lobe) {
  return lobe.family == solver::LobeFamily::kAnisotropicGgx;
}

// What a pixel can have: no lobe (kind 0), or one of two with its yarn along the axis or across.
constexpr std::size_t kKinds = 5;

std::size_t kind_of(unsigned status) {
  if ((status & kGlossy) == 0) return 0;
  return ((status & kSecondLobe) != 0 ? 3U : 1U) + ((status & kYarnAcross) != 0 ? 1U : 0U);
}
// The same yarn of the other material.
std::size_t other_kind(std::size_t kind) {
  return kind < 3 ? kind + 2 : kind - 2;
}

// What stands for a pixel that is `other` to a part: f0 is the mean of both, alpha what one lobe needs to
// look like both (alpha_of_one()), the azimuth that of the greater part if it has one.
Values mixed(const Values& most, const Values& other, double part) {
  const auto mean = [&](std::size_t i) -> double { return (1 - part) * most[i] + part * other[i]; };
  const auto harmonic = [&](std::size_t i) { return 1 / ((1 - part) / most[i] + part / other[i]); };
  const bool has_yarn = most[1] != most[2];
  return values_of(harmonic(1), harmonic(2), double{has_yarn ? most[3] : other[3]},
                   {mean(5), mean(6), mean(7)});
}

std::array<Values, kKinds> values_of(const GlossFacts& facts) {
  std::array<Values, kKinds> values;
  values.fill(values_of(kTypedAlpha, kTypedAlpha, 0, {kTypedF0, kTypedF0, kTypedF0}));
  for (std::size_t l = 0; l < facts.lobes.size(); ++l) {
    const solver::Lobe& lobe = facts.lobes[l].lobe;
    if (!lobe.shines()) continue;
    for (std::size_t across = 0; across < 2; ++across) {
      const double yarn = has_yarn(lobe) ? degrees(lobe.axis) + (across > 0 ? 90 : 0) : 0;
      const double alpha = solver::alpha_of_one(lobe);
      values[1 + 2 * l + across] =
          values_of(alpha, has_yarn(lobe) ? alpha * lobe.along : alpha, of_half_turn(yarn), f0_of(facts, l));
    }
  }
  return values;
}

// Each kind with a lobe as the picture has it.
struct PictureKinds {
  std::vector<report::LobeKey> keys;
  std::vector<std::size_t> kinds;  // by key

  // What a pixel shows of a key.
  float share_of(std::size_t key, std::size_t kind, unsigned eighths) const {
    const auto is_of = [&](std::size_t each) {
      // A lobe without a yarn has one key for both.
      const std::size_t same = keys[key].azimuth_deg ? each : each - (each + 1) % 2;
      return each > 0 && same == kinds[key];
    };
    const float other = static_cast<float>(eighths) / static_cast<float>(kBlendParts);
    if (is_of(kind)) return 1 - other;
    return other > 0 && is_of(other_kind(kind)) ? other : 0.0F;
  }
};

PictureKinds picture_kinds(const GlossFacts& facts) {
  PictureKinds all;
  for (std::size_t l = 0; l < facts.lobes.size(); ++l) {
    const solver::Lobe& lobe = facts.lobes[l].lobe;
    if (!lobe.shines()) continue;
    const std::string which = facts.lobes.size() < 2 ? "" : l == 0 ? "first " : "second ";
    for (std::size_t across = 0; across < (has_yarn(lobe) ? 2U : 1U); ++across) {
      report::LobeKey key = {.says = which + "lobe", .is_second = l > 0};
      if (has_yarn(lobe)) {
        key.azimuth_deg = of_half_turn(degrees(lobe.axis) + (across > 0 ? 90 : 0));
        key.says = fmt::format("{}yarn at {:.0f}°", which, *key.azimuth_deg);
      }
      all.keys.push_back(std::move(key));
      all.kinds.push_back(1 + 2 * l + across);
    }
  }
  return all;
}

}  // namespace

Result<void> write_gloss_maps(const fs::path& folder, const GlossFacts& facts, AlbedoScale scale,
                              Compression compression, PixelPitch pitch_mm, bool previews) {
  if (!facts.is_measured() || facts.share == 0) return {};
  const Result<LoadedImage> status = read_image(folder / "status.png");
  if (!status) return status.error();
  const Size size = status->info.size;
  const WriteOptions options = {.type = SampleType::kHalf, .compression = compression, .pitch_mm = pitch_mm};
  Result<ImageWriter> roughness = ImageWriter::open(
      folder / "roughness.exr", size, {"roughness", "alpha", "alpha_along", "yarn_deg"}, options);
  if (!roughness) return std::move(roughness).error();
  std::optional<ImageWriter> specular;
  const std::size_t f0_channels = has_tint(facts) ? 4 : 1;
  if (scale == AlbedoScale::kAbsolute) {
    const std::vector<std::string> channels =
        f0_channels == 1 ? std::vector<std::string>{"f0"} : std::vector<std::string>{"f0", "R", "G", "B"};
    Result<ImageWriter> opened = ImageWriter::open(folder / "specular.exr", size, channels, options);
    if (!opened) return std::move(opened).error();
    specular.emplace(std::move(*opened));
  }
  const std::array<Values, kKinds> values = values_of(facts);
  const PictureKinds pictured = picture_kinds(facts);
  const int keys = static_cast<int>(pictured.keys.size());
  report::Downsampler shares(size, keys);
  Image<float> row({size.width, 1}, static_cast<int>(kValues)), share({size.width, 1}, keys);
  std::vector<View<const float>> planes;
  for (std::size_t p = 0; p < kValues; ++p) planes.emplace_back(row.plane(static_cast<int>(p)));
  const std::span<const View<const float>> all = planes;
  std::vector<View<const float>> shown;
  for (int k = 0; k < keys; ++k) shown.emplace_back(share.plane(k));
  for (int y = 0; y < size.height; ++y) {
    const float* levels = status->planes.plane(0).row(y);
    for (int x = 0; x < size.width; ++x) {
      const auto bits = static_cast<unsigned>(std::lround(65535 * levels[x]));
      const std::size_t kind = kind_of(bits);
      const unsigned eighths = kind > 0 ? blend_of(bits) : 0;
      const Values here = eighths > 0 ? mixed(values[kind], values[other_kind(kind)],
                                              static_cast<double>(eighths) / kBlendParts)
                                      : values[kind];
      for (std::size_t p = 0; p < kValues; ++p) row(x, 0, static_cast<int>(p)) = here[p];
      for (int k = 0; k < keys; ++k)
        share(x, 0, k) = pictured.share_of(static_cast<std::size_t>(k), kind, eighths);
    }
    if (Result<void> ok = roughness->write_rows(all.first(kRoughnessChannels)); !ok) return ok;
    if (specular) {
      if (Result<void> ok = specular->write_rows(all.subspan(kRoughnessChannels, f0_channels)); !ok)
        return ok;
    }
    shares.add_rows(shown);
  }
  if (Result<void> ok = roughness->finish(); !ok) return ok;
  if (specular) {
    if (Result<void> ok = specular->finish(); !ok) return ok;
  }
  if (!previews) return {};
  return write_png(folder / "reflectance.png", report::lobe_picture(shares.averages(), pictured.keys));
}

}  // namespace weft::solve
