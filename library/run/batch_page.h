// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/solve/verdict.h"
#include "library/run/change_pictures.h"
#include "library/run/merge_batch.h"
#include "report/page.h"

namespace weft::library {

/// What is to be said first of a batch, the gravest first: what is missing, what failed, which calibration
/// became worse, which sessions did.
std::vector<Verdict> verdicts_of(const BatchState& state);

/// Its tables: what was done, by cause, by calibration, and the change from the solve before by session,
/// those that are worse first.
std::vector<report::Section> sections_of(const BatchState& state);

/// One page that needs no other file.
std::string batch_page(const BatchState& state, const std::vector<DrawnChange>& drawn);

}  // namespace weft::library
