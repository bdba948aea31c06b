// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/describe/fields.h"
#include "core/rig/session.h"

namespace weft {

enum class Grade {
  kUnfinished,  ///< not all was photographed
  kAgain,       ///< to be taken again: nobody can use it
  kUsable,
  kGood
};
inline constexpr std::array kGradeNames = {"unfinished", "take it again", "usable", "good"};

/// What a scan is worth, in one line, and the one thing to do about it.
struct ScanVerdict {
  Grade grade = Grade::kGood;
  std::string says = {};    ///< "0.77 degrees on 99 % of the cloth"
  std::string action = {};  ///< an imperative phrase; empty: nothing is to do

  friend bool operator==(const ScanVerdict&, const ScanVerdict&) = default;
};
void describe(Fields& fields, ScanVerdict& verdict);

/// "good: 0.77 degrees on 99 % of the cloth"; "take it again: All 10 LEDs are over: ...; scan again ...".
std::string words_of(const ScanVerdict& verdict);

/// What the scan warned of at this shot.
std::vector<std::string> warnings_of(const Shot& shot);
/// What its exposure is to be warned of (core/rig/exposed.h), then what the scan warned of at shots that
/// count. Of those that differ in their numbers alone the first is told, with the LEDs of the others.
std::vector<std::string> warnings_of(const Session& session);

/// "All 10 LEDs are over; scan again" in its two parts.
ScanVerdict verdict_of_warning(Grade grade, const std::string& warning);
/// By what its photographs say of themselves, whether or not they are all there.
ScanVerdict verdict_of_photographs(const Session& session);

}  // namespace weft
