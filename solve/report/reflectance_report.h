// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/rig/albedo_scale.h"
#include "core/solve/solve_parts.h"
#include "report/page.h"
#include "solve/gloss/gloss.h"
#include "solve/report/reflectance_facts.h"

// What a solve found of a cloth's reflectance, for reflectance.json, solve.json and people.

namespace weft::solve {

/// Where the scale of the albedo is relative so is f0, and what is said is f0 over the albedo.
ReflectanceFacts reflectance_facts(const GlossFacts& facts, AlbedoScale scale);

/// What solve.json says of it.
ReflectanceSummary summary_of(const ReflectanceFacts& facts);

/// The lobes of a summary in words; empty where none is measured.
std::string lobes_in_words(const ReflectanceSummary& summary);
/// The same with the share of the frame that is solved with them.
std::string reflectance_words(const ReflectanceSummary& summary);

/// What report.json says of it in words: the lobes, or why there is none.
GlossSaid reflectance_said(const ReflectanceFacts& facts);

/// The section of a report: the lobe drawn over the readings, and its numbers. Empty of none.
report::Section reflectance_section(const std::optional<ReflectanceFacts>& facts);

}  // namespace weft::solve
