// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/albedo_scale.h"
#include "core/json_document.h"
#include "pipeline/gloss.h"
#include "report/page.h"

// What a solve found of a cloth's reflectance, for reflectance.json, solve.json and people.

namespace weft::app {

/// reflectance.json, schema weft.reflectance/1.2 (docs/formats.md). Where the scale of the albedo is relative
/// so is f0, and what is said is f0 over the albedo.
Json reflectance_document(const pipeline::GlossFacts& facts, AlbedoScale scale);

/// What solve.json says of it: `said`, `share`, and of a measured lobe `family`, `alpha`, `alpha_along`,
/// `alpha_broad` and `broad_share`, `f0` or `f0_over_albedo`, and with a tint `tint` and `f0_rgb`.
Json reflectance_summary(const Json& document);

/// The lobes of a summary in words; empty where none is measured.
std::string lobes_in_words(const Json& summary);
/// The same with the share of the frame that is solved with them.
std::string reflectance_words(const Json& summary);

/// What report.json says of it in words: `used`, and `says`, the lobes or why there is none.
Json reflectance_said(const Json& document);

/// The section of a report: the lobe drawn over the readings, and its numbers. Empty of null.
report::Section reflectance_section(const Json& document);

}  // namespace weft::app
