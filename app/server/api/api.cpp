// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/api.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "app/server/api/bodies/job_kinds.h"
#include "app/server/api/bodies/requests.h"
#include "app/server/api/bodies/scan_body.h"
#include "app/server/api/descriptions.h"
#include "app/server/api/short_schema.h"
#include "app/server/http/error_reply.h"
#include "app/server/jobs/job.h"
#include "core/base/error_kind.h"
#include "core/base/json_document.h"
#include "core/base/sha256.h"
#include "core/describe/error_json.h"
#include "core/describe/field_json.h"

namespace weft::app {
namespace {

constexpr SchemaOf kWritten = SchemaOf::kWritten;

Json error_schema() {
  std::vector<std::string_view> codes = error_codes();
  std::ranges::sort(codes);
  codes.erase(std::ranges::unique(codes).begin(), codes.end());
  Json schema = schema_of<Error>(kWritten);
  schema["properties"]["kind"]["enum"] = error_kind_names();
  schema["properties"]["code"] = {
      {"type", "string"},
      {"enum", std::move(codes)},
      {"description",
       "What this server decided, by a word that stays; absent where another part of weft failed"}};
  return schema;
}

/// Components of OpenAPI: documents of replies that describe their fields.
Json reply_schemas() {
  return {{"Error", error_schema()},
          {"Job", schema_of<JobStatus>(kWritten)},
          {"ScanPrices", schema_of<calibration::ScanPrices>(kWritten)}};
}

/// Each with its part of the description; calls are tagged with its name.
constexpr std::pair<const char*, const char* (*)()> kResources[] = {
    {"batches", batches_description}, {"calibrations", calibrations_description},
    {"control", control_description}, {"devices", devices_description},
    {"events", events_description},   {"exports", exports_description},
    {"frames", frames_description},   {"jobs", jobs_description},
    {"library", library_description}, {"login", login_description},
    {"maps", maps_description},       {"materials", materials_description},
    {"rig", rig_description},         {"scan", scan_description},
    {"server", server_description},   {"sessions", sessions_description},
    {"solves", solves_description},   {"virtual rig", virtual_rig_description}};

Json content_of(const Json& schema) {
  return {
      {"application/json", {{"schema", {{"$ref", "#/components/schemas/" + schema.get<std::string>()}}}}}};
}

/// {"json": SCHEMA} is a document of that schema.
void write_out(Json& body) {
  const auto schema = body.find("json");
  if (schema == body.end()) return;
  Json content = content_of(*schema);
  body.erase("json");
  body["content"] = std::move(content);
}

void write_out_response(Json& response) {
  if (response.is_string()) response = {{"description", response}, {"content", content_of("ErrorDocument")}};
  write_out(response);
}

/// The files of the resources say shortly what calls have alike: a parameter that several have is named (of
/// openapi.json), an error is a sentence, and how every call may be refused before it is looked at stands
/// here.
void write_out_operation(Json& operation, const Json& parameters) {
  if (operation.contains("parameters")) {
    for (Json& parameter : operation["parameters"]) {
      if (parameter.is_string()) parameter = parameters.at(parameter.get<std::string>());
    }
  }
  Json& responses = operation["responses"];
  for (auto& [code, response] : responses.items()) write_out_response(response);
  const auto refused = [&](const char* code, const char* response) {
    responses[code] = {{"$ref", std::string("#/components/responses/") + response}};
  };
  refused("400", "Unreadable");
  if (!operation.contains("security")) refused("401", "NoToken");
  refused("403", "ForeignOrigin");
  refused("421", "ForeignHost");
  if (operation.contains("requestBody") && operation["requestBody"].contains("json")) {
    operation["requestBody"]["required"] = true;
    write_out(operation["requestBody"]);
  }
}

/// JSON Schema of 2020 as OpenAPI 3.0 says it.
Json in_openapi(Json schema) {
  if (!schema.is_structured()) return schema;
  for (Json& each : schema) each = in_openapi(std::move(each));
  if (!schema.is_object()) return schema;
  if (schema.contains("type") && schema["type"].is_array()) {
    schema["type"] = Json(schema["type"][0]);
    schema["nullable"] = true;
  }
  if (schema.contains("exclusiveMinimum") && schema["exclusiveMinimum"].is_number()) {
    schema["minimum"] = schema["exclusiveMinimum"];
    schema["exclusiveMinimum"] = true;
  }
  return schema;
}

/// Whether a call asks something of board or camera.
bool is_of_devices(const Route& route) {
  const std::string_view path = std::string_view(route.path).substr(std::string_view("/api/v1/").size());
  return route.method != std::string_view("GET") &&
         (path.starts_with("rig/") || path.starts_with("scan") || path.starts_with("calibrations/") ||
          path.ends_with("/again"));
}

Result<Reply> refuse_for_want_of_a_rig(const Call&) {
  return Error{ErrorKind::kTryAgain, "this server has no rig", "", "it was started for archives alone",
               "ask the daemon of a rig"};
}

}  // namespace

Result<Json> command_in(const RigParts& parts, const Call& call) {
  Result<Json> body = parse_body(call.body);
  if (!body) return body;
  if (const Result<std::string> by = parts.controls.commander(call.control); !by) return by.error();
  return body;
}

Json api_description() {
  Json whole = Json::parse(common_description());
  const Json parameters = whole["parameters"];
  whole.erase("parameters");
  Json paths = Json::object(), schemas = whole["components"]["schemas"];
  for (const auto& [name, description] : kResources) {
    Json part = Json::parse(description());
    for (Json& item : part["paths"]) {
      for (Json& operation : item) operation["tags"] = Json::array({name});
    }
    paths.update(part["paths"]);
    schemas.update(part["schemas"]);
  }
  for (Json& schema : schemas) schema = written_out(schema);
  schemas.update(in_openapi(reply_schemas()));
  schemas.update(in_openapi(request_schemas()));
  schemas.update(in_openapi(job_schemas()));
  for (auto& [name, response] : whole["components"]["responses"].items()) write_out_response(response);
  for (auto& [path, item] : paths.items()) {
    for (auto& [method, operation] : item.items()) write_out_operation(operation, parameters);
  }
  whole["components"]["schemas"] = std::move(schemas);
  whole["paths"] = std::move(paths);
  return whole;
}

std::vector<Route> api_routes(const RigParts& parts) {
  std::vector<Resource> resources = {
      server_resource(parts),  login_resource(parts),     rig_resource(parts),
      scan_resource(parts),    sessions_resource(parts),  frames_resource(parts),
      jobs_resource(parts),    library_resource(parts),   events_resource(parts),
      control_resource(parts), devices_resource(parts),   calibrations_resource(parts),
      solves_resource(parts),  maps_resource(parts),      virtual_rig_resource(parts),
      exports_resource(parts), materials_resource(parts), batches_resource(parts)};
  std::vector<Route> routes;
  Reply description = json_reply(api_description());
  description.keeping = Keeping::kAskAgain;
  description.tag = sha256_of(description.body);
  routes.push_back({"GET", "/api/v1/openapi.json",
                    [description](const Call&) -> Result<Reply> { return description; }, false,
                    Pool::kQuick});
  for (Resource& resource : resources) {
    for (Route& route : resource.routes) {
      if (parts.rig.leds == 0 && is_of_devices(route)) route.handle = refuse_for_want_of_a_rig;
      routes.push_back(std::move(route));
    }
  }
  return routes;
}

}  // namespace weft::app
