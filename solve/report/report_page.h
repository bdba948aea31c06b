// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "report/page.h"
#include "solve/report/report_facts.h"

namespace weft::solve {

/// The page of a report (weft.solve-report/1): one HTML file with its style, charts and pictures inside, no
/// scripts, for a screen and for paper. What the report lacks the page leaves out. Only the section whose id
/// is "time" depends on its seconds.
std::string report_page(const SolveReportFacts& report, const std::vector<report::Figure>& pictures);

}  // namespace weft::solve
