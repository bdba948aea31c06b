// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/describe/fields.h"
#include "core/rig/cloth_pose.h"

// What solve.json says of a solve, part by part (docs/formats.md).

namespace weft {

void describe(Fields& fields, ClothPose& pose);

/// A photograph that a solve was made from.
struct SolvedShot {
  int led = 0;
  std::string file, sha256;
  std::optional<double> exposure_us = {}, iso = {}, f_number = {};  ///< none in early documents

  friend bool operator==(const SolvedShot&, const SolvedShot&) = default;
};

/// A photograph under a distant light.
struct DistantPhotograph {
  std::string file, sha256;
  Vec3 direction;  ///< to the light
  std::array<double, 3> irradiance_rgb = {};
  std::optional<double> distance_mm = {};  ///< of a near light, from the middle of the picture

  friend bool operator==(const DistantPhotograph&, const DistantPhotograph&) = default;
};
void describe(Fields& fields, DistantPhotograph& photograph);

/// All that the id depends on besides method and compression. Of a session of a rig the first fields, else
/// those from `photographs` on.
struct SolveInput {
  std::optional<std::string> session = {}, calibration = {};  ///< fabric, and the calibration's id
  std::optional<double> cloth_height_mm = {};
  std::vector<SolvedShot> shots = {};
  std::optional<ClothPose> pose = {};  ///< of a cloth that does not lie flat
  std::vector<DistantPhotograph> photographs = {};
  std::string transfer = {}, mask = {};  ///< by name; SHA-256
  std::optional<int> orientation = {};   ///< that they were turned by; none: as they are stored
  std::string flip = {};                 ///< what was done to directions of lights; empty: nothing
  std::string dark = {};                 ///< SHA-256 of the one with all lamps off
  std::optional<double> ambient = {};    ///< light that was taken from all, a share of full scale
  std::optional<double> mm_per_pixel = {}, fov_deg = {};  ///< of the cloth, of the picture's width
  Json second_pose = {};                                  ///< a SolveInput; null: there was none

