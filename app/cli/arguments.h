// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/cli/calibrate_arguments.h"
#include "app/cli/rig_arguments.h"
#include "app/jobs/explain.h"
#include "app/jobs/rectify.h"
#include "app/jobs/solve.h"

namespace weft::app {

/// What every verb understands.
struct CommonArguments {
  bool json = false;    ///< one JSON document on standard output
  bool quiet = false;   ///< no progress
  bool strict = false;  ///< exit code 2 where there were warnings
  int threads = 0;      ///< 0: all the machine has
};

struct SimulateArguments {
  std::filesystem::path scene;
  std::filesystem::path output;
  std::optional<int> led;  ///< one frame alone: a LED from 1, or 0 for the dark shot
  bool explain = false;
  bool captures = false;           ///< what calibrating the scene's rig needs, instead of one scan
  std::vector<std::string> parts;  ///< of it; empty: all
};

struct SolveArguments {
  SessionOptions session;
  PhotoOptions photos;
  SolveOptions options;
  bool explain = false;
  LevelWish wish;
  std::filesystem::path ladder;  ///< a picture of all levels, instead of one solve
};

struct CompareArguments {
  std::filesystem::path tested, truth, mask;
  bool albedo = false;
};

struct BenchSolveArguments {
  double megapixels = 4;
  bool exact = false;
  bool noise = false;
  bool order = false;
  bool end_to_end = false;
};

struct BenchHeightArguments {
  double megapixels = 4;
};

struct BenchTransportArguments {
  double megapixels = 1;
};

struct BenchEffectsArguments {
  double megapixels = 1;
  bool rays = false;
  bool embree = false;
  bool choice = false;            ///< --auto
  std::filesystem::path gallery;  ///< folder; empty: no pictures
};

struct BenchNumericsArguments {
  bool curve = false;          ///< error against condition number, not the cases
  std::filesystem::path docs;  ///< folder; empty: print
  std::filesystem::path scenes = "testdata/scenes";
};

struct BenchAccuracyArguments {
  bool quick = false;
  bool tuning = false;  ///< the scenes to tune on, not those held out
  std::string scene;    ///< one alone; empty: all
  std::vector<std::string> methods;
  bool bound = false;
  bool leds = false;
  bool specular = false;
  std::filesystem::path docs;  ///< folder with accuracy.md; empty: no page
};

struct BenchExplainArguments {
  bool quick = false;
  bool tuning = false;
};

struct BenchPhotosArguments {
  std::filesystem::path folder;
  int pick = 10;
  int subsets = 20;
  std::uint32_t seed = 1;
  std::vector<std::string> methods;
};

struct BenchRegistrationArguments {};

struct BenchCalibrationArguments {
  std::string part = "camera";
  int seeds = 0;               ///< 0: as many as the part is quoted for
  std::filesystem::path docs;  ///< folder with calibration.md; empty: no picture
};

struct BenchCaptureArguments {
  std::string part = "scans";  ///< board, camera, scans: of a running rig; faults, http: of what it starts
  std::filesystem::path rig;
  int runs = 0;  ///< commands, shots, scans, runs or requests; 0: as many as docs/reliability.md
  std::filesystem::path scene = "testdata/scenes/satin.toml";
  double megapixels = 0.2;
  int rigs = 16;
  std::uint64_t seed = 1;
  std::vector<std::string> faults;
  std::filesystem::path keep;
};

struct DemoArguments {
  std::filesystem::path output = "demo";
  std::optional<double> megapixels;
  std::filesystem::path scene;
};

struct Arguments {
  CommonArguments common;
  std::variant<SimulateArguments, CalibrateArguments, SolveArguments, CompareArguments, RectifyOptions,
               BenchSolveArguments, BenchTransportArguments, BenchEffectsArguments, BenchHeightArguments,
               BenchNumericsArguments, BenchAccuracyArguments, BenchExplainArguments, BenchPhotosArguments,
               BenchRegistrationArguments, BenchCalibrationArguments, BenchCaptureArguments, DemoArguments,
               ServeArguments, ScanArguments, RigArguments, DoctorArguments, CopyArguments>
      verb;
};

/// Reads the command line. Without a verb to run (--help, a usage error) it has printed what there is to say
/// and leaves the exit code in `exit_code`.
std::optional<Arguments> parse_arguments(int argc, char** argv, int& exit_code);

}  // namespace weft::app
