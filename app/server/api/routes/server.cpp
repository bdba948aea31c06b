// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <memory>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/routes/awaited.h"
#include "app/server/rig/logbook.h"
#include "capture/doctor/doctor.h"
#include "core/base/files.h"
#include "core/solve/solve_record.h"
#include "firmware/protocol/protocol.h"

namespace weft::app {
namespace {

constexpr auto kDiskPatience = std::chrono::seconds(4);
constexpr std::int64_t kUsualLines = 100, kMostLines = 1000;

Result<Reply> version(const RigParts& parts) {
  const std::optional<capture::CameraFacts> camera = parts.keeper.status().camera;
  return json_reply(
      {{"weft", WEFT_VERSION},
       {"solver", kSolverVersion},
       {"libgphoto2", WEFT_GPHOTO2_VERSION},
       {"firmware_protocol", kWeftProtocolMajor},
       {"camera", camera ? Json{{"model", camera->model}, {"serial", camera->serial}} : Json()}});
}

Result<std::optional<std::int64_t>> line_number(const Call& call, const char* key, std::int64_t least) {
  const auto found = call.query.find(key);
  if (found == call.query.end()) return std::optional<std::int64_t>();
  const std::string& text = found->second;
  std::int64_t number = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size() && number >= least)
    return std::optional(number);
  return Error{ErrorKind::kUsage, "the log cannot be read so", key,
               fmt::format("must be a number from {}", least), "see GET log in openapi.json"};
}

Result<Reply> read_lines(const RigParts& parts, const Call& call) {
  const auto after = line_number(call, "after", 0);
  if (!after) return after.error();
  const auto limit = line_number(call, "limit", 1);
  if (!limit) return limit.error();
  LogPage page = read_log(parts.state / "log", *after,
                          static_cast<std::size_t>(std::min(limit->value_or(kUsualLines), kMostLines)));
  const Json last = page.more ? page.lines.back()["number"] : Json();
  return json_reply({{"lines", std::move(page.lines)}, {"after", last}});
}

Error silent_disk() {
  return {ErrorKind::kInputOutput, "the disk does not answer", "",
          fmt::format("a folder of the rig could not be looked at within {} s", kDiskPatience.count()),
          "look whether the disk of scan.sessions, scan.copy and daemon.state is there: df"};
}

Json room_in(const std::filesystem::path& folder) {
  const std::uint64_t free = free_disk_bytes(folder);
  return {{"folder", folder.string()},
          {"free_bytes", free},
          {"scans_left", free / (capture::kFrameBytes * capture::kSessionFrames)}};
}

Json rooms_of(const capture::Rig& rig, const std::filesystem::path& state) {
  return {{"sessions", room_in(rig.scan.sessions)},
          {"copy", rig.scan.copy.empty() ? Json() : room_in(rig.scan.copy)},
          {"state", room_in(state)}};
}

/// Opens no device: a scan may begin at any moment, and then they are its own.
Json findings_of(const capture::Rig& rig, bool leaves_alone,
                 const std::vector<std::filesystem::path>& silent_archives) {
  Json findings = Json::array();
  for (const std::filesystem::path& archive : silent_archives) {
    findings.push_back(json_of(capture::fault_of(
        "archive", {ErrorKind::kInputOutput, "an archive does not answer", archive.string(),
                    "what was known of it stays in the library", "look whether its disk is there: df"})));
  }
  for (const capture::SetupFinding& found :
       leaves_alone || rig.leds == 0 ? std::vector<capture::SetupFinding>() : capture::examine_rig(rig, {})) {
    findings.push_back(json_of(found));
  }
  for (const capture::SetupFinding& found : capture::examine_folders(rig, capture::kFrameBytes))
    findings.push_back(json_of(found));
  return {{"rig", rig.name}, {"leaves_alone", leaves_alone}, {"findings", std::move(findings)}};
}

}  // namespace

Resource server_resource(const RigParts& parts) {
  const auto disk = std::make_shared<Awaited<Json>>(kDiskPatience);
  const auto doctor = std::make_shared<Awaited<Json>>(kDiskPatience);
  return {{{"GET", "/api/v1/healthz",
            [](const Call&) -> Result<Reply> {
              return json_reply({{"status", "ok"}});
            },
            false, Pool::kAtOnce},
           {"GET", "/api/v1/version", [&parts](const Call&) { return version(parts); }, false, Pool::kQuick},
           {"GET", "/api/v1/log", [&parts](const Call& call) { return read_lines(parts, call); }},
           {"GET", "/api/v1/disk",
            [&parts, disk](const Call&) -> Result<Reply> {
              const std::optional<Json> rooms =
                  disk->get([rig = parts.rig, state = parts.state] { return rooms_of(rig, state); });
              if (!rooms) return silent_disk();
              return json_reply(*rooms);
            }},
           {"GET", "/api/v1/doctor", [&parts, doctor](const Call&) -> Result<Reply> {
              const RigStatus status = parts.keeper.status();
              const bool is_ours = status.devices_open || !parts.keeper.session().empty();
              const std::optional<Json> found =
                  doctor->get([rig = parts.rig, is_ours, silent = parts.library.silent()] {
                    return findings_of(rig, is_ours, silent);
                  });
              if (found) return json_reply(*found);
              return json_reply({{"rig", parts.rig.name},
                                 {"leaves_alone", is_ours},
                                 {"findings", {json_of(capture::fault_of("disk", silent_disk()))}}});
            }}}};
}

}  // namespace weft::app
