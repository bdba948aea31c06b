// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

// Times as documents hold them, ISO 8601.

namespace weft {

/// "2026-11-21T14:25:01.250Z", of seconds since 1970.
std::string iso_time(double since_1970_s);

/// Now, by the clock of this computer.
double seconds_since_1970();

/// "2026-11-21T14:25:01Z": now, to the second.
std::string iso_time_now();

/// Seconds since 1970 of "2026-11-21T14:25:01", with or without a fraction and a zone ("Z", "+01:00"). A time
/// without a zone is taken for UTC. Nothing where the text is no such time.
std::optional<double> seconds_of_iso_time(const std::string& text);

}  // namespace weft
