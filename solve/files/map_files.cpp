// SPDX-License-Identifier: Apache-2.0
#include "solve/files/map_files.h"

#include <utility>

namespace weft::solve {

PixelPitch pitch_in_the_middle(const Photographs& photographs) {
  if (!photographs.camera || !photographs.field) return {};
  const CameraModel& camera = *photographs.camera;
  const double x = (camera.size.width - 1) / 2.0, y = (camera.size.height - 1) / 2.0;
  const double height_mm = photographs.field->cloth_height_mm();
  const Vec3 middle = point_on_plane(camera, x, y, height_mm);
  return {length(point_on_plane(camera, x + 1, y, height_mm) - middle),
          length(point_on_plane(camera, x, y + 1, height_mm) - middle)};
}

Result<MapFiles> MapFiles::open(const std::filesystem::path& folder, Size size, Compression compression,
                                const std::vector<std::string>& sigma, PixelPitch pitch_mm) {
  struct Spec {
    std::optional<ImageWriter>* writer;
    const char* name;
    std::vector<std::string> channels;
    SampleType type;
  };
  MapFiles files;
  for (const Spec& spec : {Spec{&files.normal_, "normal.exr", {"X", "Y", "Z"}, SampleType::kFloat},
                           Spec{&files.albedo_, "albedo.exr", {"R", "G", "B"}, SampleType::kHalf},
                           Spec{&files.sigma_, "sigma.exr", sigma, SampleType::kHalf},
                           Spec{&files.residual_, "residual.exr", {"residual"}, SampleType::kHalf},
                           Spec{&files.status_, "status.png", {"Y"}, SampleType::kUint16}}) {
    Result<ImageWriter> opened =
        ImageWriter::open(folder / spec.name, size, spec.channels,
                          {.type = spec.type, .compression = compression, .pitch_mm = pitch_mm});
    if (!opened) return std::move(opened).error();
    spec.writer->emplace(std::move(*opened));
  }
  return files;
}

Result<void> MapFiles::write(const MapBand& band, std::span<const View<const float>> sigma) {
  if (Result<void> ok = normal_->write_rows(band.normal); !ok) return ok;
  if (Result<void> ok = residual_->write_rows(std::array{band.residual}); !ok) return ok;
  if (Result<void> ok = status_->write_rows(band.status); !ok) return ok;
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

}  // namespace weft::solve
