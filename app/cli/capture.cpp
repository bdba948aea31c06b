// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/exit_code.h"
#include "app/cli/opened_devices.h"
#include "app/cli/rig_options.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"
#include "app/jobs/sets/photograph_set.h"
#include "app/server/rig/rig_lock.h"
#include "core/error_json.h"
#include "core/files.h"

namespace weft::app {
namespace {

constexpr const char* kWork = "/api/v1/calibrations/work";
constexpr double kAsked_s = 0.1;  // between looks at a photograph under way

struct CaptureArguments {
  std::string part;
  std::filesystem::path rig, description, from;
  std::string name, leave_out, take_back;
  bool once = false, show = false;
};

/// The command that makes a calibration of a set.
std::string next_command(const Json& set) {
  const std::string part = set["part"], folder = set["folder"], from = set["from"];
  const char* step = part == "board"                        ? "camera"
                     : part == "response" || part == "trap" ? "response"
                     : part == "sheet"                      ? "lights"
                     : part == "chart"                      ? "color"
                                                            : "check";
  return fmt::format("weft calibrate {} {}{} -o NEW", step, folder, from.empty() ? "" : " --from " + from);
}

std::string line_of_photograph(const Json& photograph) {
  const std::string name = photograph["name"];
  if (!photograph["used"])
    return fmt::format("{:<16} not used: {}", name, photograph["why"].get<std::string>());
  const Json& facts = photograph["facts"];
  std::string words = fmt::format("{:<16} taken", name);
  const auto add = [&](const char* key, const char* pattern) {
    if (const auto found = facts.find(key); found != facts.end() && found->is_number())
      words += fmt::format(fmt::runtime(pattern), found->get<double>());
  };
  add("corners", ", {:.0f} corners");
  add("rms_px", ", {:.2f} px rms");
  add("tags", ", {:.0f} tags");
  add("tilt_deg", ", tilted by {:.1f} degrees");
  add("photographs", ", {:.0f} photographs");
  if (const auto said = facts.find("note"); said != facts.end()) words += "; " + said->get<std::string>();
  return words;
}

void print_figures(const Json& set) {
  const Json& figures = set["figures"];
  if (!figures.contains("predicted")) return;
  const Json &now = figures["predicted"], &asked = figures["asked"], &coverage = figures["coverage"];
  print(fmt::format(
      "  focal length {:.3g} % (asked {:g}), a pixel's place {:.3g} mm (asked {:g}), {} of {} "
      "parts of the picture seen",
      now["focal_percent"].get<double>(), asked["focal_percent"].get<double>(), now["place_mm"].get<double>(),
      asked["place_mm"].get<double>(), coverage["seen"].get<int>(), coverage["corners"].size()));
}

/// Corners by part of the picture, as it lies before the eyes.
void print_coverage(const Json& set) {
  if (!set["figures"].contains("coverage")) return;
  const Json& coverage = set["figures"]["coverage"];
  const auto columns = coverage["columns"].get<std::size_t>();
  for (std::size_t i = 0; i < coverage["corners"].size(); i += columns) {
    std::string line = " ";
    for (std::size_t column = 0; column < columns; ++column)
      line += fmt::format("{:>5}", coverage["corners"][i + column].get<int>());
    print(line);
  }
}

void print_next(const Json& set) {
  if (set["next"].is_null()) {
    print("all is there. next: " + next_command(set));
  } else {
    print(fmt::format("next ({}): {}", set["next"]["name"].get<std::string>(),
                      set["next"]["says"].get<std::string>()));
  }
}

void print_standing(const Json& set) {
  print(set["folder"].get<std::string>());
  for (const Json& photograph : set["photographs"]) print("  " + line_of_photograph(photograph));
  print_figures(set);
  print_coverage(set);
  print_next(set);
}

/// The photograph that a step took; null where there is none.
Json taken_by(const Json& set, const std::string& step) {
  for (const Json& photograph : set["photographs"]) {
    const std::string name = photograph["name"];
    if (name == step || name.starts_with(step + ".")) return photograph;
  }
  return Json();
}

class Capture {
 public:
  Capture(const RigClient& client, const CommonArguments& common) : client_(client), common_(common) {}

  Result<void> begin(const CaptureArguments& a) {
    Json body = {{"part", a.part}, {"name", a.name}};
    if (!a.from.empty()) body["from"] = absolute_folder(a.from).string();
    if (!a.description.empty()) {
      const Result<std::string> text = read_text(a.description);
      if (!text) return text.error();
      body["description"] = *text;
    }
    return took(client_.post(kWork, body));
  }

  Result<void> leave_out(const std::string& name, bool out) {
    return took(client_.post(std::string(kWork) + "/leave-out", {{"name", name}, {"out", out}}));
  }

  /// What comes next; false where the photograph is of no use.
  Result<bool> photograph(const std::stop_token& stop) {
    const std::string step = set_["next"]["name"];
    if (Result<void> begun = took(client_.post(std::string(kWork) + "/photograph", Json::object())); !begun)
      return begun.error();
    if (Result<void> ended = wait(stop); !ended) return ended.error();
    if (!set_["error"].is_null()) return error_of_json(set_["error"], step);
    const Json photograph = taken_by(set_, step);
    if (photograph.is_null()) return true;
    last_ = photograph["name"];
    if (!common_.json) print("  " + line_of_photograph(photograph));
    return photograph["used"].get<bool>();
  }

