// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <stop_token>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/process.h"
#include "core/base/result.h"

namespace weft::bench {

/// Rows of one benchmark: JSON objects with the same keys in the same order.
using Rows = std::vector<Json>;

/// Adds one, or passes on why there is none.
Result<void> add_row(Rows& rows, Result<Json> row);

/// {"machine": ..., "rows": ...}: what every `weft bench --json` prints.
Json document_of(const Rows& rows);

/// The rows as a table for people, a column a key.
std::string table_of(const Rows& rows);

/// The least wall time of `repeats` runs of body(), in seconds.
template <typename Body>
double least_seconds(int repeats, const Body& body) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repeats; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    body();
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return least;
}

/// Runs weft with these arguments, and returns what it printed. kTryAgain where it takes over four hours,
/// kInternal where it does not end well.
Result<std::string> run_weft(const std::vector<std::string>& arguments,
                             const std::filesystem::path& program = program_beside("weft"));

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
