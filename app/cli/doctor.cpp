// SPDX-License-Identifier: Apache-2.0
#include "capture/doctor/doctor.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "app/cli/exit_code.h"
#include "app/cli/rig_options.h"
#include "app/cli/rig_owner.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "app/server/rig/rig_lock.h"
#include "capture/rig.h"
#include "capture/rig_devices/rig_devices.h"

namespace weft::app {
namespace {

bool is_fault(const capture::SetupFinding& finding) {
  return finding.verdict == capture::SetupFinding::Verdict::kFault;
}

void append(std::vector<capture::SetupFinding>& all, std::vector<capture::SetupFinding> more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

std::vector<capture::SetupFinding> examine_devices(const capture::Rig& rig) {
  return capture::examine_rig(rig, {.board = [&]() -> Result<std::string> {
                                      const auto board = capture::open_board(rig);
                                      if (!board) return board.error();
                                      return words_of((*board)->facts(), rig.board.port);
                                    },
                                    .camera = [&]() -> Result<capture::CameraFacts> {
                                      auto opened = capture::open_camera(rig);
                                      if (!opened) return std::move(opened).error();
                                      return (*opened)->connect();
                                    }});
}

/// What the process that owns the rig says of it; its devices are its own.
Result<capture::SetupFinding> ask_owner(const capture::Rig& rig, const std::string& address) {
  const Result<RigClient> client = connect_to_owner(rig, address);
  if (!client) return client.error();
  const Result<Json> status = client->get("/api/v1/rig");
  if (!status) return status.error();
  std::string says = fmt::format("weft (process {}) owns the rig and is {}", status->at("lock")["pid"].dump(),
                                 status->at("state").get<std::string>());
  if (status->at("state") != "idle" && status->at("session").is_string()) {
    says += fmt::format(": {}, {} of {} frames", status->at("session").get<std::string>(),
                        status->at("frames").get<int>(), status->at("frames_planned").get<int>());
  }
  const std::string why = status->at("why").get<std::string>();
  if (status->at("state") != "idle" && !why.empty()) says += ": " + why;
  return capture::SetupFinding{capture::SetupFinding::Verdict::kFine, "daemon",
                               says + "; board and camera are left alone", ""};
}

std::vector<capture::SetupFinding> examine(const capture::Rig& rig) {
  std::vector<capture::SetupFinding> found;
  const Result<std::optional<std::string>> owner = address_of_owner(rig);
  if (!owner) {
    found.push_back(capture::fault_of("daemon", owner.error()));
  } else if (*owner) {
    const Result<capture::SetupFinding> said = ask_owner(rig, **owner);
    found.push_back(said ? *said : capture::fault_of("daemon", said.error()));
  } else if (const Result<RigLock> lock = RigLock::take(rig); !lock) {
    found.push_back(capture::fault_of("rig", lock.error()));
  } else {
    found = examine_devices(rig);
  }
  append(found, capture::examine_folders(rig, capture::kFrameBytes));
  return found;
}

Result<int> examine_and_print(const std::filesystem::path& rig_file, const CommonArguments& common) {
  // Without a file that can be read the machine is looked at all the same, for what a rig has by default.
  const Result<capture::Rig> read = capture::read_rig(find_rig(rig_file));
  const capture::Rig rig = read ? *read : capture::Rig();
  std::vector<capture::SetupFinding> found;
  if (!read) {
    found.push_back(capture::fault_of("rig file", read.error()));
    if (read.error().kind == ErrorKind::kNoInput) found.back().remedy = "weft rig new NAME writes one";
  }
  append(found, read ? examine(rig) : examine_devices(rig));
  Json rows = Json::array();
  for (const capture::SetupFinding& f : found) {
    rows.push_back(json_of(f));
    if (common.json) continue;
    print(fmt::format("{:8} {:12} {}", name_of(f.verdict), f.part, f.says));
    if (!f.remedy.empty()) print(fmt::format("{:21} -> {}", "", f.remedy));
  }
  if (common.json) print_json({{"rig", rig.name}, {"findings", rows}});
  const auto first = std::find_if(found.begin(), found.end(), is_fault);
  return first == found.end() ? kDone : exit_code_of(first->kind);
}

Run add_doctor(Options& options) {
  const auto rig_file = std::make_shared<std::filesystem::path>();
  add_rig_file(options, *rig_file);
  return [rig_file](const CommonArguments& common) { return examine_and_print(*rig_file, common); };
}

}  // namespace

Verb doctor_verb() {
  return {"doctor", "What is wrong with this machine's set-up for a rig, and the command that mends it",
          add_doctor};
}

}  // namespace weft::app
