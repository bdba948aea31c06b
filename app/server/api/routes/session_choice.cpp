// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/routes/session_choice.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "app/server/api/bodies/scan_body.h"
#include "capture/scan/scan_plan.h"
#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "library/catalogue/session_name.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr auto kRecent = std::chrono::hours(1);
constexpr double kSameExposure = 0.2;  // octaves: a camera's times are a third apart
constexpr const char* kComplete = "complete";
constexpr int kMostUnfinished = 1000;

/// The calibration that this rig's sessions are begun with now.
std::string calibration_id(const capture::Rig& rig) {
  const fs::path folder = capture::calibration_now(rig);
  if (folder.empty()) return "";
  const Result<Calibration> calibration = read_calibration(folder);
  return calibration ? calibration->id : "";
}

/// Those of this rig, cloth and calibration that a scan could finish, the newest first.
Result<std::vector<library::Entry>> unfinished_of_cloth(const std::string& fabric, const capture::Rig& rig,
                                                        LibraryService& library) {
  if (fabric.empty()) return std::vector<library::Entry>();
  library::Query query = unfinished_of(rig);
  query.fabric = fabric;
  query.limit = kMostUnfinished;
  Result<library::CataloguePage> page = library.find(query);
  if (!page) return std::move(page).error();
  std::vector<library::Entry> found = std::move(page->entries);
  if (found.empty()) return found;
  std::erase_if(found, [id = calibration_id(rig)](const auto& each) { return each.calibration != id; });
  std::ranges::sort(found, std::greater{}, &library::Entry::written);
  return found;
}

bool is_exposed_as(const Session& session, const capture::ExposureSettings& asked) {
  const Json record = session.document.value("exposure", Json());
  if (record.is_null()) return true;  // it was not chosen yet
  JsonFields fields(record, "exposure");
  const capture::ExposureSettings of_session = {fields.number("exposure_us"), fields.number("iso"),
                                                fields.number("f_number")};
  if (!fields.status() || of_session.iso != asked.iso || of_session.f_number != asked.f_number) return false;
  return asked.exposure_us == 0 ||
         std::abs(std::log2(asked.exposure_us / of_session.exposure_us)) < kSameExposure;
}

/// Whether the body asks for nothing else than what the session was begun with.
bool is_asked_for(const Session& session, const Json& body, const capture::Rig& rig) {
  const capture::ScanRequest begun = request_of_session(session, rig);
  const Result<capture::ScanRequest> asked = read_scan_body(body, rig.leds, begun);
  return asked && asked->cloth_height_mm == begun.cloth_height_mm && asked->pose == begun.pose &&
         asked->leds == begun.leds && asked->repeat == begun.repeat && asked->bracket == begun.bracket &&
         asked->below == begun.below && asked->blade == begun.blade &&
         asked->polariser.states == begun.polariser.states && asked->metadata == begun.metadata &&
         is_exposed_as(session, asked->exposure);
}

Result<SessionChoice> resumed(std::string name, const Session& session, const Json& body,
                              const capture::Rig& rig) {
  Result<capture::ScanRequest> request = read_scan_body(body, rig.leds, request_of_session(session, rig));
  if (!request) return std::move(request).error();
  SessionChoice choice = {std::move(name), std::move(*request), true};
  choice.request.session = session.folder;
  choice.frames = static_cast<int>(session.shots.size());
  choice.frames_planned = capture::asked_shots(choice.request).count();
  return choice;
}

Result<SessionChoice> new_one(std::string name, capture::ScanRequest request, const capture::Rig& rig) {
  Result<fs::path> folder = library::session_folder(rig.scan.sessions, name);
  if (!folder) return std::move(folder).error();
  request.session = std::move(*folder);
  return SessionChoice{std::move(name), std::move(request)};
}

