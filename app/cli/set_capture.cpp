// SPDX-License-Identifier: Apache-2.0
#include "app/cli/set_capture.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "app/cli/opened_devices.h"
#include "app/cli/terminal.h"
#include "core/base/files.h"
#include "core/describe/error_json.h"

namespace weft::app {
namespace {

constexpr const char* kWork = "/api/v1/calibrations/work";
constexpr double kAsked_s = 0.1;  // between looks at a photograph under way

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

/// The photograph that a step took; null where there is none.
Json taken_by(const Json& set, const std::string& step) {
  for (const Json& photograph : set["photographs"]) {
    const std::string name = photograph["name"];
    if (name == step || name.starts_with(step + ".")) return photograph;
  }
  return Json();
}

}  // namespace

Result<void> SetCapture::took(Result<Json> document) {
  if (!document) return std::move(document).error();
  if (document->is_null()) {
    return Error{ErrorKind::kTryAgain, "the set is worked on no more", "calibrations/work",
                 "the daemon began anew", "give the same command again: the set is as it was"};
  }
  set_ = std::move(*document);
  return {};
}

Result<void> SetCapture::begin(const SetArguments& a) {
  Json body = {{"part", a.part}};
  if (!a.name.empty()) body["name"] = a.name;
  if (!a.from.empty()) body["from"] = absolute_folder(a.from).string();
  if (!a.description.empty()) {
    const Result<std::string> text = read_text(a.description);
    if (!text) return text.error();
    body["description"] = *text;
  }
  last_.clear();
  return took(client_.post(kWork, body));
}

Result<void> SetCapture::leave_out(const std::string& name, bool out) {
  return took(client_.post(std::string(kWork) + "/leave-out", {{"name", name}, {"out", out}}));
}

Result<bool> SetCapture::photograph(const std::stop_token& stop) {
  const std::string step = set_["next"]["name"];
  if (Result<void> begun = took(client_.post(std::string(kWork) + "/photograph", Json::object())); !begun)
    return begun.error();
  if (Result<void> ended = wait(stop); !ended) return ended.error();
  if (!set_["error"].is_null()) return error_of_json(set_["error"], step);
  const Json photograph = taken_by(set_, step);
  if (photograph.is_null()) return true;
  last_ = photograph["name"];
  if (!common_.json) print("  " + line_of_photograph(photograph));
  const bool is_used = photograph["used"];
  if (is_used && !is_complete()) after_each_();
  return is_used;
}

Result<void> SetCapture::wait(const std::stop_token& stop) {
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

Result<bool> SetCapture::converse(const std::stop_token& stop) {
  note(
      "Enter: take it; u: leave the last one out; x NAME: leave one out; b NAME: take it back; e: enough, "
      "go on with what there is; q: stop here, the same command goes on later");
  while (!is_complete()) {
    print_progress();
    const std::optional<std::string> line = typed_line(stop);
    if (!line || *line == "q") return false;
    if (*line == "e") return true;
    const Result<void> done = obey(*line, stop);
    if (done) continue;
    if (done.error().kind == ErrorKind::kInterrupted) return done.error();
    complain(done.error());
  }
  return true;
}

Result<void> SetCapture::obey(const std::string& line, const std::stop_token& stop) {
  if (line.starts_with("x ") || line.starts_with("b "))
    return leave_out(line.substr(2), line.starts_with('x'));
  if (line == "u" && !last_.empty()) return leave_out(last_, true);
  if (line.empty()) {
    const Result<bool> taken = photograph(stop);
    return taken ? Result<void>() : taken.error();
  }
  note(line == "u" ? "nothing was taken yet; x NAME leaves out what was taken before"
                   : "that is none of Enter, u, x NAME, b NAME, e, q");
  return {};
}

void SetCapture::print_progress() const {
  print_figures(set_);
  if (!is_complete()) print_next();
}

void SetCapture::print_next() const {
  print(fmt::format("next ({}): {}", set_["next"]["name"].get<std::string>(),
                    set_["next"]["says"].get<std::string>()));
}

void SetCapture::print_standing() const {
  print(set_["folder"].get<std::string>());
  for (const Json& photograph : set_["photographs"]) print("  " + line_of_photograph(photograph));
  print_figures(set_);
  print_coverage(set_);
}

}  // namespace weft::app
