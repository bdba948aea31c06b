// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>

#include "bench/base/report.h"
#include "core/process.h"
#include "core/result.h"

namespace weft::bench {

/// What is asked of a study. `weft bench` puts the study's own numbers where 0 is.
struct StudyOptions {
  double megapixels = 0;
  int runs = 0;  ///< what it repeats: seeds, trials, shots, sessions
  std::uint64_t seed = 1;
  int threads = 0;                                   ///< 0: all the machine has
  std::filesystem::path scenes = "testdata/scenes";  ///< folder of the example scenes
  std::filesystem::path scene = {}, rig = {};        ///< files, where the study asks for one
  std::filesystem::path programs = program_beside("weft").parent_path();
  std::stop_token stop = {};
  std::function<void(int done, int of)> progress = [](int, int) {};
};

/// A table of `weft bench`.
struct Study {
  std::string name, what;  ///< as --help has them
  std::function<Result<Rows>(const StudyOptions&)> measure;
  StudyOptions own = {};  ///< its megapixels and runs where none are asked for
};

}  // namespace weft::bench
