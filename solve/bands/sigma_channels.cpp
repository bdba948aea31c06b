// SPDX-License-Identifier: Apache-2.0
#include "solve/bands/sigma_channels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "solver/method.h"

namespace weft::solve {
namespace {

const std::array<std::string, 4> kOf = {"R", "G", "B", "normal_deg"};

}  // namespace

SigmaChannels::SigmaChannels(int width, const std::vector<std::string>& calibration)
    : width_(width), names_(kOf.begin(), kOf.end()) {
  for (const char* part : {".noise", ".model"}) {
    for (const std::string& of : kOf) names_.push_back(of + part);
  }
  for (const std::string& of : calibration) names_.push_back(of + ".calibration");
}

std::vector<View<const float>> SigmaChannels::of(const MapBand& band,
                                                 std::span<const View<const float>> calibration) {
  const int height = band.albedo_rows.height();
  if (sums_.height() < height) sums_ = Image<float>({width_, height}, static_cast<int>(kOf.size()));
  std::vector<View<const float>> parts(band.sigma_albedo.begin(), band.sigma_albedo.end());
  parts.push_back(band.sigma_normal_deg);
  parts.insert(parts.end(), band.model_albedo.begin(), band.model_albedo.end());
  parts.push_back(band.model_normal_deg);
  parts.insert(parts.end(), calibration.begin(), calibration.end());

  std::vector<View<const float>> channels;
  for (std::size_t c = 0; c < kOf.size(); ++c) {
    const View<float> sum = sums_.plane(static_cast<int>(c)).crop({0, 0, width_, height});
    const float most = c == kSumOfAngle ? solver::kUnknownAngleDeg : std::numeric_limits<float>::infinity();
    for (int y = 0; y < height; ++y) {
      float* row = sum.row(y);
      std::fill_n(row, width_, 0.0F);
      for (std::size_t i = c; i < parts.size(); i += kOf.size()) {
        const float* part = parts[i].row(y);
        for (int x = 0; x < width_; ++x) row[x] += part[x] * part[x];
      }
      for (int x = 0; x < width_; ++x) row[x] = std::min(std::sqrt(row[x]), most);
    }
    channels.emplace_back(sum);
  }
  channels.insert(channels.end(), parts.begin(), parts.end());
  return channels;
}

}  // namespace weft::solve
