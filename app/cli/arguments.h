// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

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
};

struct SolveArguments {
  SessionOptions session;
  PhotoOptions photos;
  SolveOptions options;
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

struct BenchEffectsArguments {
  double megapixels = 1;
  bool rays = false;
  bool embree = false;
  bool choice = false;            ///< --auto
  std::filesystem::path gallery;  ///< folder; empty: no pictures
};

struct DemoArguments {
  std::filesystem::path output = "demo";
  std::optional<double> megapixels;
  std::filesystem::path scene;
};

struct Arguments {
  CommonArguments common;
  std::variant<SimulateArguments, SolveArguments, CompareArguments, BenchSolveArguments,
               BenchEffectsArguments, DemoArguments>
      verb;
};

/// Reads the command line. Without a verb to run (--help, a usage error) it has printed what there is to say
/// and leaves the exit code in `exit_code`.
std::optional<Arguments> parse_arguments(int argc, char** argv, int& exit_code);

}  // namespace weft::app
