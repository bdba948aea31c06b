// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "virtual_rig/board/lit_log.h"
#include "virtual_rig/light/light_faults.h"
#include "virtual_rig/light/light_frames.h"
#include "virtual_rig/ptp/virtual_camera.h"

namespace weft::virtual_rig {

/// Counts at which red, green and blue stop, whatever white a file says; 0: at white.
using StopCounts = std::array<std::uint16_t, 3>;

/// What a sensor is exposed to, and what it draws its noise by.
struct GatheredLight {
  std::vector<double> leds_s;  ///< seconds of each LED's full light
  double ambient_s = 0;        ///< of LightFrames::ambient()
  /// What each row gets of either, over that; empty where light is steady.
  std::vector<double> leds_by_row = {}, ambient_by_row = {};
  double below_s = 0;  ///< of the light below the cloth
  /// What the cloth scatters alone, behind both films, where there is a polariser and the cloth has gloss.
  const LightFrames* matt = nullptr;
  double leds_share = 1;        ///< of a LED's light that comes through the films
  double matt_share = 0;        ///< of its light in `matt`, besides
  double dark_s = 0;            ///< seconds in which charge gathers by warmth
  bool loses_its_dark = false;  ///< the body takes a dark picture as long and subtracts it
  double iso = 100;
  double aperture_gain = 1;     ///< light of this aperture over that of the scene's
  std::uint32_t noise_key = 0;  ///< the same light under the same key gives the same counts
  int move_x = 0;               ///< LightFaults
  int move_y = 0;
  StopCounts stops = {};
};

/// Share of the time between the two that each LED's pin was on for. A pin that was on throughout counts 1
/// exactly, however long that was: shutters of a virtual camera are never late.
std::vector<double> lit_shares(const LitLog& pins, RigClock::time_point from, RigClock::time_point to,
                               int leds);

/// What an exposure gathers that opens while pins are on for these shares of it.
GatheredLight gathered_light(const LightFrames& frames, const std::vector<double>& pin_shares,
                             const LightFaults& faults, const CameraExposure& exposure);

/// Adds what the outputs of a rig with more than LEDs do to an exposure, by the shares of it that they were
/// on for. Cloth lets a twentieth of the light below through, evenly. Films are perfect but for a hundredth:
/// what the cloth scatters loses half of the light at each, what it mirrors half at the first alone where
/// they are parallel, and nearly all where they are crossed (simulator::FilmSettings).
void add_light_below(GatheredLight& light, double pin_share, const CameraExposure& exposure);
void add_films(GatheredLight& light, double crossed_share, const LightFrames* matt);

/// What the photosites read: sum of light, charge, bloom, noise, non-linearity and converter as the scene
/// names them, by the same arithmetic and with the same random numbers as a simulated session's take
/// `noise_key`. `threads`: 0 for all the machine has; changes no byte. Beyond the frame nothing blooms.
Image<std::uint16_t> read_out(const LightFrames& frames, const GatheredLight& light, int threads = 0);

/// The signal that read_out() starts from, 1 at full scale: without noise and before anything clips.
Image<double> signal_of(const LightFrames& frames, const GatheredLight& light);

/// The exposure as DNG.
Result<std::vector<std::uint8_t>> develop(const LightFrames& frames, const GatheredLight& light,
                                          const CameraExposure& exposure, const std::string& serial,
                                          int threads = 0);

}  // namespace weft::virtual_rig