  const Json& set() const { return set_; }
  const std::string& last() const { return last_; }
  bool is_complete() const { return set_["next"].is_null(); }

 private:
  Result<void> took(Result<Json> document) {
    if (!document) return std::move(document).error();
    set_ = std::move(*document);
    return {};
  }

  Result<void> wait(const std::stop_token& stop) {
    ProgressLine line(common_.quiet || common_.json);
    bool is_cancelled = false;
    while (set_["busy"]) {
      if (!wait_for(kAsked_s, stop) && !std::exchange(is_cancelled, true))
        static_cast<void>(client_.post("/api/v1/scan/cancel", Json::object()));
      if (is_cancelled) static_cast<void>(wait_for(kAsked_s, {}));
      if (const Result<Json> rig = client_.get("/api/v1/rig"); rig && rig->value("frames_planned", 0) > 0)
        line.update("photographs", rig->value("frames", 0.0) / rig->value("frames_planned", 1.0));
      if (Result<void> looked = took(client_.get(kWork)); !looked) return looked;
    }
    return is_cancelled ? Result<void>(interrupted()) : Result<void>();
  }

  const RigClient& client_;
  const CommonArguments& common_;
  Json set_;
  std::string last_;
};

/// A line that a person typed; nothing at the end of input or when stopped.
std::optional<std::string> typed_line(const std::stop_token& stop) {
  std::string line;
  while (!stop.stop_requested()) {
    pollfd waiting = {STDIN_FILENO, POLLIN, 0};
    if (::poll(&waiting, 1, 100) <= 0) continue;
    char c = 0;
    if (::read(STDIN_FILENO, &c, 1) != 1) return std::nullopt;
    if (c == '\n') return line;
    line += c;
  }
  return std::nullopt;
}

/// Photographs at the Enter key until all is there.
Result<int> converse(Capture& capture, const std::stop_token& stop) {
  note(
      "Enter: take it; u: leave the last one out; x NAME: leave one out; b NAME: take it back; q: stop here, "
      "the same command goes on later");
  while (!capture.is_complete()) {
    print_figures(capture.set());
    print_next(capture.set());
    const std::optional<std::string> line = typed_line(stop);
    if (!line || *line == "q") return kDone;
    Result<void> done;
    if (line->starts_with("x ") || line->starts_with("b ")) {
      done = capture.leave_out(line->substr(2), line->starts_with('x'));
    } else if (*line == "u" && capture.last().empty()) {
      note("nothing was taken yet; x NAME leaves out what was taken before");
    } else if (*line == "u") {
      done = capture.leave_out(capture.last(), true);
    } else if (line->empty()) {
      if (const Result<bool> taken = capture.photograph(stop); !taken) done = taken.error();
    } else {
      note("that is none of Enter, u, x NAME, b NAME, q");
    }
    if (done) continue;
    if (done.error().kind == ErrorKind::kInterrupted) return done.error();
    complain(done.error());
  }
  print_figures(capture.set());
  print_next(capture.set());
  return kDone;
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
  Capture capture(devices ? devices->client() : reached->client, common);
  if (Result<void> begun = capture.begin(a); !begun) return begun.error();
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
    return converse(capture, stop);
  }
  if (common.json) {
    print_json(capture.set());
  } else if (a.once) {
    print_figures(capture.set());
    print_next(capture.set());
  } else {
    print_standing(capture.set());
  }
  return code;
}

template <SetPart kPart>
Run add_capture(Options& options) {
  const std::string part = name_of(kPart);
  const auto a = std::make_shared<CaptureArguments>();
  a->part = part;
  add_rig_file(options, a->rig);
  options.add("--name", &a->name, "Folder of the set in sets/ beside the rig file; default the part's name");
  options.add("--from", &a->from, "Calibration that was known before; default the rig's");
  if (part == "board" || part == "sheet" || part == "check" || part == "chart") {
    const char* file = part == "board" ? "board.toml" : part == "chart" ? "chart.toml" : "sheet.toml";
    options.add(part == "board"   ? "--board"
                : part == "chart" ? "--chart"
                                  : "--sheet",
                &a->description, fmt::format("{}: what it is (docs/calibration.md); needed once", file));
  }
  options.add_flag("--once", &a->once, "Take what comes next and end: 0, or 2 where it is of no use");
  options.add_flag("--show", &a->show, "Show what is there and what comes next");
  options.add("--leave-out", &a->leave_out, "Leave this photograph of the set out");
  options.add("--take-back", &a->take_back, "Take one back that was left out");
  return [a](const CommonArguments& common) { return capture(*a, common); };
}

}  // namespace

Verb capture_verb() {
  return {
      .name = "capture",
      .help = "Take the photographs that a calibration needs, told one by one what to do",
      .verbs = {{"board", "A board in the poses that tell most of the camera", add_capture<SetPart::kBoard>},
                {"response", "Pairs of photographs at several exposures, lit and dark",
                 add_capture<SetPart::kResponse>},
                {"trap", "White paper with a black trap in its middle: the lens's veil",
                 add_capture<SetPart::kTrap>},
                {"sheet", "A white sheet in five poses: where the LEDs are", add_capture<SetPart::kSheet>},
                {"chart", "The colour chart", add_capture<SetPart::kChart>},
                {"check", "Other sheets, to prove a calibration by", add_capture<SetPart::kCheck>}}};
}

}  // namespace weft::app
