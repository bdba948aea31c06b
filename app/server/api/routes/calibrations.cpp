// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/bodies/job_places.h"
#include "app/server/api/bodies/requests.h"
#include "app/server/api/bodies/scan_body.h"
#include "calibration/guide/printed_target.h"
#include "calibration/guide/response_series.h"
#include "calibration/run/accept.h"
#include "calibration/run/history.h"
#include "core/base/files.h"
#include "core/toml/field_toml.h"

namespace weft::app {
namespace {

constexpr const char* kNoSet = "the set cannot be worked on";

Result<Reply> replied(Result<Json> document, int status = 200) {
  if (!document) return std::move(document).error();
  return json_reply(*document, status);
}

Result<Reply> begin_or_go_on(const RigParts& parts, const Call& call) {
  const Result<Json> body = command_in(parts, call);
  if (!body) return body.error();
  const Result<SetWorkRequest> asked =
      read_body<SetWorkRequest>(*body, {kNoSet, "a set", "POST calibrations/work"});
  if (!asked) return asked.error();
  SetKeeper::Wish wish;
  wish.part = asked->part;
  wish.name = asked->name;
  wish.description = asked->thing.empty() ? asked->description : toml_of(asked->thing);
  if (!asked->from.empty()) wish.from = parts.rig.folder() / asked->from;
  return replied(parts.sets.begin(wish));
}

Result<Reply> photograph_next(const RigParts& parts, const Call& call) {
  if (const Result<Json> body = parse_body(call.body); !body) return body.error();
  const Result<std::string> by = parts.controls.commander(call.control);
  if (!by) return by.error();
  return replied(parts.sets.photograph(*by), kAccepted);
}

Result<Reply> leave_out_or_take_back(const RigParts& parts, const Call& call) {
  const Result<Json> body = command_in(parts, call);
  if (!body) return body.error();
  const Result<LeaveOutRequest> wish =
      read_body<LeaveOutRequest>(*body, {kNoSet, "it", "POST calibrations/work/leave-out"});
  if (!wish) return wish.error();
  return replied(parts.sets.leave_out(wish->name, wish->out));
}

Json json_of(const calibration::ListedCalibration& one, const std::filesystem::path& root,
             const std::filesystem::path& current) {
  Json check;
  if (one.check) check = {{"date", one.check->date}, {"passed", one.check->passed}};
  return {{"folder", one.folder.lexically_relative(root).string()},
          {"id", one.id},
          {"measured", one.measured.empty() ? Json() : Json(one.measured)},
          {"parts", one.parts},
          {"check", std::move(check)},
          {"is_rigs", !current.empty() && absolute_folder(one.folder) == absolute_folder(current)}};
}

Result<Reply> list_of_calibrations(const RigParts& parts, const Call&) {
  const std::filesystem::path root = parts.rig.folder();
  const Result<std::vector<calibration::ListedCalibration>> all = calibration::list_calibrations(root);
  if (!all) return all.error();
  const std::filesystem::path current = capture::calibration_now(parts.rig);
  Json calibrations = Json::array();
  for (const calibration::ListedCalibration& one : *all) calibrations.push_back(json_of(one, root, current));
  return json_reply({{"calibrations", std::move(calibrations)},
                     {"complete_series", calibration::complete_series(root / "sets")}});
}

Result<Reply> history_of_rig(const RigParts& parts, const Call&) {
  calibration::CalibrateHistoryOptions options;
  options.rig = parts.rig.folder();
  if (is_there(parts.rig.scan.sessions)) options.sessions = parts.rig.scan.sessions;
  options.calibration = capture::calibration_now(parts.rig);
  const Result<calibration::CalibrationHistory> history = calibration::calibrate_history(options, {});
  if (!history) return history.error();
  Json document = calibration::document_of(history->report);
  document["warnings"] = history->warnings;
  return json_reply(document);
}

Result<Reply> accept(const RigParts& parts, const Call& call) {
  const Result<Json> body = command_in(parts, call);
  if (!body) return body.error();
  const Result<AcceptRequest> wish = read_body<AcceptRequest>(
      *body, {"no calibration can be accepted so", "it", "POST calibrations/accept"});
  if (!wish) return wish.error();
  const Result<std::filesystem::path> folder =
      folder_below(parts.rig.folder(), wish->calibration.string(), "calibration");
  if (!folder) return folder.error();
  const Result<calibration::CalibrationChange> change =
      calibration::change_between(capture::calibration_now(parts.rig), *folder);
  if (!change) return change.error();
  if (!wish->dry_run) {
    if (Result<void> named = calibration::name_calibration(parts.rig.file, *folder); !named)
      return std::move(named).error();
    parts.watch.hold_against_calibration();
  }
  Json document = json_of(*change);
  document["words"] = words_of(*change);
  document["accepted"] = !wish->dry_run;
  return json_reply(document);
}

Result<Reply> print_target(const RigParts& parts, const Call& call) {
  const Result<Json> body = command_in(parts, call);
  if (!body) return body.error();
  const Result<calibration::TargetRequest> wish = read_body<calibration::TargetRequest>(
      *body, {"nothing can be printed so", "a target", "POST calibrations/targets"});
  if (!wish) return wish.error();
  const Result<calibration::PrintedTarget> target = calibration::print_for_rig(*wish, parts.rig);
  if (!target) return target.error();
  return json_reply({{"target", target->name},
                     {"says", target->says},
                     {"remedy", target->remedy},
                     {"pdf", "/api/v1/calibrations/targets/" + target->name}});
}

Result<Reply> printed_target(const RigParts& parts, const Call& call) {
  const std::string& name = call.segments.at(0);
  const bool is_known = std::ranges::find(calibration::kTargetNames, name) != calibration::kTargetNames.end();
  Result<std::string> pdf = is_known ? read_text(calibration::pdf_of_target(parts.rig, name))
                                     : Error{ErrorKind::kNoInput, "there is no such target", name, "",
                                             "print one: POST calibrations/targets"};
  if (!pdf) return std::move(pdf).error();
  return Reply{200, "application/pdf", std::move(*pdf)};
}

}  // namespace

Resource calibrations_resource(const RigParts& parts) {
  const auto call = [&parts](const char* method, const char* path, auto handle, Pool pool) {
    return Route{method, path, [&parts, handle](const Call& asked) { return handle(parts, asked); }, false,
                 pool};
  };
  return {
      {call("GET", "/api/v1/calibrations", list_of_calibrations, Pool::kDisk),
       call("GET", "/api/v1/calibrations/history", history_of_rig, Pool::kDisk),
       call("POST", "/api/v1/calibrations/accept", accept, Pool::kDisk),
       call("POST", "/api/v1/calibrations/targets", print_target, Pool::kDisk),
       call("GET", "/api/v1/calibrations/targets/{target}", printed_target, Pool::kDisk),
       call("POST", "/api/v1/calibrations/work", begin_or_go_on, Pool::kDevices),
       call(
           "GET", "/api/v1/calibrations/work",
           [](const RigParts& all, const Call&) { return json_reply(all.sets.document()); }, Pool::kQuick),
       call("POST", "/api/v1/calibrations/work/photograph", photograph_next, Pool::kQuick),
       call("POST", "/api/v1/calibrations/work/leave-out", leave_out_or_take_back, Pool::kDevices)}};
}

}  // namespace weft::app