  friend bool operator==(const SolveInput&, const SolveInput&) = default;
};
void describe(Fields& fields, SolveInput& input);

struct ConditionedLed {
  int led = 0;
  double factor = 1;  ///< brightness over the calibration's
  std::string from;   ///< "patches" or "repeat"
};
struct UnusedLed {
  int led = 0;
  std::string why;  ///< "saturated", "not lit", "fits nothing" or "moved"
};
void describe(Fields& fields, UnusedLed& led);
struct ClothGain {
  int led = 0;
  double factor = 1, sigma = 0;
};
/// How bright LEDs were by what the cloth tells.
struct ClothGains {
  std::vector<ClothGain> leds;
  double misfit_before = 0, misfit_after = 0;    ///< of the readings, a share
  double left_out_gain = 0, left_out_sigma = 0;  ///< by which left-out light is predicted better
};
/// How one frame fits the others.
struct FrameFitFacts {
  int led = 0;
  double missed = 0, sigma = 0;     ///< of what the others predict, and by noise: shares of the brightness
  std::optional<double> rows;       ///< by which its light rises and falls along rows, a share
  std::vector<int> part;            ///< of the frame that does not fit: x0, y0, x1, y1; empty: none
  std::optional<double> costs_deg;  ///< by which it turns the normals, left alone
};
/// Light that flickers while the shutter goes over the sensor.
struct RowFlickerFacts {
  double period_rows = 0;  ///< rows of pixels from crest to crest
  double hertz = 0;        ///< 0: nobody knows how fast the shutter goes over the rows
  double sigma = 0;        ///< of FrameFitFacts::rows
  double costs_deg = 0;    ///< by which it turns the normals, left alone; 0 where it was left as it is
};
/// Light that frames have and their dark shot lacks, or the other way round.
struct RoomLightFacts {
  double share = 0, sigma = 0;  ///< of the mean reading
  double costs_deg = 0, costs_albedo = 0;
};
/// How cloth spreads the light that enters it.
struct ClothSpreadFacts {
  std::string said = "given";          ///< by a person; "measured" or "not_observable" in a blade's
                                       ///< shadow; "told" by the cloth itself
  double share = 0;                    ///< of the light that leaves elsewhere
  std::optional<double> mean_mm = {};  ///< how far away; none where it is not observable, or
                                       ///< nothing says how large a pixel is
  std::optional<double> mean_px = {};  ///< the same, where it was undone
  std::optional<double> share_sigma = {}, mean_sigma_mm = {};  ///< of what was measured or told
  std::optional<int> led = {};                                 ///< that threw the blade's shadow
};
/// What was found in the frames and corrected (docs/conditions.md).
struct ConditionFacts {
  std::optional<int> hot_photosites;  ///< of raw frames
  std::optional<double> veil;         ///< share of the light that was taken off
  int brackets = 0;                   ///< shots that were joined
  std::vector<UnusedLed> left_out;
  std::vector<ConditionedLed> drift;
  std::optional<ClothGains> cloth_gains;
  std::vector<FrameFitFacts> frames;
  std::optional<RowFlickerFacts> flicker;
  std::optional<RoomLightFacts> room;
  std::optional<ClothSpreadFacts> cloth_spread;  ///< that was undone, or cannot be observed
};
void describe(Fields& fields, ConditionFacts& conditions);

/// Middle and upper end of angles.
struct AngleMiddle {
  double median = 0, p95 = 0;  ///< degrees
};
void describe(Fields& fields, AngleMiddle& angles);

/// The angle that sigma.exr predicts, and its parts.
struct SigmaFacts {
  std::optional<double> median = {}, p95 = {};  ///< degrees; none where no pixel has one
  std::optional<AngleMiddle> noise = {}, model = {}, calibration = {};
  std::optional<double> solved = {};  ///< share of the cloth that has a normal, which they hold for
};
void describe(Fields& fields, SigmaFacts& sigma);

/// What was undone of the lens's spread.
struct SharpeningFacts {
  std::array<double, 3> sigma_px = {};  ///< of the blur, by colour
  double share = 0;                     ///< of the correction that noise allowed, mean over the frame
};
void describe(Fields& fields, SharpeningFacts& sharpening);

struct LateralColorFacts {
  std::array<double, 2> corner_px = {};  ///< by which red and blue look farther out than green
};
void describe(Fields& fields, LateralColorFacts& color);

/// By how much left-out light is predicted better.
struct LeftOutGain {
  double gain = 0, sigma = 0;  ///< shares of the brightness
  std::int64_t patches = 0;
};
struct StageGain {
  std::string stage;
  LeftOutGain by;
  bool is_kept = false;
};
struct RoundFacts {
  double turned_deg = 0;
  std::vector<std::string> stages;
  std::optional<double> albedo_scale, slope_residual_rms;  ///< none in early documents
  bool is_refused = false;
};
/// What the level `reference` took out.
struct ReferenceLevelFacts {
  std::vector<std::string> stages;
  std::vector<RoundFacts> rounds;
  std::vector<StageGain> left_out;
  bool albedo_scale_is_open = false;
  std::string published;  ///< "robust" or "reference"; empty in early documents
  std::optional<LeftOutGain> over_robust;
  bool shadow_reach_is_capped = false;
};
void describe(Fields& fields, ReferenceLevelFacts& reference);

/// A lobe in numbers; those that its family has.
struct LobeFacts {
  std::string said;    ///< "measured", or why there is none
  std::string family;  ///< empty: none was measured
  std::optional<double> alpha = {}, alpha_along = {}, alpha_broad = {}, broad_share = {};
  std::optional<double> f0 = {}, f0_over_albedo = {};
  std::vector<double> f0_rgb = {}, tint = {};  ///< empty: highlights have no colour of their own
};
/// What looking for the cloth's lobe came to.
struct ReflectanceSummary {
  LobeFacts lobe;
  double share = 0;                      ///< of the blocks that are solved with it
  std::optional<LobeFacts> second = {};  ///< of a second material
};
void describe(Fields& fields, ReflectanceSummary& summary);

}  // namespace weft
