// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/bodies/job_kinds.h"

#include <fmt/format.h>

#include <cctype>
#include <string_view>

#include "app/server/api/bodies/batch_body.h"
#include "app/server/api/bodies/job_arguments.h"
#include "app/server/api/bodies/library_materials.h"
#include "calibration/guide/rig_plan_request.h"
#include "calibration/run/calibrate_camera.h"
#include "calibration/run/calibrate_color.h"
#include "calibration/run/calibrate_grey.h"
#include "calibration/run/calibrate_lights.h"
#include "calibration/run/calibrate_patches.h"
#include "calibration/run/calibrate_response.h"
#include "calibration/run/check.h"
#include "calibration/run/update.h"
#include "capture/scan/copy_request.h"
#include "exchange/export/export_request.h"
#include "library/chain/make.h"
#include "library/import/import_request.h"
#include "library/run/plan_batch.h"
#include "library/run/run_batch.h"
#include "material/assets/build_request.h"
#include "material/run/maps_request.h"
#include "material/run/rectify.h"
#include "simulator/sample_request.h"
#include "solve/run/solve_request.h"
#include "torture/torture_request.h"

namespace weft::app {
namespace {

constexpr const char* kPlanPicture = "{files}/plan.svg";

template <typename Described>
std::shared_ptr<void> walk(Fields& fields) {
  const auto described = std::make_shared<Described>();
  describe(fields, *described);
  return described;
}

void add(JobSpec& spec, std::initializer_list<std::string> words) {
  spec.arguments.insert(spec.arguments.end(), words);
}

/// What files are made of.
struct ExportSource {
  std::filesystem::path session;
  std::string set, material;
};

void describe(Fields& fields, ExportSource& s) {
  fields.value({.name = "session", .says = "Whose maps", .path = PathTo::kSession, .said = Said::kToServer},
               s.session);
  fields.value({.name = "material",
                .says = "In place of a session a built material, by its key in GET materials",
                .said = Said::kToServer,
                .is_sentence = true},
               s.material);
  fields.need_one({"session", "material"});
  fields.exclude("session", "material");
  fields.value({.name = "set",
                .says = "Id of a set of maps, default the newest of the session's current solve; of a "
                        "material that of what was built of it",
                .said = Said::kToServer},
               s.set);
}

Result<void> add_export_source(JobSpec& spec, const JobPlaces& places) {
  if (!spec.wants.contains("presets")) return unfit_job("presets", "is needed by a " + spec.kind + " job");
  const std::string set = spec.wants.value("set", "");
  const bool is_material = spec.wants.contains("material");
  spec.of = spec.wants[is_material ? "material" : "session"].get<std::string>();
  const Result<std::filesystem::path> source =
      is_material ? places.build(spec.of, set) : places.session(spec.of);
  if (!source) return source.error();
  spec.needs.push_back(source->string());
  add(spec, {source->string()});
  if (!is_material && !set.empty()) add(spec, {"--maps", set});
  return {};
}

struct LookedAtScan {
  std::filesystem::path session;
};

void describe(Fields& fields, LookedAtScan& scan) {
  fields.value({.name = "session",
                .says = "The scan that shows its rig",
                .need = kMustSay,
                .path = PathTo::kSession,
                .said = Said::kToServer},
               scan.session);
}

Result<void> add_scan(JobSpec& spec, const JobPlaces& places) {
  spec.of = spec.wants["session"].get<std::string>();
  const Result<std::filesystem::path> session = places.session(spec.of);
  if (!session) return session.error();
  spec.needs.push_back(session->string());
  add(spec, {session->string()});
  return {};
}

struct NamedMaterial {
  std::string material;
};

void describe(Fields& fields, NamedMaterial& source) {
  fields.value({.name = "material",
                .says = "As GET materials has its key",
                .need = kMustSay,
                .said = Said::kToServer,
                .is_sentence = true},
               source.material);
}

Result<void> add_material(JobSpec& spec, const JobPlaces& places) {
  spec.of = spec.wants["material"].get<std::string>();
  const Result<material::MaterialPlace> place = places.material(spec.of);
  if (!place) return place.error();
  if (!place->is_shipped()) {
    spec.needs.push_back(place->file.string());
    add(spec, {place->file.string()});
  } else {
    // What comes with weft lies in no folder of the user's, and so is told where it is built.
    add(spec, {"--output", builds_of(*place).string(), place->name});
  }
  return {};
}

/// Which sessions a batch solves.
struct BatchSessions {
  std::vector<std::string> sessions;
  Json find;
  std::string name;
};

void describe(Fields& fields, BatchSessions& b) {
  fields.value({.name = "sessions",
                .says = "Their names, at most 2000; in the job their number",
                .said = Said::kToServer,
                .is_sentence = true},
               b.sessions);
  fields.value({.name = "find",
                .says = "In their place the words of GET sessions but limit and after; all that is found is "
                        "planned",
                .said = Said::kToServer},
               b.find);
  fields.need_one({"sessions", "find"});
  fields.exclude("sessions", "find");
  fields.value({.name = "name",
                .says = "Of the batch, default the next number",
                .said = Said::kToServer,
                .is_sentence = true},
               b.name);
}

struct BatchName {
  std::string batch;
};

void describe(Fields& fields, BatchName& b) {
  fields.value({.name = "batch",
                .says = "As GET batches names it",
                .need = kMustSay,
                .said = Said::kToServer,
                .is_sentence = true},
               b.batch);
}

Result<void> add_copy_place(JobSpec& spec, const JobPlaces& places) {
  if (!places.copy.empty()) add(spec, {"--to", places.copy.string()});
  return {};
}

// The session that the job makes is called as itself.
Result<void> add_carried_place(JobSpec& spec, const JobPlaces& places) {
  spec.of = spec.kind;
  add(spec, {"--output", (places.sessions / fmt::format("{}.weft", spec.kind)).string()});
  return {};
}

// Sessions go where scans do; what the rig knows holds for frames of it.
Result<void> add_archive(JobSpec& spec, const JobPlaces& places) {
  if (!places.rig_file.empty()) add(spec, {"--rig", places.rig_file.string()});
  add(spec, {"--output", places.sessions.string()});
  return {};
}

Result<void> add_rig_file(JobSpec& spec, const JobPlaces& places) {
  if (places.rig_file.empty())
    return Error{ErrorKind::kNoInput, "there is no rig to plan for", places.rig, "", "serve one with --rig"};
  spec.of = places.rig;
  spec.needs.push_back(places.rig_file.string());
  add(spec, {places.rig_file.string()});
  return {};
}

// Where there is no calibration that says it.
Result<void> add_rig_name(JobSpec& spec, const JobPlaces& places) {
  if (!spec.wants.contains("from")) add(spec, {"--rig", places.rig});
  return {};
}

// "CalibrateCameraJob"
std::string schema_name_of(const JobKind& kind) {
  std::string name;
  bool begins = true;
  for (const char c : std::string_view(kind.name)) {
    if (c != '_') name += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    begins = c == '_';
  }
  return name + "Job";
}

Json schema_of(const JobKind& kind) {
  JobSchema walked;
  for (const auto& fields : kind.fields) fields(walked);
  const Json said = walked.schema();
  Json needed = Json::array({"kind"});
  for (const Json& each : said.value("required", Json::array())) needed.push_back(each);
  Json properties = {{"kind", {{"type", "string"}, {"enum", {kind.name}}}},
                     {"request_id",
                      {{"type", "string"},
                       {"description",
                        "A plain word: the same once more is the same job, and asks nothing "
                        "new"}}}};
  properties.update(said["properties"]);
  Json schema = {{"type", "object"},
                 {"title", kind.title},
                 {"required", std::move(needed)},
                 {"properties", std::move(properties)},
                 {"additionalProperties", false}};
  for (const char* rule : {"dependentRequired", "allOf"}) {
    if (said.contains(rule)) schema[rule] = said[rule];
  }
  return schema;
}

}  // namespace

const std::vector<JobKind>& job_kinds() {
  static const std::vector<JobKind> kinds = {
      {"solve", "Solve", {"solve"}, {walk<solve::SolveRequest>}},
      {"price",
       "Price of each level",
       {"solve", "--explain", "--crops", kJobFiles},
       {walk<solve::PriceRequest>}},
      {"rectify", "Rectified maps", {"rectify"}, {walk<material::RectifyOptions>}},
      {"copy", "Second copy", {"copy"}, {walk<capture::CopyRequest>}, add_copy_place},
      {"make", "Maps and exports, made final", {"make"}, {walk<library::MakeOptions>}},
      {"torture", "Hard cases", {"torture"}, {walk<torture::TortureRequest>}, add_carried_place},
      {"sample", "Sample cloth", {"sample"}, {walk<simulator::SampleRequest>}, add_carried_place},
      {"import",
       "Photographs become sessions",
       {"import", "--yes"},
       {walk<library::ImportRequest>},
       add_archive},
      {"rig_plan",
       "Which light to add",
       {"rig", "plan", "--picture", kPlanPicture},
       {walk<calibration::RigPlanRequest>},
       add_rig_file},
      {kRigCheck, "Has the rig moved?", {"rig", "check"}, {walk<LookedAtScan>}, add_scan},
      {"maps", "Maps", {"maps"}, {walk<material::MapsRequest>}},
      {"maps_price", "Price of maps", {"maps", "--explain"}, {walk<material::MapsRequest>}},
      {"finish", "Finished maps", {"finish"}, {walk<material::FinishRequest>}},
      {"finish_price", "Price of finished maps", {"finish", "--explain"}, {walk<material::FinishRequest>}},
      {"export",
       "Export",
       {"export"},
       {walk<ExportSource>, walk<exchange::ExportRequest>},
       add_export_source},
      {"export_price",
       "Price of an export",
       {"export", "--explain"},
       {walk<ExportSource>, walk<exchange::ExportRequest>},
       add_export_source},
      {"material",
       "Built material",
       {"material", "build"},
       {walk<NamedMaterial>, walk<material::BuildRequest>},
       add_material},
      {"check",
       "Check of the calibration",
       {"calibrate", "check"},
       {walk<calibration::CalibrateCheckOptions>}},
      {"calibrate_camera",
       "Lens and pose",
       {"calibrate", "camera"},
       {walk<calibration::CalibrateCameraOptions>},
       add_rig_name},
      {"calibrate_camera_price",
       "Price of more boards",
       {"calibrate", "camera", "--explain"},
       {walk<calibration::CalibrateCameraOptions>},
       add_rig_name},
      {"calibrate_response",
       "Sensor",
       {"calibrate", "response"},
       {walk<calibration::CalibrateResponseOptions>},
       add_rig_name},
      {"calibrate_color",
       "Colour",
       {"calibrate", "color"},
       {walk<calibration::CalibrateColorOptions>},
       add_rig_name},
      {"calibrate_lights", "Lights", {"calibrate", "lights"}, {walk<calibration::CalibrateLightsOptions>}},
      {"calibrate_lights_price",
       "Price of more sheets",
       {"calibrate", "lights", "--explain"},
       {walk<calibration::CalibrateLightsOptions>}},
      {"calibrate_grey", "Grey scale", {"calibrate", "grey"}, {walk<calibration::CalibrateGreyOptions>}},
      {"calibrate_patches",
       "White patches",
       {"calibrate", "patches"},
       {walk<calibration::CalibratePatchesOptions>}},
      {"calibrate_update",
       "Update of the calibration",
       {"calibrate", "update"},
       {walk<calibration::CalibrateUpdateOptions>}},
      {"batch_plan",
       "Plan of a batch",
       {"batch", "plan"},
       {walk<BatchSessions>, walk<library::PlanBatchOptions>},
       add_batch_plan},
      {"batch_run",
       "Batch",
       {"batch", "run", "--merge"},
       {walk<BatchName>, walk<library::RunBatchRequest>},
       add_batch_run}};
  return kinds;
}

Json job_forms() {
  Json forms = Json::array();
  for (const JobKind& kind : job_kinds())
    forms.push_back({{"kind", kind.name}, {"title", kind.title}, {"schema", schema_of(kind)}});
  return forms;
}

Json job_schemas() {
  Json schemas = Json::object(), one_of = Json::array(), mapping = Json::object();
  for (const JobKind& kind : job_kinds()) {
    const std::string name = schema_name_of(kind);
    const std::string reference = "#/components/schemas/" + name;
    one_of.push_back({{"$ref", reference}});
    mapping[kind.name] = reference;
    schemas[name] = schema_of(kind);
  }
  schemas["JobRequest"] = {{"oneOf", std::move(one_of)},
                           {"discriminator", {{"propertyName", "kind"}, {"mapping", std::move(mapping)}}}};
  return schemas;
}

}  // namespace weft::app
