// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "core/rig/albedo_scale.h"
#include "core/rig/camera.h"
#include "core/rig/lateral_color.h"
#include "core/rig/light_field.h"
#include "core/rig/lights.h"
#include "core/rig/photosites.h"
#include "core/rig/point_spread.h"
#include "core/rig/radiometry.h"
#include "core/rig/veil.h"
#include "core/solve/solve_parts.h"
#include "core/solve/verdict.h"
#include "solve/photographs/gloss_samples.h"
#include "solver/method.h"

namespace weft::solve {

/// The planes of readings that a photograph has: one mosaic with the filters `cfa`, or R, G and B.
struct Planes {
  int count = 3;        ///< 1 or 3
  CfaPattern cfa = {};  ///< of a mosaic

  /// The colour that a plane has at a pixel of the frame: 0 red, 1 green, 2 blue.
  int channel_at(int plane, int x, int y) const { return count == 1 ? cfa.channel_at(x, y) : plane; }
  /// The plane that speaks for a pixel where one has to: a mosaic's own, else green.
  int speaker() const { return count == 1 ? 0 : 1; }
};

/// Linear RGB, developed by somebody else.
struct Developed {
  Developed() = default;
  explicit Developed(std::vector<Image<float>> readings, bool lie_on_disk = false)
      : rgb(std::move(readings)), are_on_disk_(lie_on_disk) {}

  std::vector<Image<float>> rgb;  ///< readings, planes R, G, B (core/rig/radiometry.h)

  std::size_t count() const { return rgb.size(); }
  Planes planes() const { return {}; }
  std::optional<NoiseModel> noise_model() const { return {}; }
  std::vector<View<const float>> readings(std::size_t k, Rect part, View<float> scratch) const;
  void erase(std::size_t k);
  /// What lies on disk leaves memory until it is read again.
  void page_out(std::size_t k) const;

 private:
  bool are_on_disk_ = false;  ///< Image::on_disk
  /// Bytes that were shown of photographs on disk since all of them were last paged out.
  std::unique_ptr<std::atomic<std::size_t>> shown_ = std::make_unique<std::atomic<std::size_t>>(0);
};

/// What is done to the readings of one frame that does not fit the others.
struct FrameMend {
  std::vector<float> row_gain;  ///< that each row is divided by; empty: none is
  std::vector<Rect> missing;    ///< has no readings
};

/// Light of each frame that had entered the cloth elsewhere, to be taken off, and the share of all light that
/// does.
struct BesideLight {
  double share = 0;
  std::vector<SpreadLight> frames;
};

/// A mosaic once more at another exposure.
struct Bracket {
  RawFrame frame;
  Radiometry radiometry;
};

/// Counts behind colour filters, all of one exposure, and what turns them into readings.
struct Mosaics {
  /// At least one frame; `dark`, where there is one, has their size.
  Mosaics(std::vector<RawFrame> mosaics, std::optional<RawFrame> dark_shot,
          const Response& response_of_camera, Radiometry::Exposure exposure_of_all);
  /// Other frames of the same camera and exposure. They lend the dark shot of these, which must outlive them.
  Mosaics alike(std::vector<RawFrame> others) const;
  /// Takes another dark shot off these.
  void set_dark(RawFrame dark_shot);
  /// Takes the dark shot of `like` off these, which must outlive them.
  void lend_dark(const Mosaics& like);

  std::vector<RawFrame> frames;
  std::optional<RawFrame> dark;
  Response response;
  Radiometry::Exposure exposure;
  Radiometry radiometry;
  NoiseModel noise;                            ///< of brackets the worst
  std::vector<std::vector<Bracket>> brackets;  ///< of each frame; empty where there are none at all
  std::vector<Photosite> replaced;             ///< sorted: their counts are what their neighbours say
  std::vector<VeilOverFrame> veils;            ///< of each frame, taken off; empty where the lens has none
  std::vector<FrameMend> mends;                ///< of each frame; empty where none needs any
  std::optional<BesideLight> beside;           ///< none: left as it is
  std::optional<Image<std::uint8_t>> inside;   ///< 1 where the cloth is; none: everywhere

