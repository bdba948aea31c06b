// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/doctor.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/cli/exit_code.h"
#include "app/cli/rig_devices.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"
#include "capture/rig.h"

namespace weft::app {
namespace {

// Of an uncompressed frame of 16 megapixels: what a session is reckoned with before one was taken.
constexpr std::uint64_t kFrameBytes = 33'000'000;

const char* word_of(Finding::Verdict verdict) {
  switch (verdict) {
    case Finding::Verdict::kFine:
      return "fine";
    case Finding::Verdict::kWarning:
      return "warning";
    case Finding::Verdict::kFault:
      return "fault";
  }
  return "";
}

void append(std::vector<Finding>& all, std::vector<Finding> more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

std::vector<Finding> examine(const capture::Rig& rig) {
  std::vector<Finding> found = examine_ports(rig);
  const Opened open = {.board = [&]() -> Result<std::string> {
                         const auto board = open_board(rig);
                         if (!board) return board.error();
                         return words_of((*board)->facts());
                       },
                       .camera = [&]() -> Result<capture::CameraFacts> {
                         auto camera = open_camera(rig);
                         if (!camera) return std::move(camera).error();
                         return (*camera)->connect();
                       }};
  // What holds a device says more than that it cannot be opened.
  const bool taken = std::any_of(found.begin(), found.end(),
                                 [](const Finding& f) { return f.verdict == Finding::Verdict::kFault; });
  if (!taken) append(found, examine_devices(rig, open));
  append(found, examine_folders(rig, kFrameBytes));
  return found;
}

}  // namespace

Result<int> run_doctor(const DoctorArguments& arguments, const CommonArguments& common) {
  const Result<capture::Rig> rig = capture::read_rig(find_rig(arguments.rig));
  if (!rig) return rig.error();
  const std::vector<Finding> found = examine(*rig);
  Json rows = Json::array();
  for (const Finding& f : found) {
    rows.push_back(
        {{"part", f.part}, {"verdict", word_of(f.verdict)}, {"says", f.says}, {"remedy", f.remedy}});
    if (common.json) continue;
    print(fmt::format("{:8} {:12} {}", word_of(f.verdict), f.part, f.says));
    if (!f.remedy.empty()) print(fmt::format("{:21} -> {}", "", f.remedy));
  }
  if (common.json) print_json({{"rig", rig->name}, {"findings", rows}});
  const bool faulty = std::any_of(found.begin(), found.end(),
                                  [](const Finding& f) { return f.verdict == Finding::Verdict::kFault; });
  return faulty ? kNoDeviceError : kDone;
}

}  // namespace weft::app