Result<SessionChoice> named(const std::string& name, const Json& body, const capture::Rig& rig) {
  const Result<fs::path> folder = library::session_folder(rig.scan.sessions, name);
  if (!folder) return folder.error();
  if (!is_there(*folder)) {
    Result<capture::ScanRequest> request = read_scan_body(body, rig.leds, request_of_rig(rig));
    if (!request) return std::move(request).error();
    return new_one(name, std::move(*request), rig);
  }
  const Result<Session> session = read_session(*folder);
  if (!session) return session.error();
  if (session->state == kComplete || session->rig != rig.name) {
    return Error{
        ErrorKind::kCannotCreate, "there is a session of this name", name,
        session->rig == rig.name ? "it is finished, and none is overwritten" : "it is of rig " + session->rig,
        "take another name"};
  }
  return resumed(name, *session, body, rig);
}

Result<SessionChoice> by_cloth(const Json& body, const capture::Rig& rig, LibraryService& library,
                               std::chrono::system_clock::time_point now) {
  Result<capture::ScanRequest> request = read_scan_body(body, rig.leds, request_of_rig(rig));
  if (!request) return std::move(request).error();
  const std::string fabric = request->fabric;
  const Result<std::vector<library::Entry>> unfinished = unfinished_of_cloth(fabric, rig, library);
  if (!unfinished) return unfinished.error();
  const std::string recent =
      iso_time(std::chrono::duration<double>((now - kRecent).time_since_epoch()).count());
  for (const library::Entry& each : *unfinished) {
    if (each.written < recent) break;
    const Result<Session> session = read_session(each.folder);
    if (session && is_asked_for(*session, body, rig)) return resumed(each.name, *session, body, rig);
  }
  Result<std::string> name =
      library::next_session_name(rig.scan.session_name, fabric, rig.name, rig.scan.sessions, now);
  if (!name) return std::move(name).error();
  Result<SessionChoice> choice = new_one(std::move(*name), std::move(*request), rig);
  if (choice && !unfinished->empty()) choice->unfinished = unfinished->front().name;
  return choice;
}

}  // namespace

Json to_json(const SessionChoice& choice) {
  Json json = {{"session", choice.name}, {"resumed", choice.resumed}};
  if (choice.resumed) {
    json["frames"] = choice.frames;
    json["frames_planned"] = choice.frames_planned;
  }
  if (!choice.unfinished.empty()) json["unfinished"] = choice.unfinished;
  return json;
}

bool is_resumable(const capture::Rig& rig, const std::string& of, const std::string& state) {
  return of == rig.name && state != kComplete && state != "unreadable";
}

library::Query unfinished_of(const capture::Rig& rig) {
  library::Query query;
  query.rig = rig.name;
  query.unfinished = true;
  query.in = absolute_folder(rig.scan.sessions);
  return query;
}

Result<SessionChoice> choose_session(const Json& body, const capture::Rig& rig, LibraryService& library,
                                     std::chrono::system_clock::time_point now) {
  const Result<std::string> name = session_in_body(body);
  if (!name) return name.error();
  Result<SessionChoice> choice = name->empty() ? by_cloth(body, rig, library, now) : named(*name, body, rig);
  if (choice && choice->request.fabric.empty()) {
    return Error{ErrorKind::kUsage, "the scan has no fabric", "fabric", "",
                 "name the cloth: --fabric satin, or {\"fabric\": \"satin\"}"};
  }
  return choice;
}

std::vector<double> other_exposures_us(const Session& session) {
  const auto lit = session.lit();
  const Result<Calibration> calibration = read_calibration(session.calibration_folder());
  if (lit.empty() || !calibration || !calibration->response) return {};
  return calibration->response->exposures_beside(lit.front()->exposure_us);
}

Result<capture::ScanRequest> request_again(const Session& session, const capture::Rig& rig, const Shot& shot,
                                           double exposure_us) {
  if (session.rig != rig.name) {
    return Error{ErrorKind::kCannotCreate, "no shot of the session can be taken again",
                 session.folder.string(), "it is of rig \"" + session.rig + "\"", "use that rig"};
  }
  capture::ScanRequest request = request_of_session(session, rig);
  request.session = session.folder;
  request.calibration = is_there(session.calibration_folder()) ? session.calibration_folder() : fs::path();
  request.exposure.exposure_us = exposure_us;
  const Json copy = session.document.value("copy", Json());
  request.copy = copy.is_object() ? copy.value("to", "") : "";
  request.again = shot.index;
  if (shot.led > 0) request.leds = {shot.led};
  request.below = false;
  return request;
}

}  // namespace weft::app
