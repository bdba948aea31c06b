// SPDX-License-Identifier: Apache-2.0
#include "core/solve/left_out_facts.h"

namespace weft {

void describe(Fields& fields, LeftOutShares& s) {
  fields.value({"median", "Size of the error over the reading, a share", {}, kMustSay}, s.median);
  fields.value({"rms", "Of error / brightness of the pixel, a share", {}, kMustSay}, s.rms);
  fields.value({"noise_median", "The same as noise alone would give it"}, s.noise_median);
  fields.value({"noise_rms", "The same as noise alone would give it"}, s.noise_rms);
  fields.value({"readings", "That were predicted", {}, kMustSay}, s.readings);
}

void describe(Fields& fields, LeftOutLight& l) {
  fields.value({"light", "Its number", {}, kMustSay}, l.light);
  describe(fields, l.shares);
}

void describe(Fields& fields, LeftOutFacts& f) {
  describe(fields, f.all);
  fields.list({"lights", "Those of which readings were predicted", {}, kMustSay}, f.lights);
}

}  // namespace weft
