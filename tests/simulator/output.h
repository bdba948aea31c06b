// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "capture/raw/decode_raw.h"
#include "simulator/simulate.h"

// What the simulator makes of a scene, for tests to look at.

namespace weft::simulator {

inline Scene near_lit(GeometryKind kind) {
  Scene scene;
  scene.geometry.kind = kind;
  scene.effects.near_light = true;
  return scene;
}

inline Rendering render(const Scene& scene, Rect area, const TileOptions& tiles = {}) {
  Result<Rendering> rendering = render_readings(scene, area, tiles);
  EXPECT_TRUE(rendering) << rendering.error().message();
  return rendering ? std::move(*rendering) : Rendering();
}

inline RawFrame decoded(const std::filesystem::path& file) {
  Result<RawFrame> frame = capture::decode_raw(file);
  EXPECT_TRUE(frame) << frame.error().message();
  return frame ? std::move(*frame) : RawFrame();
}

inline std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  return names;
}

}  // namespace weft::simulator
