// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/map_files.h"

#include <algorithm>
#include <utility>

#include "pipeline/calibration_channels.h"

namespace weft::app {

CalibrationChannels::CalibrationChannels(const Photographs& photographs, solver::CalibrationSigmas sigmas,
                                         int threads)
    : photographs_(&photographs), sigmas_(std::move(sigmas)), threads_(threads) {}

Result<CalibrationChannels> CalibrationChannels::make(const Photographs& photographs, int threads) {
  Result<solver::CalibrationSigmas> sigmas =
      solver::CalibrationSigmas::make(*photographs.field, photographs.size, photographs.leds,
                                      *photographs.light_covariance, photographs.noise);
  if (!sigmas) return std::move(sigmas).error();
  return CalibrationChannels(photographs, std::move(*sigmas), threads);
}

std::array<View<const float>, 4> CalibrationChannels::of(const MapBand& band) {
  const int width = photographs_->size.width, height = band.albedo_rows.height();
  const int needed = rows_ + band.rows.height();
  if (normal_.height() < needed) {
    Image<float> larger({width, needed}, 3);
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < rows_; ++y) std::copy_n(normal_.plane(c).row(y), width, larger.plane(c).row(y));
    }
    normal_ = std::move(larger);
  }
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < band.rows.height(); ++y) {
      std::copy_n(band.normal[static_cast<std::size_t>(c)].row(y), width, normal_.plane(c).row(rows_ + y));
    }
  }
  rows_ = needed;
  if (albedo_.height() < height) {
    albedo_ = Image<float>({width, height});
    relative_ = Image<float>({width, height});
    channels_ = Image<float>({width, height}, 4);
  }

  const Rect rows = {0, 0, width, height};
  const bool mosaic = photographs_->rgb.empty();
  const CfaPattern cfa = mosaic ? photographs_->radiometry->cfa() : CfaPattern{};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int c = mosaic ? cfa.channel_at(x, band.albedo_rows.y0 + y) : 1;
      albedo_(x, y) = band.albedo[static_cast<std::size_t>(c)](x, y);
    }
  }
  if (height > 0) {
    fill_calibration_sigma(
        sigmas_, band.albedo_rows,
        {normal_.plane(0).crop(rows), normal_.plane(1).crop(rows), normal_.plane(2).crop(rows)},
        albedo_.plane().crop(rows), mosaic ? &cfa : nullptr, threads_, channels_.plane(3).crop(rows),
        relative_.plane().crop(rows));
  }
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        channels_(x, y, c) = relative_(x, y) * band.albedo[static_cast<std::size_t>(c)](x, y);
      }
    }
  }
  const int left = band.rows.y1 - band.albedo_rows.y1;
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < left; ++y) {
      std::copy_n(normal_.plane(c).row(rows_ - left + y), width, normal_.plane(c).row(y));
    }
  }
  rows_ = left;
  return {channels_.plane(0).crop(rows), channels_.plane(1).crop(rows), channels_.plane(2).crop(rows),
          channels_.plane(3).crop(rows)};
}

Result<MapFiles> MapFiles::open(const std::filesystem::path& folder, Size size,
                                const std::string& compression, const std::vector<std::string>& calibration) {
  struct Spec {
    std::optional<ImageWriter>* writer;
    const char* name;
    std::vector<std::string> channels;
    SampleType type;
  };
  MapFiles files;
  std::vector<std::string> sigma = {"R", "G", "B", "normal_deg"};
  for (const std::string& name : calibration) sigma.push_back(name + ".calibration");
  for (const Spec& spec : {Spec{&files.normal_, "normal.exr", {"X", "Y", "Z"}, SampleType::kFloat},
                           Spec{&files.albedo_, "albedo.exr", {"R", "G", "B"}, SampleType::kHalf},
                           Spec{&files.sigma_, "sigma.exr", sigma, SampleType::kHalf},
                           Spec{&files.residual_, "residual.exr", {"residual"}, SampleType::kHalf},
                           Spec{&files.status_, "status.png", {"Y"}, SampleType::kUint16}}) {
    Result<ImageWriter> opened = ImageWriter::open(folder / spec.name, size, spec.channels,
                                                   {.type = spec.type, .compression = compression});
    if (!opened) return std::move(opened).error();
    spec.writer->emplace(std::move(*opened));
  }
  return files;
}

Result<void> MapFiles::write(const MapBand& band, std::span<const View<const float>> calibration) {
  if (Result<void> ok = normal_->write_rows(band.normal); !ok) return ok;
  if (Result<void> ok = residual_->write_rows(std::array{band.residual}); !ok) return ok;
  if (Result<void> ok = status_->write_rows(band.status); !ok) return ok;
  std::vector<View<const float>> sigma(band.sigma_albedo.begin(), band.sigma_albedo.end());
  sigma.push_back(band.sigma_normal_deg);
  sigma.insert(sigma.end(), calibration.begin(), calibration.end());
  if (band.albedo_rows.height() == 0) return {};
  if (Result<void> ok = albedo_->write_rows(band.albedo); !ok) return ok;
  return sigma_->write_rows(sigma);
}

Result<void> MapFiles::finish() {
  for (std::optional<ImageWriter>* writer : {&normal_, &albedo_, &sigma_, &residual_, &status_}) {
    if (Result<void> ok = (*writer)->finish(); !ok) return ok;
  }
  return {};
}

}  // namespace weft::app
