// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "bench/base/study.h"
#include "bench/sanity/faults.h"

namespace weft::bench {

struct SanityOptions {
  std::string fault;   ///< one alone; empty: all
  bool lists = false;  ///< a row each set, instead of a row each fault
};

/// What became of photographs with a fault.
enum class Told { kNamed, kMended, kOtherwise, kNot };

struct SetOutcome {
  Told told = Told::kNot;
  std::string said;  ///< names of verdicts, or the error
};

/// Writes a set of this seed with the fault, and solves it as `weft solve --photos` does.
Result<SetOutcome> outcome_of(const SetFault& fault, std::uint32_t seed);

/// Photographs drawn at random with a fault each, and without: how many are named, mended, told to have
/// another one, or not told. `options.runs` sets from `options.seed` on.
Result<Rows> sanity_table(const SanityOptions& asked, const StudyOptions& options);

}  // namespace weft::bench
