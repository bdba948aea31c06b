// SPDX-License-Identifier: Apache-2.0
#include "core/solve/verdict.h"

#include <algorithm>
#include <array>

#include "core/describe/field_json.h"

namespace weft {

void describe(Fields& fields, Verdict& v) {
  fields.value({"name", "For programs", {}, kMustSay}, v.name);
  fields.value({"text", "One sentence with its numbers", {}, kMustSay}, v.text);
  fields.value({"remedy", "What to do; may be empty"}, v.remedy);
}

bool is_of_frames(const Verdict& verdict) {
  constexpr std::array kNames = {"DARK_SHOT",     "ROOM_LIGHT",         "ROWS_FLICKER",
                                 "FRAME_IN_PART", "FRAME_FITS_NOTHING", "BLADE_SHADOW"};
  return std::ranges::any_of(kNames, [&](const char* name) { return verdict.name == name; });
}

Json json_of(const std::vector<Verdict>& verdicts) {
  return list_of(verdicts);
}

}  // namespace weft
