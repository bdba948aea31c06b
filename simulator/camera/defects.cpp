// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/defects.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "simulator/camera/streams.h"
#include "simulator/sampling/random.h"

namespace weft::simulator {
namespace {

constexpr double kReference_c = 25;

std::array<std::uint32_t, 4> bits_of(int x, int y, CameraStream stream, std::array<std::uint32_t, 2> key) {
  return philox({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, stream}, key);
}

}  // namespace

SensorPattern::SensorPattern(const DefectSettings& settings, std::array<std::uint32_t, 2> key)
    : settings_(settings),
      key_(key),
      warmth_(std::exp2((settings.temperature_c - kReference_c) / settings.dark_doubling_c)) {}

SensorPattern::Draw SensorPattern::draw(int x, int y) const {
  const auto bits = bits_of(x, y, kDefectStream, key_);
  const double u = uniform(bits[0], bits[1]);
  return {u<settings_.hot_per_million * 1e-6, u> 1 - settings_.dead_per_million * 1e-6,
          uniform(bits[2], bits[3])};
}

void SensorPattern::fill(Rect rect, std::span<PhotositeDefect> photosites) const {
  const bool has_defects = settings_.hot_per_million > 0 || settings_.dead_per_million > 0;
  const bool differs = settings_.response_percent > 0 || settings_.photosite_counts > 0;
  std::vector<double> columns(static_cast<std::size_t>(rect.width()));
  if (settings_.column_counts > 0)
    for (std::size_t i = 0; i < columns.size(); ++i)
      columns[i] = settings_.column_counts *
                   normal_pair(bits_of(rect.x0 + static_cast<int>(i), 0, kColumnStream, key_)).first;

  auto site = photosites.begin();
  for (int y = rect.y0; y < rect.y1; ++y) {
    const std::array<double, 2>& cell = settings_.cell_counts[static_cast<std::size_t>(y & 1)];
    for (int x = rect.x0; x < rect.x1; ++x, ++site) {
      *site = {1, settings_.dark_electrons_per_s * warmth_,
               cell[static_cast<std::size_t>(x & 1)] + columns[static_cast<std::size_t>(x - rect.x0)]};
      if (differs) {
        const NormalPair own = normal_pair(bits_of(x, y, kPhotositeStream, key_));
        site->response = std::max(1 + settings_.response_percent / 100 * own.first, 0.0);
        site->offset_counts += settings_.photosite_counts * own.second;
      }
      if (!has_defects) continue;
      const Draw defect = draw(x, y);
      if (defect.is_hot)
        site->dark_electrons_per_s += settings_.hot_electrons_per_s * warmth_ * (0.5 + defect.level);
      if (defect.is_dead) site->response *= settings_.dead_response;
    }
  }
}

std::vector<DefectivePhotosite> SensorPattern::defects(Size size) const {
  std::vector<DefectivePhotosite> found;
  if (settings_.hot_per_million <= 0 && settings_.dead_per_million <= 0) return found;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Draw defect = draw(x, y);
      if (defect.is_hot) found.push_back({x, y, DefectKind::kHot});
      if (defect.is_dead) found.push_back({x, y, DefectKind::kDead});
    }
  return found;
}

void expose(std::span<const PhotositeDefect> photosites, double exposure_s, double electrons_at_white,
            std::span<double> samples) {
  const double signal_per_rate = exposure_s / electrons_at_white;
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = samples[i] * photosites[i].response + photosites[i].dark_electrons_per_s * signal_per_rate;
}

void add_black_pattern(std::span<const PhotositeDefect> photosites, double counts_at_full,
                       std::span<double> samples) {
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] += photosites[i].offset_counts / counts_at_full;
}

}  // namespace weft::simulator
