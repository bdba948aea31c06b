// SPDX-License-Identifier: Apache-2.0
#include "core/rig/seen_rig.h"

#include <utility>

#include "core/describe/field_json.h"

namespace weft {

void describe(Fields& fields, RigLookFacts& look) {
  fields.value({"taken", "The first photograph, ISO 8601", {}, kMustSay}, look.taken);
  fields.value({"calibration", "Id of the one that it is held against", {}, kMustSay}, look.calibration);
  fields.value({.name = "photographs", .says = "Digest of those that were looked at", .need = kUnlessEmpty},
               look.photographs);
  fields.choice({"state", "dimmed: each solve puts it right; moved: maps show it", {}, kMustSay}, look.state,
                kRigPlaceNames);
  fields.value({"says", "What moved or changed, and what it costs", {}, kMustSay}, look.says);
  fields.value({"action", "The one thing to do; empty: nothing", {}, kMustSay}, look.action);
}

std::optional<RigLookFacts> read_rig_look(const std::filesystem::path& session) {
  const std::filesystem::path file = session / kRigLookFile;
  const Result<Json> document = read_json(file, kRigLookSchema, 1);
  if (!document) return std::nullopt;
  Result<RigLookFacts> look = read_fields<RigLookFacts>(*document, file.string());
  return look ? std::optional(std::move(*look)) : std::nullopt;
}

}  // namespace weft