  std::size_t count() const { return frames.size(); }
  Planes planes() const { return {1, radiometry.cfa()}; }
  std::optional<NoiseModel> noise_model() const { return noise; }
  std::vector<View<const float>> readings(std::size_t k, Rect part, View<float> scratch) const;
  void erase(std::size_t k);

 private:
  Mosaics(std::vector<RawFrame> others, const Mosaics& like);
  void measure_veils();
  void add_brackets(std::size_t k, Rect part, View<float> out) const;
};

using Frames = std::variant<Developed, Mosaics>;

/// Does what mends say to frames, each by its own.
void mend_frames(std::vector<FrameMend> mends, Frames& frames);

/// Takes off light that had entered the cloth elsewhere, and puts what is left over the share that enters
/// where it leaves; noise grows with it.
void take_off_beside(BesideLight beside, Frames& frames);

/// Readings of frame k over `part`, which begins on an even column: a view a plane, (0, 0) at the part's
/// corner. Those of a mosaic, with its brackets, are made in `scratch`, which is at least as large as the
/// part; developed ones are shown where they are.
std::vector<View<const float>> readings_of(const Frames& frames, std::size_t k, Rect part,
                                           View<float> scratch);

/// What was found in photographs and put right (docs/conditions.md).
struct Conditions {
  ConditionFacts facts;               ///< as solve.json has them
  std::vector<std::string> warnings;  ///< a sentence each
  std::vector<Verdict> of_frames;     ///< frames and dark shots that lie, and what was done
  std::vector<Verdict> doubts;        ///< whether lights and values are what they are taken for
  std::vector<std::string> assumed;   ///< of photographs, as of SolvePlan
  double seconds = 0;                 ///< that this took
};

/// What a solve starts from, in memory: K photographs of one cloth, photograph k lit by light k of the field
/// alone.
struct Photographs {
  Size size;
  Frames frames;
  double lobe_share = 1;  ///< as of solver::TileInput
  /// As many once more, of the same lights through parallel films, where `frames` are of crossed ones.
  std::optional<Frames> parallel;
  /// The same cloth as it lay otherwise under the same lights, as many states of films: its lobe is sought in
  /// both.
  std::optional<GlossSamples> second_pose;
  std::vector<int> leds;                                ///< number of each light in its rig, if it has one
  std::optional<LightField> field;                      ///< always there once the photographs are whole
  std::optional<CameraModel> camera;                    ///< where the lights are near
  std::optional<PointSpread> spread;                    ///< of the lens, to be undone; none: left as it is
  std::optional<LateralColor> lateral;                  ///< of the lens, to be undone where there is a camera
  std::optional<ParameterCovariance> light_covariance;  ///< where the calibration has one
  AlbedoScale albedo_scale = AlbedoScale::kRelative;
  std::array<double, 3> plane_weights = solver::kLuminance;  ///< of RGB, as of solver::TileInput
  double sigma_slope = 0;  ///< share by which solved slopes may be off, as what the cloth spreads is not sure
  std::optional<ColorTransform> color;  ///< of solved albedo, where the calibration has one
  Conditions conditions;                ///< of all of them as they were read; a part or a half has none

  std::size_t count() const;
  Planes planes() const;
  std::optional<NoiseModel> noise() const;  ///< of one reading; RGB has none
  /// The place of a LED among the lights; their number where it is not among them.
  std::size_t light_of(int led) const;
  const Mosaics* mosaics() const { return std::get_if<Mosaics>(&frames); }
  Mosaics* mosaics() { return std::get_if<Mosaics>(&frames); }
};

/// Photographs and field without these lights, from 0 and in order. Errors: as LightField::make.
Result<void> leave_out(std::span<const std::size_t> lights, Photographs& photographs);

/// Marks with INVALID_READING the pixels of `band`, as high as `status`, whose counts were replaced.
void mark_replaced(const std::vector<Photosite>& replaced, Rect band, View<std::uint16_t> status);

}  // namespace weft::solve
