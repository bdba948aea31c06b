// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/image/raw_frame.h"
#include "core/rig/albedo_scale.h"
#include "core/rig/camera.h"
#include "core/rig/fixed_point.h"
#include "core/rig/lateral_color.h"
#include "core/rig/lights.h"
#include "core/rig/point_spread.h"

namespace weft {

/// What a shot of one exposure time gathers over what another one does, as measured: shutters do not keep
/// their word.
struct ExposureRatio {
  double exposure_us = 0;
  double to_exposure_us = 0;
  double ratio = 1;  ///< light at exposure_us / light at to_exposure_us

  friend bool operator==(const ExposureRatio&, const ExposureRatio&) = default;
};

/// Veiling glare (ISO 9358): what the lens scatters over the frame of all the light that it takes in. Each
/// point's goes by a Gaussian; light from beyond the frame counts as that within, so even light has `share`
/// of itself everywhere.
struct Veil {
  double share = 0;        ///< of the light, 0 to 0.2
  double sigma_share = 0;  ///< its standard deviation
  double spread = 0.5;     ///< of the Gaussian, frame diagonals, 0.05 to 10; assumed, not measured

  friend bool operator==(const Veil&, const Veil&) = default;
};

/// What counts mean in the files that a response was measured on, and where the sensor itself begins and
/// ends.
struct CountLevels {
  std::array<double, 4> black = {};     ///< as those files say, of the filter cell by rows
  double white = 0;                     ///< as those files say
  std::array<double, 3> dark_rgb = {};  ///< without light: medians of dark shots, else black
  std::vector<double> full_rgb =
      {};  ///< where each channel stops, 0 of one that was not seen to; empty: none was

  /// Whether a frame's file says the same levels.
  bool are_of(const RawFrame& frame) const;
  friend bool operator==(const CountLevels&, const CountLevels&) = default;
};

/// How counts follow light: variance of one reading and departure from a straight line.
struct Response {
  double electrons_per_count = 1;  ///< photon noise: variance of s counts of light is s / electrons_per_count
  double read_noise_counts = 0;    ///< standard deviation without light, rounding to whole counts included
  /// lin_c(v) = v * (1 + a v + b v^2) for v = (count - black) / (white - black); {a, b} by channel.
  std::array<std::array<double, 2>, 3> linearity = {};
  std::vector<ExposureRatio> exposure_ratios = {};  ///< at one ISO and aperture
  std::optional<double> black_counts = {};  ///< measured, where the file's own level is not to be trusted
  std::optional<double> iso = {};           ///< of the frames it was measured on
  std::optional<CountLevels> levels = {};   ///< of the files it was measured on
  std::optional<Veil> veil = {};            ///< of the lens, taken from readings (core/rig/veil.h)

  /// The measured ratio between two exposure times (by same_setting()), whichever way it was measured.
  std::optional<double> exposure_ratio(double exposure_us, double to_exposure_us) const;
  /// Exposure times whose ratio to this one was measured, rising.
  std::vector<double> exposures_beside(double exposure_us) const;
  friend bool operator==(const Response&, const Response&) = default;
};

/// What everything in a calibration holds for.
struct CalibrationSubject {
  std::string rig;
  std::string camera_model;
  std::string camera_serial;
  double f_number = 0;
  AlbedoScale albedo_scale = AlbedoScale::kRelative;
  std::string measured = {};   ///< when, ISO 8601; empty where nobody said
  double focal_length_mm = 0;  ///< that the lens was set to; 0 where nobody said
};
void describe(Fields& fields, CalibrationSubject& subject);

/// A square tag that stays on the table beside the cloth.
struct Fiducial {
  std::string dictionary;  ///< as OpenCV names it
  int id = 0;
  std::array<Vec3, 4> corners_mm;  ///< rig frame; upper left of the upright tag first, then clockwise

  friend bool operator==(const Fiducial&, const Fiducial&) = default;
};

/// Affine, then a cubic by channel, then affine, in xyY (seed 004, "Calibrating Albedo"). The affine maps are
/// 3 x 4 by rows; a cubic is c0 + c1 t + c2 t^2 + c3 t^3, four numbers a channel.
struct ColorCurve {
  std::array<double, 12> before = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  std::array<double, 12> cubic = {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
  std::array<double, 12> after = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

  friend bool operator==(const ColorCurve&, const ColorCurve&) = default;
};

/// What makes linear Rec.709 of solved albedo in the camera's own channels.
struct ColorTransform {
  Mat3 rec709_from_camera = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< rows sum to 1: white stays white
  std::vector<double> covariance;   ///< 9 x 9 by rows, of its entries by rows; empty where unknown
  std::optional<ColorCurve> curve;  ///< in place of the matrix

  friend bool operator==(const ColorTransform&, const ColorTransform&) = default;
};

/// Everything measured about a rig, immutable, named by its content.
struct Calibration {
  std::string id;  ///< SHA-256 of the sorted (name, SHA-256) list of calibration.json and its parts
  CalibrationSubject subject;
  std::optional<CameraModel> camera;
  std::optional<ParameterCovariance> camera_covariance;  ///< of camera.json
  std::vector<Fiducial> fiducials;                       ///< of camera.json
  std::optional<PointSpread> spread;                     ///< of camera.json
  std::optional<LateralColor> lateral;                   ///< of camera.json
  std::optional<Response> response;
  std::optional<ColorTransform> color;
  std::optional<Lights> lights;
  std::vector<WhitePatch> patches;                      ///< of lights.json
  std::vector<FixedPoint> points;                       ///< of lights.json
  std::optional<ParameterCovariance> light_covariance;  ///< of lights.json, where they are near
  std::optional<std::filesystem::path> hot_picture;  ///< the part hot.png, checked but not read: 8-bit grey
                                                     ///< on the active area, a bad photosite is not 0
};

/// Reads a calibration folder: calibration.json (schema weft.calibration/1) and its parts camera.json,
/// response.json, color.json, lights.json, hot.png, each checked against the SHA-256 that calibration.json
/// names.
Result<Calibration> read_calibration(const std::filesystem::path& folder);

/// Writes the folder, which must not be there yet, with a copy of `hot_picture`, and returns the calibration
/// with its id.
Result<Calibration> write_calibration(const std::filesystem::path& folder, Calibration calibration);

struct NamedFile {
  std::string name;
  std::string bytes;
};

/// A new calibration, which must not be there yet: the parts and the subject of `change`; every other part of
/// the calibration `from` (empty: there is none) byte by byte, fields of its calibration.json that this
/// version does not know, its reports too (but for maps of LEDs where these files are of new lights); and in
/// report/ these files. It is made aside: after an error there is nothing. `change.subject.measured` is the
/// time now unless it is given.
Result<Calibration> derive_calibration(const std::filesystem::path& from, Calibration change,
                                       const std::filesystem::path& folder,
                                       std::span<const NamedFile> report);

}  // namespace weft
