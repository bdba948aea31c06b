// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image/image.h"
#include "simulator/camera/camera_settings.h"

namespace weft::simulator {

/// How one photosite departs from the ideal one. The same in every shot.
struct PhotositeDefect {
  double response = 1;              ///< share of the light that it counts, from 0
  double dark_electrons_per_s = 0;  ///< mean charge without light
  double offset_counts = 0;         ///< of its black level
};

/// How a photosite is broken: too much charge without light, or none with it.
enum class DefectKind : std::uint8_t { kHot, kDead };

/// A broken photosite by its place in the frame.
struct DefectivePhotosite {
  int x = 0, y = 0;
  DefectKind kind = DefectKind::kHot;

  bool operator==(const DefectivePhotosite&) const = default;
};

/// The fixed pattern of a sensor: a function of key and absolute place, so that tiles agree. Response
/// (PRNU) and black level (DSNU) are normal, as EMVA standard 1288 (release 3.1) takes them; dark current
/// doubles every dark_doubling_c as there. A hot photosite adds half to one and a half times
/// hot_electrons_per_s, evenly spread; no photosite is hot and dead.
class SensorPattern {
 public:
  SensorPattern(const DefectSettings& settings, std::array<std::uint32_t, 2> key);

  /// The photosites of `rect`, row by row.
  void fill(Rect rect, std::span<PhotositeDefect> photosites) const;
  /// All defects of a frame, row by row: the hot map of its calibration.
  std::vector<DefectivePhotosite> defects(Size size) const;

 private:
  struct Draw {
    bool is_hot;
    bool is_dead;
    double level;  ///< in (0, 1), of a hot one's charge
  };
  Draw draw(int x, int y) const;

  DefectSettings settings_;
  std::array<std::uint32_t, 2> key_;
  double warmth_;  ///< dark current over that at 25 degrees Celsius
};

/// Before noise: signal = signal * response + dark charge of the exposure, which so has its photon noise.
void expose(std::span<const PhotositeDefect> photosites, double exposure_s, double electrons_at_white,
            std::span<double> samples);

/// After noise: adds each photosite's offset. `counts_at_full` is white - black.
void add_black_pattern(std::span<const PhotositeDefect> photosites, double counts_at_full,
                       std::span<double> samples);

}  // namespace weft::simulator
