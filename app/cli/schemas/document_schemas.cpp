// SPDX-License-Identifier: Apache-2.0
#include "app/cli/schemas/document_schemas.h"

#include <fmt/format.h>

#include "calibration/guide/photograph_set.h"
#include "calibration/run/last_check.h"
#include "calibration/run/rig_look.h"
#include "core/describe/field_json.h"
#include "core/rig/calibration.h"
#include "core/rig/calibration_parts.h"
#include "core/rig/session.h"
#include "core/solve/solve.h"
#include "exchange/presets/export_facts.h"
#include "library/batch/outcome.h"
#include "library/batch/plan.h"
#include "library/chain/chain.h"
#include "library/run/merge_batch.h"
#include "material/run/map_set_facts.h"
#include "material/run/rectify.h"
#include "solve/report/reflectance_facts.h"
#include "solve/report/report_facts.h"

namespace weft::app {
namespace {

template <typename Described>
Json fields_of() {
  return schema_of<Described>();
}

}  // namespace

const std::vector<DocumentSchema>& document_schemas() {
  static const std::vector<DocumentSchema> all = {
      {"weft.session", "session.json: what was scanned, and every exposure", fields_of<Session>},
      {"weft.calibration", "calibration.json: what a rig's calibration holds for",
       fields_of<CalibrationSubject>},
      {"weft.camera", "camera.json of a calibration", fields_of<CameraPart>},
      {"weft.response", "response.json of a calibration", fields_of<Response>},
      {"weft.color", "color.json of a calibration", fields_of<ColorTransform>},
      {"weft.lights", "lights.json of a calibration", fields_of<LightsPart>},
      {"weft.calibration-check", "result.json: whether a rig is as it was calibrated",
       fields_of<calibration::CheckResult>},
      {"weft.rig-look", "rig.json of a session: what it shows of its rig", fields_of<calibration::RigLook>},
      {"weft.set", "set.json: photographs for a step of a calibration",
       fields_of<calibration::PhotographSet>},
      {"weft.solve", "solve.json: what a solve was made of and says of itself", fields_of<SolveFacts>},
      {"weft.reflectance", "reflectance.json: the lobes of a cloth", fields_of<solve::ReflectanceFacts>},
      {"weft.solve-report", "report.json of a solve: what went wrong, and where its error comes from",
       fields_of<solve::SolveReportFacts>},
      {"weft.rectified", "rectify.json: maps of a solve on a square grid of the table",
       fields_of<material::RectifyFacts>},
      {"weft.maps", "maps.json: a set of maps", fields_of<material::MapSetFacts>},
      {"weft.export", "export.json: the files of a preset", fields_of<exchange::ExportFacts>},
      {"weft.chain", "What a session has from photographs to exports, and how fresh it is",
       fields_of<library::Chain>},
      {"weft.batch", "The first line of a plan", fields_of<library::BatchHeader>},
      {"weft.batch-session", "A line of a plan: a session that is solved", fields_of<library::PlannedSolve>,
       false},
      {"weft.batch-left-out", "A line of a plan: a session that is not", fields_of<library::SkippedSession>,
       false},
      {"weft.batch-result", "A line of RESULTS/task-N.jsonl: what became of a session",
       fields_of<library::TaskOutcome>},
      {"weft.batch-report", "report.json of a batch", fields_of<library::BatchReportFacts>}};
  return all;
}

Json schema_document(const DocumentSchema& document) {
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", document.name},
                 {"description", document.says}};
  schema.update(document.fields());
  if (!document.is_versioned) return schema;
  schema["properties"]["schema"] = {{"type", "string"},
                                    {"pattern", fmt::format("^{}/1(\\.[0-9]+)?$", document.name)}};
  schema["required"].push_back("schema");
  return schema;
}

}  // namespace weft::app
