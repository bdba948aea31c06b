// SPDX-License-Identifier: Apache-2.0
#include "simulator/frame_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/files.h"

namespace weft::simulator {

Error no_memory(const std::string& why) {
  return {ErrorKind::kTryAgain, "not enough memory", "simulation", why,
          "end other programs or simulate a smaller picture"};
}

Result<void> check_memory(std::uint64_t bytes) {
  const std::uint64_t free = available_memory_bytes();
  if (free == 0 || bytes <= free) return {};  // 0: the system does not say
  return no_memory(fmt::format("{} MB are needed, {} MB are free", bytes / kMegabyte, free / kMegabyte));
}

RawFrame frame_head(const SimulationPlan& plan, double exposure_us) {
  RawFrame frame;
  const Sensor& sensor = plan.rig.sensor;
  const DefectSettings defects = defects_of(plan.scene);
  for (std::size_t y = 0; y < 2; ++y) {
    for (std::size_t x = 0; x < 2; ++x) {
      frame.black[y][x] = static_cast<float>(sensor.black + defects.cell_counts[y][x]);
    }
  }
  frame.white = static_cast<float>(sensor.white);
  const CameraSettings& camera = plan.scene.camera;
  frame.shot = {sensor.make, sensor.model,    "virtual",      exposure_us,
                camera.iso,  camera.f_number, kFocalLength_mm};
  return frame;
}

DngTags tags_of(const Scene& scene) {
  DngTags tags;
  for (std::size_t c = 0; c < 3; ++c) {
    tags.as_shot_neutral[c] = scene.lights.white_balance[c] / scene.lights.white_balance[1];
  }
  return tags;
}

void copy_counts(const PassTile& tile, int y0, View<std::uint16_t> counts) {
  const auto row_length = static_cast<std::size_t>(tile.rect.width());
  const std::uint16_t* row = tile.counts.data();
  for (int y = tile.rect.y0; y < tile.rect.y1; ++y, row += row_length) {
    std::copy_n(row, row_length, counts.row(y - y0) + tile.rect.x0);
  }
}

}  // namespace weft::simulator
