// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/bodies/scan_body.h"
#include "app/server/api/routes/scan_bill.h"
#include "app/server/api/routes/scan_offers.h"
#include "app/server/api/routes/session_choice.h"
#include "calibration/run/last_check.h"
#include "core/base/files.h"
#include "core/describe/field_json.h"
#include "core/rig/calibration.h"

namespace weft::app {
namespace {

/// When it was measured, and what the last check of it said; null where nothing is known.
Json age_of(const Calibration& calibration, const std::optional<calibration::LastCheck>& check) {
  Json age = Json::object();
  if (!calibration.subject.measured.empty()) age["measured"] = calibration.subject.measured;
  if (check) {
    age["checked"] = check->date;
    age["passed"] = check->passed;
    if (check->cost.mean_deg) age["mean_deg"] = *check->cost.mean_deg;
  }
  return age.empty() ? Json() : age;
}

/// Whether the last check of the rig's calibration passed. One that did not must be accepted, and then is
/// recorded with what it costs. The age of the calibration is recorded in any case.
Result<void> check_moved(capture::ScanRequest& request) {
  const Json accepted = std::exchange(request.accepted_moved, Json());
  if (request.calibration.empty()) return {};
  const Result<Calibration> calibration = read_calibration(request.calibration);
  if (!calibration) return {};  // the scan says what is wrong with it
  const std::optional<calibration::LastCheck> check =
      calibration::last_check_of(request.calibration, calibration->id);
  request.calibrated = age_of(*calibration, check);
  if (!check || check->passed) return {};
  if (accepted.is_null()) {
    return calibration::moved_since(
        *check,
        "calibrate it again (weft calibrate update), or give a reason to scan all the same: "
        "--accept-moved WHY, \"accept_moved\" over HTTP");
  }
  request.accepted_moved = calibration::accepted_moved(*check, accepted["why"].get<std::string>());
  return {};
}

/// With an exposure that the camera has, as far as that is known.
Result<SessionChoice> session_for(const RigParts& parts, const Json& body) {
  Result<SessionChoice> choice =
      choose_session(body, parts.rig, parts.library, std::chrono::system_clock::now());
  if (!choice) return choice;
  const Result<ShotAims> aims = read_shot_aims(body, parts.rig.leds, choice->request);
  if (!aims) return aims.error();
  if (!choice->resumed && aims->wish.is_one()) {
    if (Result<void> ok = take_chosen_shots(parts, *aims, choice->request); !ok) return std::move(ok).error();
  }
  if (choice->request.exposure.exposure_us == 0) return choice;
  const Result<double> settable = parts.attendance.settable_us(choice->request.exposure.exposure_us);
  return settable ? std::move(choice) : settable.error();
}

/// What a scan would be; of a new one with its price.
Json told_before(const RigParts& parts, const SessionChoice& choice) {
  Json told = to_json(choice);
  if (choice.resumed) return told;
  told["bill"] = Json::array();
  const std::optional<calibration::ShotCost> cost = last_shot_cost(parts);
  for (const BillLine& line : bill_of(choice.request, cost ? std::optional(cost->shot_s) : std::nullopt))
    told["bill"].push_back(json_of(line));
  return told;
}

Result<Reply> offer_shots(const RigParts& parts, const Call& call) {
  const Result<Json> body = parse_body(call.body);
  if (!body) return body.error();
  const capture::ScanRequest otherwise = request_of_rig(parts.rig);
  const Result<capture::ScanRequest> request = read_scan_body(*body, parts.rig.leds, otherwise);
  if (!request) return request.error();
  const Result<ShotAims> aims = read_shot_aims(*body, parts.rig.leds, otherwise);
  if (!aims) return aims.error();
  const Result<calibration::ScanPrices> offers = offers_for(parts, *request, *aims);
  return offers ? json_reply(object_of(*offers)) : Result<Reply>(offers.error());
}

Result<Json> begin_scan(const RigParts& parts, const Json& body, const std::string& by) {
  Result<SessionChoice> choice = session_for(parts, body);
  if (!choice) return std::move(choice).error();
  if (!choice->resumed) {
    if (Result<void> ok = check_moved(choice->request); !ok) return std::move(ok).error();
  }
  if (Result<void> made = make_writable_folder(parts.rig.scan.sessions); !made)
    return std::move(made).error();
  const std::filesystem::path folder = choice->request.session;
  if (Result<void> begun = parts.keeper.begin(std::move(choice->request), by); !begun)
    return std::move(begun).error();
  parts.library.watch(folder);
  return to_json(*choice);
}

Result<Reply> start_scan(const RigParts& parts, const Call& call) {
  const Result<Json> body = parse_body(call.body);
  if (!body) return body.error();
  const Result<std::string> by = parts.controls.commander(call.control);
  if (!by) return by.error();
  if (const auto dry = body->find("dry_run"); dry != body->end() && *dry == true) {
    const Result<SessionChoice> choice = session_for(parts, *body);
    return choice ? json_reply(told_before(parts, *choice)) : Result<Reply>(choice.error());
  }
  const Json id = body->value("request_id", Json(""));
  const Result<Json> begun = parts.scans.answer(id.is_string() ? id.get<std::string>() : "",
                                                [&] { return begin_scan(parts, *body, *by); });
  return begun ? json_reply(*begun, kAccepted) : Result<Reply>(begun.error());
}

/// A step whose success is told by the status it leads to; it hears who commands it.
template <typename Step>
Result<Reply> after(const RigParts& parts, const Call& call, const Step& step) {
  if (const Result<Json> body = parse_body(call.body); !body) return body.error();
  const Result<std::string> by = parts.controls.commander(call.control);
  if (!by) return by.error();
  if (Result<void> done = step(*by); !done) return std::move(done).error();
  return json_reply(to_json(parts.keeper.status(), parts.rig), kAccepted);
}

}  // namespace

Resource scan_resource(const RigParts& parts) {
  return {{{"POST", "/api/v1/scan", [&parts](const Call& call) { return start_scan(parts, call); }},
           {"POST", "/api/v1/scan/price", [&parts](const Call& call) { return offer_shots(parts, call); }},
           {"POST", "/api/v1/scan/pause",
            [&parts](const Call& call) {
              return after(parts, call, [&](const std::string&) { return parts.keeper.pause(); });
            },
            false, Pool::kQuick},
           {"POST", "/api/v1/scan/resume",
            [&parts](const Call& call) {
              return after(parts, call, [&](const std::string& by) { return parts.keeper.resume(by); });
            },
            false, Pool::kQuick},
           {"POST", "/api/v1/scan/cancel",
            [&parts](const Call& call) {
              return after(parts, call, [&](const std::string&) { return parts.keeper.cancel(); });
            },
            false, Pool::kQuick}}};
}

}  // namespace weft::app
