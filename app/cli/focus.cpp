// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/exit_code.h"
#include "app/cli/opened_devices.h"
#include "app/cli/rig_options.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "app/server/api/bodies/requests.h"
#include "core/describe/error_json.h"
#include "core/rig/exposure_words.h"

namespace weft::app {
namespace {

constexpr int kBar = 30;            // characters of the sharpest
constexpr double kAskew = 0.1;      // an edge sharper than the other by this is spoken of
constexpr double kWarmAgain_s = 2;  // until a LED that must rest is asked again
constexpr int kPast = 3;            // so many photographs after the sharpest one: turned too far

struct FocusArguments {
  std::filesystem::path rig;
  int led = 1;
  std::optional<double> exposure_us;
  int shots = 0;
};

std::string words_of_tilt(const Json& focus) {
  std::string words;
  const auto add = [&](const Json& more, const char* if_more, const char* if_less) {
    if (!more.is_number() || std::abs(more.get<double>()) < kAskew) return;
    words += fmt::format("  sharper {}", more.get<double>() > 0 ? if_more : if_less);
  };
  add(focus["more_right"], "right", "left");
  add(focus["more_below"], "below", "above");
  return words;
}

/// One photograph, a line: its score, a bar over the sharpest, and what to do.
std::string line_of(int number, const Json& focus) {
  const Json& scores = focus["scores"];
  const Json& last = scores.back();
  if (!last.is_number()) return fmt::format("{:>4}  too dark or too full to tell", number);
  const auto best = focus["best"].get<std::size_t>();
  const double most = scores[best].get<double>();
  const double share = most > 0 ? last.get<double>() / most : 0;
  const std::size_t since = scores.size() - 1 - best;
  std::string bar(static_cast<std::size_t>(std::lround(kBar * share)), '#');
  return fmt::format("{:>4}  {:<9.3g} {:>4.0f} %  {:<{}}{}{}", number, last.get<double>(), 100 * share, bar,
                     kBar,
                     since == 0       ? "  sharpest so far"
                     : since >= kPast ? fmt::format("  {} back was sharper: turn back", since)
                                      : "",
                     words_of_tilt(focus));
}

/// Each cell over the sharpest that it was, in percent, as it lies in the picture.
void print_map(const Json& focus) {
  const auto columns = focus["columns"].get<std::size_t>();
  const Json& cells = focus["relative"];
  for (std::size_t row = 0; row < cells.size() / columns; ++row) {
    std::string line;
    for (std::size_t column = 0; column < columns; ++column) {
      const Json& cell = cells[row * columns + column];
      line += cell.is_number() ? fmt::format("{:>5.0f}", 100 * cell.get<double>()) : "    -";
    }
    print(line);
  }
}

Result<int> focus(const FocusArguments& arguments, const CommonArguments& common) {
  const Result<capture::Rig> rig = capture::read_rig(find_rig(arguments.rig));
  if (!rig) return rig.error();
  const auto devices = OpenedDevices::open(*rig);
  if (!devices) return devices.error();
  const std::stop_token stop = stop_on_signal();
  const double exposure_us = arguments.exposure_us.value_or(rig->scan.exposure_us.value_or(kTestShot_us));
  if (!common.json && !common.quiet)
    note("turn the focus ring a little after each photograph; Ctrl-C when the sharpest is found");
  Json last;
  for (int taken = 0; !stop.stop_requested() && (arguments.shots == 0 || taken < arguments.shots);) {
    const Result<Json> shot = (*devices)->shoot(arguments.led, exposure_us, stop);
    if (!shot && shot.error().kind == ErrorKind::kInterrupted) break;
    if (!shot && shot.error().kind == ErrorKind::kTryAgain) {
      note(shot.error().message());
      static_cast<void>(wait_for(kWarmAgain_s, stop));
      continue;
    }
    if (!shot) return shot.error();
    if (shot->at("focus").is_null()) return error_of_json(shot->at("error"), rig->name);
    last = shot->at("focus");
    ++taken;
    if (!common.json) print(line_of(taken, last));
  }
  if (last.is_null()) return interrupted();
  if (common.json) {
    print_json(last);
  } else {
    print("each part of the picture, in percent of the sharpest that it was:");
    print_map(last);
  }
  return kDone;
}

Run add_focus(Options& options) {
  const auto a = std::make_shared<FocusArguments>();
  add_rig_file(options, a->rig);
  options.add("--led", &a->led, "The LED that is lit; 0: none, by the room's light")
      .in_range(0, 10)
      .shows_default();
  add_exposure(options, a->exposure_us, kLongestShot_us,
               "the rig file's, else " + exposure_words(kTestShot_us));
  options.add("--shots", &a->shots, "Photographs until it ends; 0: until Ctrl-C")
      .in_range(0, 100000)
      .shows_default();
  return [a](const CommonArguments& common) { return focus(*a, common); };
}

}  // namespace

Verb focus_verb() {
  return {"focus", "Photograph the cloth again and again while the lens is focused: how sharp, and where",
          add_focus};
}

}  // namespace weft::app
