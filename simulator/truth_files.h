// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image_io/image_io.h"
#include "simulator/effects/passes.h"

namespace weft::simulator {

/// Image files that are written together, band of rows by band of rows, from planes in memory.
class TruthFiles {
 public:
  /// One file: its name, its channels, and how wide its samples are.
  struct Map {
    std::string name;
    std::vector<std::string> channels;
    SampleType type = SampleType::kFloat;
  };

  static Result<TruthFiles> open(const std::filesystem::path& folder, Size size, int band_rows,
                                 const std::vector<Map>& maps) {
    TruthFiles files;
    int planes = 0;
    for (const Map& map : maps) {
      Result<ImageWriter> writer =
          ImageWriter::open(folder / map.name, size, map.channels, {.type = map.type});
      if (!writer) return writer.error();
      files.writers_.push_back(std::move(*writer));
      files.channels_.push_back(static_cast<int>(map.channels.size()));
      planes += files.channels_.back();
    }
    if (planes > 0) files.planes_ = Image<float>({size.width, std::min(band_rows, size.height)}, planes);
    return files;
  }

  bool empty() const { return writers_.empty(); }
  void begin_band(int y0) { y0_ = y0; }

  /// value_of(index in the tile's area) for each pixel that the tile was asked for.
  template <typename Value>
  void put(const PassTile& tile, int plane, const Value& value_of) {
    const View<float> view = planes_.plane(plane);
    for_each_pixel(tile.rect, [&](std::size_t, int x, int y) {
      view(x, y - y0_) = static_cast<float>(value_of(index_in(tile.area, x, y)));
    });
  }

  /// The samples R, G, B of each pixel that the tile was asked for, into three planes.
  void put_samples(const PassTile& tile, int plane) {
    for (int c = 0; c < 3; ++c) {
      const View<float> view = planes_.plane(plane + c);
      for_each_pixel(tile.rect, [&](std::size_t i, int x, int y) {
        view(x, y - y0_) = static_cast<float>(tile.samples[3 * i + static_cast<std::size_t>(c)]);
      });
    }
  }

  Result<void> write_band(int rows) {
    int plane = 0;
    for (std::size_t f = 0; f < writers_.size(); ++f) {
      std::vector<View<const float>> views;
      for (int c = 0; c < channels_[f]; ++c) {
        views.push_back(std::as_const(planes_).plane(plane++).crop({0, 0, planes_.width(), rows}));
      }
      if (Result<void> ok = writers_[f].write_rows(views); !ok) return ok;
    }
    return {};
  }

  Result<void> finish() {
    for (ImageWriter& writer : writers_) {
      if (Result<void> ok = writer.finish(); !ok) return ok;
    }
    return {};
  }

 private:
  std::vector<ImageWriter> writers_;
  std::vector<int> channels_;  ///< of each file
  Image<float> planes_;
  int y0_ = 0;
};

}  // namespace weft::simulator
