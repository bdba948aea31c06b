// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "calibration/response/block_light.h"
#include "calibration/response/photon_transfer.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"

namespace weft::calibration {

/// Frames of the same light and exposure, as numbers.
struct ExposureFrames {
  double exposure_us = 0;
  std::vector<std::filesystem::path> files;
  BlockLight light;
  std::vector<double> brightness;  ///< of each frame that is not full: mean v of all channels
};

/// What a folder of a response capture says, frame by frame read once and not kept.
struct ResponseFrames {
  ShotMetadata camera;  ///< of all frames, but for exposure_us
  Size size;
  CfaPattern cfa;
  std::array<std::array<float, 2>, 2> file_black = {};
  double file_white = 0;
  std::array<double, 3> dark_rgb = {};  ///< counts of the dark shots, medians; 0 without them
  std::array<float, 3> full_rgb = {};   ///< counts at which each channel stops; 0: it does not
  std::map<std::vector<int>, std::vector<ExposureFrames>> by_leds;  ///< by rising exposure; {} is dark
  std::vector<std::filesystem::path> scale;                         ///< frames of the grey scale
  std::vector<std::filesystem::path> trap;                          ///< frames of a black trap in white paper
  std::vector<TransferPoint> transfer;                              ///< of all pairs of frames
  int pairs = 0;                                                    ///< of frames
  Image<std::uint8_t> bad;  ///< hot and dead photosites are 255; empty without dark frames
  int hot = 0, dead = 0;
  std::vector<std::string> full;      ///< files of frames that were left out, being full everywhere
  std::vector<std::string> warnings;  ///< folders that mean nothing here

  double mean_black() const;
  double counts_at_full() const { return file_white - mean_black(); }
  const std::vector<ExposureFrames>* of(const std::vector<int>& leds) const;
};

}  // namespace weft::calibration
