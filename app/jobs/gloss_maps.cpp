// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/gloss_maps.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/jobs/pictures.h"
#include "core/image_io/image_io.h"
#include "core/solve_record.h"
#include "report/downsampler.h"
#include "report/preview.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

// Roughness, alpha, alpha along the yarn, azimuth of the yarn, f0.
constexpr std::size_t kValues = 5, kRoughnessChannels = 4;
using Values = std::array<float, kValues>;

Values values_of(double alpha, double along, double yarn_deg, double f0) {
  return {static_cast<float>(std::sqrt(std::sqrt(alpha * along))), static_cast<float>(alpha),
          static_cast<float>(along), static_cast<float>(yarn_deg), static_cast<float>(f0)};
}

// An azimuth from 0 to 180, as a yarn has no head.
double of_half_turn(double deg) {
  return deg - 180 * std::floor(deg / 180);
}

// What pixels can have: no lobe, one with its yarn along the axis, one with it across.
std::array<Values, 3> values_of(const solver::Lobe& lobe) {
  const bool has_yarn = lobe.family == solver::LobeFamily::kAnisotropicGgx;
  const double along = has_yarn ? lobe.alpha * lobe.along : lobe.alpha;
  const double axis = has_yarn ? degrees(lobe.axis) : 0, across = has_yarn ? axis + 90 : 0;
  return {values_of(kTypedAlpha, kTypedAlpha, 0, kTypedF0),
          values_of(lobe.alpha, along, of_half_turn(axis), lobe.f0),
          values_of(lobe.alpha, along, of_half_turn(across), lobe.f0)};
}

std::size_t kind_of(unsigned status) {
  if ((status & kGlossy) == 0) return 0;
  return (status & kYarnAcross) == 0 ? 1 : 2;
}

Result<void> write_picture(const fs::path& file, const report::Downsampler& shares,
                           const solver::Lobe& lobe) {
  std::optional<double> axis_deg;
  if (lobe.family == solver::LobeFamily::kAnisotropicGgx) axis_deg = of_half_turn(degrees(lobe.axis));
  return write_png(file, report::yarn_picture(shares.averages(), axis_deg));
}

}  // namespace

Result<void> write_gloss_maps(const fs::path& folder, const pipeline::GlossFacts& facts, AlbedoScale scale,
                              Compression compression, bool previews) {
  if (!facts.lobe.is_measured() || facts.share == 0) return {};
  const Result<LoadedImage> status = read_image(folder / "status.png");
  if (!status) return status.error();
  const Size size = status->info.size;
  const WriteOptions options = {.type = SampleType::kHalf, .compression = compression};
  Result<ImageWriter> roughness = ImageWriter::open(
      folder / "roughness.exr", size, {"roughness", "alpha", "alpha_along", "yarn_deg"}, options);
  if (!roughness) return std::move(roughness).error();
  std::optional<ImageWriter> specular;
  if (scale == AlbedoScale::kAbsolute) {
    Result<ImageWriter> opened = ImageWriter::open(folder / "specular.exr", size, {"f0"}, options);
    if (!opened) return std::move(opened).error();
    specular.emplace(std::move(*opened));
  }
  const std::array<Values, 3> values = values_of(facts.lobe.lobe);
  report::Downsampler shares(size, 2);
  Image<float> row({size.width, 1}, static_cast<int>(kValues)), share({size.width, 1}, 2);
  std::vector<View<const float>> planes;
  for (std::size_t p = 0; p < kValues; ++p) planes.emplace_back(row.plane(static_cast<int>(p)));
  const std::span<const View<const float>> all = planes;
  for (int y = 0; y < size.height; ++y) {
    const float* levels = status->planes.plane(0).row(y);
    for (int x = 0; x < size.width; ++x) {
      const std::size_t kind = kind_of(static_cast<unsigned>(std::lround(65535 * levels[x])));
      for (std::size_t p = 0; p < kValues; ++p) row(x, 0, static_cast<int>(p)) = values[kind][p];
      share(x, 0, 0) = kind > 0 ? 1.0F : 0.0F;
      share(x, 0, 1) = kind > 1 ? 1.0F : 0.0F;
    }
    if (Result<void> ok = roughness->write_rows(all.first(kRoughnessChannels)); !ok) return ok;
    if (specular) {
      if (Result<void> ok = specular->write_rows(all.subspan(kRoughnessChannels)); !ok) return ok;
    }
    shares.add_rows(std::array{View<const float>(share.plane(0)), View<const float>(share.plane(1))});
  }
  if (Result<void> ok = roughness->finish(); !ok) return ok;
  if (specular) {
    if (Result<void> ok = specular->finish(); !ok) return ok;
  }
  if (!previews) return {};
  return write_picture(folder / "reflectance.png", shares, facts.lobe.lobe);
}

}  // namespace weft::app
