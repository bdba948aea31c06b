// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

// What a scene says about the shape of the cloth: plain values.

namespace weft::simulator {

/// The shapes that a cloth can have.
enum class GeometryKind {
  kFlat,
  kTilted,
  kPlain,
  kTwill,
  kSatin,
  kKnit,
  kSphere,
  kCylinder,
  kHeightMap,
};

/// Whether the cloth has warp and weft.
constexpr bool is_woven(GeometryKind kind) {
  return kind == GeometryKind::kPlain || kind == GeometryKind::kTwill || kind == GeometryKind::kSatin;
}

/// Where a picture lies on the table: its centre at `offset`, its x axis turned by `rotation_deg` from x
/// towards y, its first row at the top.
struct PicturePlacement {
  double mm_per_sample = 0.1;
  double offset_x_mm = 0;
  double offset_y_mm = 0;
  double rotation_deg = 0;
  bool repeats = true;  ///< in both directions; else the table beyond it has no picture

  bool operator==(const PicturePlacement&) const = default;
};

/// Parallel folds, `wavelength_mm` apart, the crest of one through the table's centre: the height varies
/// along `direction_deg`, from x towards y, as amplitude exp(sharpness (cos(2 pi s / wavelength) - 1)).
/// A crest is nearly Gaussian, of standard deviation wavelength / (2 pi sqrt(sharpness)).
struct Fold {
  double amplitude_mm = 1;
  double wavelength_mm = 40;
  double direction_deg = 0;
  double sharpness = 4;

  bool operator==(const Fold&) const = default;
};

/// A slow wave: amplitude sin(2 pi s / wavelength + phase), s along `direction_deg`.
struct Wave {
  double amplitude_mm = 0.5;
  double wavelength_mm = 100;
  double direction_deg = 0;
  double phase_deg = 0;

  bool operator==(const Wave&) const = default;
};

/// The shape of the cloth. Lengths without unit are in yarn pitches, so that slopes do not depend on scale.
struct GeometrySettings {
  GeometryKind kind = GeometryKind::kFlat;
  double cloth_height_mm = 0;  ///< of the plane that the cloth's heights are measured from, above the table

  double tilt_deg = 20;    ///< kTilted: between the normal and z
  double azimuth_deg = 0;  ///< from x towards y: kTilted: of the normal's horizontal part; kCylinder: axis

  double warp_pitch_mm = 0.5;  ///< from one warp yarn (along y) to the next
  double weft_pitch_mm = 0.5;  ///< from one weft yarn (along x) to the next
  /// Warp yarn i lies over weft yarn j where (j - step * i) mod (over + under) < over.
  std::optional<int> over;   ///< else 1, 2, 4 for plain, twill, satin
  std::optional<int> under;  ///< else 1, 2, 1
  std::optional<int> step;   ///< else 1, 1, 2
  double crimp = 0.08;       ///< amplitude of a yarn's axis as it goes over and under
  double flank_deg = 36;     ///< slope of a yarn's flank where it meets its neighbour, half a pitch from its
                             ///< axis
  double twist_relief = 0;   ///< amplitude of the ridges that the plies of a yarn make
  double flatness = 0;       ///< share of a yarn's width that is flat on top (racetrack section, Kemp 1958)
  double fibre_relief = 0;   ///< no fibre rises or sinks by more than this
  double fibre_spacing = 0.08;  ///< between fibres, across the yarn
  double fibre_angle_deg = 20;  ///< between fibres and the yarn's axis
  std::int64_t fibre_seed = 1;  ///< from 0

  double wale_mm = 1;           ///< kKnit: from one column of loops to the next (x)
  double course_mm = 0.75;      ///< kKnit: from one row of loops to the next (y)
  double yarn_diameter = 0.45;  ///< kKnit: in wales
  double loop_flank_deg = 60;   ///< kKnit: slope of a yarn where its section stops being round

  double radius_mm = 20;    ///< kSphere, kCylinder
  double contact_deg = 85;  ///< kSphere, kCylinder: slope where the body meets the table

  std::shared_ptr<const Image<float>> heights_mm;  ///< kHeightMap: one plane
  std::string heights_file;                        ///< where they were read, absolute; empty: from no file
  PicturePlacement height_map;

  std::vector<Fold> folds;  ///< added to any kind
  std::vector<Wave> waves;  ///< added to any kind

  bool operator==(const GeometrySettings&) const = default;
};

/// Three plain weaves with the slopes, shadows and openness that the research measured its bars on: mean
/// slope 7, 19 and 36 degrees; 0, under 1 and 19 percent of readings in shadow under the ten default LEDs;
/// 1 - mean openness 0.009, 0.063 and 0.206.
enum class Family { kSmooth, kPlain, kDeep };
GeometrySettings family_settings(Family family);

/// Refuses, as kBadData, a height map without heights, of more than one plane or not finite.
Result<void> check_heights(const GeometrySettings& geometry);

}  // namespace weft::simulator
