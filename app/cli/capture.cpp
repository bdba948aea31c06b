// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "app/cli/exit_code.h"
#include "app/cli/opened_devices.h"
#include "app/cli/rig_options.h"
#include "app/cli/set_capture.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "app/server/rig/rig_lock.h"
#include "calibration/guide/photograph_set.h"

namespace weft::app {
namespace {

struct CaptureArguments {
  SetArguments set;
  std::filesystem::path rig;
  std::string leave_out, take_back;
  bool once = false, show = false;
};

/// The command that makes a calibration of a set.
std::string next_command(const Json& set) {
  const std::string part = set["part"], folder = set["folder"], from = set["from"];
  const std::string what = part == "board"      ? "camera {}"
                           : part == "response" ? "response {}"
                           : part == "trap"     ? "response RESPONSE --trap {}"
                           : part == "sheet"    ? "lights {}"
                           : part == "chart"    ? "color {}"
                           : part == "moved"    ? "update {}"
                                                : "check {}";
  return fmt::format("weft calibrate {}{} -o NEW", fmt::format(fmt::runtime(what), folder),
                     from.empty() ? "" : " --from " + from);
}

/// What is there, as far as it was not said yet, and what comes next.
void print_end(const SetCapture& capture, bool is_all_new) {
  is_all_new ? capture.print_standing() : capture.print_progress();
  if (capture.is_complete()) {
    print("all is there. next: " + next_command(capture.set()));
  } else if (is_all_new) {
    capture.print_next();
  }
}

Result<int> capture(const CaptureArguments& a, const CommonArguments& common) {
  const Result<capture::Rig> rig = capture::read_rig(find_rig(a.rig));
  if (!rig) return rig.error();
  const bool only_looks = a.show || !a.leave_out.empty() || !a.take_back.empty();
  std::unique_ptr<OpenedDevices> devices;
  std::optional<ReachedRig> reached;
  if (only_looks) {
    const Result<std::optional<std::string>> owner = address_of_owner(*rig);
    if (!owner) return owner.error();
    Result<ReachedRig> found = reach_rig(*rig, *owner);
    if (!found) return std::move(found).error();
    reached.emplace(std::move(*found));
  } else {
    auto opened = OpenedDevices::open(*rig);
    if (!opened) return opened.error();
    devices = std::move(*opened);
  }
  SetCapture capture(devices ? devices->client() : reached->client, common);
  if (Result<void> begun = capture.begin(a.set); !begun) return begun.error();
  const std::stop_token stop = stop_on_signal();
  Result<int> code = kDone;
  if (!a.leave_out.empty() || !a.take_back.empty()) {
    const bool out = !a.leave_out.empty();
    if (Result<void> done = capture.leave_out(out ? a.leave_out : a.take_back, out); !done)
      return done.error();
  } else if (a.once && !capture.is_complete()) {
    const Result<bool> is_used = capture.photograph(stop);
    if (!is_used) return is_used.error();
    code = *is_used ? kDone : kDoneWithWarnings;
  } else if (!only_looks && !a.once) {
    const Result<bool> is_complete = capture.converse(stop);
    if (!is_complete) return is_complete.error();
    if (!*is_complete) return kDone;
  }
  if (common.json) {
    print_json(capture.set());
  } else {
    print_end(capture, only_looks);
  }
  return code;
}

template <calibration::SetPart kPart>
Run add_capture(Options& options) {
  const std::string part = name_of(kPart);
  const auto a = std::make_shared<CaptureArguments>();
  a->set.part = part;
  add_rig_file(options, a->rig);
  options.add("--name", &a->set.name,
              "Folder of the set in sets/ beside the rig file; default the part's name");
  options.add("--from", &a->set.from, "Calibration that was known before; default the rig's");
  if (part == "board" || part == "sheet" || part == "check" || part == "moved" || part == "chart") {
    const char* file = part == "board" ? "board.toml" : part == "chart" ? "chart.toml" : "sheet.toml";
    options.add(part == "board"   ? "--board"
                : part == "chart" ? "--chart"
                                  : "--sheet",
                &a->set.description, fmt::format("{}: what it is (docs/calibration.md); needed once", file));
  }
  options.add_flag("--once", &a->once, "Take what comes next and end: 0, or 2 where it is of no use");
  options.add_flag("--show", &a->show, "Show what is there and what comes next");
  options.add("--leave-out", &a->leave_out, "Leave this photograph of the set out");
  options.add("--take-back", &a->take_back, "Take one back that was left out");
  return [a](const CommonArguments& common) { return capture(*a, common); };
}

}  // namespace

Verb capture_verb() {
  return {.name = "capture",
          .help = "Take the photographs that a calibration needs, told one by one what to do",
          .verbs = {
              {"board", "A board in the poses that tell most of the camera",
               add_capture<calibration::SetPart::kBoard>},
              {"response", "Pairs of photographs at several exposures, lit and dark",
               add_capture<calibration::SetPart::kResponse>},
              {"trap", "White paper with a black trap in its middle: the lens's veil",
               add_capture<calibration::SetPart::kTrap>},
              {"sheet", "A white sheet in five poses: where the LEDs are",
               add_capture<calibration::SetPart::kSheet>},
              {"chart", "The colour chart", add_capture<calibration::SetPart::kChart>},
              {"check", "Other sheets, to prove a calibration by", add_capture<calibration::SetPart::kCheck>},
              {"moved", "A sheet among the table's tags: what of the rig was knocked",
               add_capture<calibration::SetPart::kMoved>}}};
}

}  // namespace weft::app
