// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capture/devices.h"
#include "capture/scan/meter.h"
#include "capture/scan/scan.h"
#include "capture/scan/shooter.h"
#include "core/base/result.h"

namespace weft::capture {

/// One photograph of a series.
struct SeriesShot {
  std::string name;       ///< of its file in the series' folder, without ending: "led01/000012500us_a"
  std::vector<int> leds;  ///< lit together, from 1; at most two; none: dark
  double exposure_us = 0;
};

/// Single photographs for a calibration, with the light, the recovery and the checks that a scan's have. All
/// calls: the errors of scan(), of which there is no evidence by light; what was taken stays. An exposure is
/// the camera's own that is nearest; kUsage where it lies beyond all of them.
class Series {
 public:
  /// The folder is there; a file that is there is never written over.
  Series(std::filesystem::path folder, double iso, double f_number, Lamps& lamps, Camera& camera,
         const ScanEvents& events, const ScanControl& control, const ScanOptions& options = {});
  ~Series();
  Series(const Series&) = delete;
  Series& operator=(const Series&) = delete;

  Result<void> connect();

  /// The exposure, of those that the camera has, at which the brightest photosites come to kMeteredTo, under
  /// the brightest of these lights: groups of LEDs lit together. kBadData where there is none.
  Result<double> metered_us(const std::vector<std::vector<int>>& lights, double start_us);
  /// The camera's own time that is nearest to this share of another.
  double share_of_us(double exposure_us, double share) const;

  /// Takes one; its file has the ending of the camera's format.
  Result<Photograph> take(const SeriesShot& shot);
  /// Takes those of which there is no file yet, telling how many of them there are.
  Result<void> take_missing(const std::vector<SeriesShot>& shots);

 private:
  Result<Photograph> shoot(const SeriesShot& shot);

  std::filesystem::path folder_, aside_;
  double iso_, f_number_;
  ScanControl control_;
  ScanOptions options_;
  ScanEvents events_;
  PolariserUse no_film_;
  Report report_;
  Shooter shooter_;
  std::vector<double> shutter_times_us_;
};

/// The file of a series' photograph, with whatever ending; empty: it is not there.
std::filesystem::path file_of(const std::filesystem::path& folder, const std::string& name);

}  // namespace weft::capture
