// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "report/preview.h"

// The house style of reports: pages that need no other file, no scripts, for a screen and for paper. Text is
// escaped by the caller (core/text.h) except for titles.

namespace weft::report {

/// A whole page around `body`.
std::string html_page(std::string_view title, std::string_view body);

std::string html_section(std::string_view title, std::string_view body, std::string_view id = "");

/// "#rrggbb"
std::string css_colour(Colour colour);

}  // namespace weft::report
