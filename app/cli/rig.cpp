// SPDX-License-Identifier: Apache-2.0
#include "capture/rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "app/cli/exit_code.h"
#include "app/cli/opened_devices.h"
#include "app/cli/print_rig_plan.h"
#include "app/cli/rig_check.h"
#include "app/cli/rig_flash.h"
#include "app/cli/rig_new.h"
#include "app/cli/rig_options.h"
#include "app/cli/rig_owner.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "app/server/api/bodies/requests.h"
#include "app/server/api/bodies/scan_body.h"
#include "app/server/rig/rig_lock.h"
#include "capture/rig_devices/rig_devices.h"
#include "capture/scan/scan.h"
#include "core/base/files.h"
#include "core/base/percent.h"
#include "core/base/temporary_folder.h"
#include "core/describe/error_json.h"
#include "core/rig/exposure_words.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr int kSettledLooks = 3;

struct RigArguments {
  fs::path rig;
  std::vector<int> leds;  ///< of `lights` and `test`; empty: all
  double seconds = 1;     ///< of `lights`, each LED
  int led = 1;            ///< of `shot`; 0: none
  std::optional<double> exposure_us;
  fs::path output;  ///< of `shot`: a PNG; empty: none
};

std::vector<int> chosen_leds(const capture::Rig& rig, const RigArguments& arguments) {
  return arguments.leds.empty() ? request_of_rig(rig).leds : arguments.leds;
}

Result<int> show_status(const capture::Rig& rig, const RigArguments&, const CommonArguments& common) {
  const std::optional<SeenRig> seen = last_seen(rig);
  if (seen && !common.json) print(fmt::format("rig     {}, by {}", seen->look.says, seen->session));
  const auto board = capture::open_board(rig);
  if (!board) return board.error();
  const capture::BoardFacts& lamps = (*board)->facts();
  auto camera = capture::open_camera(rig);
  if (!camera) return std::move(camera).error();
  const Result<capture::CameraFacts> facts = (*camera)->connect();
  if (!facts) return facts.error();
  if (common.json) {
    print_json({{"rig", rig.name},
                {"place", seen ? Json{{"says", seen->look.says}, {"session", seen->session}} : Json()},
                {"board",
                 {{"port", rig.board.port},
                  {"firmware", fmt::format("{}.{}", lamps.firmware_major, lamps.firmware_minor)},
                  {"advice", capture::firmware_advice(lamps, rig.board.port)},
                  {"leds", lamps.leds},
                  {"began_from", capture::name_of(lamps.reset)}}},
                {"camera",
                 {{"model", facts->model},
                  {"serial", facts->serial},
                  {"port", facts->port},
                  {"battery", facts->battery},
                  {"exposure_us", facts->exposure.exposure_us},
                  {"iso", facts->exposure.iso},
                  {"f_number", facts->exposure.f_number},
                  {"clock_offset_s", facts->clock_offset_s}}}});
    return kDone;
  }
  print(fmt::format("board   {}: {}", rig.board.port, words_of(lamps, rig.board.port)));
  print(fmt::format("camera  {} {} at {}, battery {:.0f} %, {:.6g} s, ISO {:g}, f/{:g}, clock {:+.1f} s",
                    facts->model, facts->serial, facts->port, 100 * facts->battery,
                    1e-6 * facts->exposure.exposure_us, facts->exposure.iso, facts->exposure.f_number,
                    facts->clock_offset_s));
  return kDone;
}

Result<int> light_in_turn(const capture::Rig& rig, const RigArguments& arguments,
                          const CommonArguments& common) {
  const auto devices = OpenedDevices::open(rig);
  if (!devices) return devices.error();
  const std::stop_token stop = stop_on_signal();
  for (const int led : chosen_leds(rig, arguments)) {
    if (!common.json) print(fmt::format("LED {}", led));
    for (;;) {
      const Result<double> rest_s = (*devices)->hold(led, arguments.seconds, stop);
      if (!rest_s) return rest_s.error();
      if (*rest_s <= 0) break;
      if (!common.quiet) note(fmt::format("LED {} cools, {:.0f} s", led, std::ceil(*rest_s)));
      if (!wait_for(*rest_s, stop)) return interrupted();
    }
  }
  if (common.json) print_json({{"leds", chosen_leds(rig, arguments)}});
  return kDone;
}

/// One photograph that nobody keeps, but as a picture where one is asked for.
Result<int> take_test_shot(const capture::Rig& rig, const RigArguments& arguments,
                           const CommonArguments& common) {
  const auto devices = OpenedDevices::open(rig);
  if (!devices) return devices.error();
  const Result<Json> shot =
      (*devices)->shoot(arguments.led, arguments.exposure_us.value_or(kTestShot_us), stop_on_signal());
  if (!shot) return shot.error();
  if (!arguments.output.empty()) {
    const Result<std::string> picture = (*devices)->client().bytes(
        fmt::format("/api/v1/rig/test-shots/{}/picture", shot->at("id").get<int>()));
    if (!picture) return picture.error();
    if (Result<void> written = write_file(arguments.output, *picture); !written)
      return std::move(written).error();
  }
  if (common.json) {
    print_json(*shot);
    return kDone;
  }
  const auto clipped = shot->at("clipped_rgb").get<std::array<double, 3>>();
  print(fmt::format("LED {} at {}: clipped {} {} {} %", arguments.led,
                    exposure_words(shot->at("exposure_us").get<double>()), percent_words(clipped[0]),
                    percent_words(clipped[1]), percent_words(clipped[2])));
  if (const Json& suggested = shot->at("suggested_us"); suggested.is_number())
    print("a scan would expose " + exposure_words(suggested.get<double>()));
  return kDone;
}

/// The mean of a histogram, as share of the way from black to white.
double mean_of(const capture::RawHistogram& histogram) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < histogram.bins.size(); ++i) {
    sum += (static_cast<double>(i) + 0.5) * histogram.bins[i];
    count += histogram.bins[i];
  }
  return count > 0 ? sum / count / static_cast<double>(histogram.bins.size()) : 0;
}

/// A scan that nobody keeps.
Result<int> photograph_in_turn(const capture::Rig& rig, const RigArguments& arguments,
                               const CommonArguments& common) {
  Result<capture::RigDevices> devices = capture::open_devices(rig);
  if (!devices) return std::move(devices).error();
  const TemporaryFolder scratch;
  capture::ScanRequest request = request_of_rig(rig);
  request.session = scratch.path() / "test.weft";
  request.fabric = "test";
  request.copy.clear();
  request.leds = chosen_leds(rig, arguments);
  Json rows = Json::array();
  const auto show = [&](const capture::KeptFrame& frame) {
    const auto& rgb = frame.histogram_rgb;
    rows.push_back({{"led", frame.shot.led},
                    {"role", name_of(frame.shot.role)},
                    {"polariser", name_of(frame.shot.polariser)},
                    {"mean_rgb", {mean_of(rgb[0]), mean_of(rgb[1]), mean_of(rgb[2])}},
                    {"clipped_rgb", {rgb[0].clipped, rgb[1].clipped, rgb[2].clipped}},
                    {"warnings", frame.warnings}});
    if (common.json) return;
    print(fmt::format("{:8} mean {:5.1f} {:5.1f} {:5.1f} %  clipped {} %",
                      frame.shot.led > 0                    ? fmt::format("LED {}", frame.shot.led)
                      : frame.shot.role == ShotRole::kBelow ? "below"
                                                            : "dark",
                      100 * mean_of(rgb[0]), 100 * mean_of(rgb[1]), 100 * mean_of(rgb[2]),
                      percent_words(std::max({rgb[0].clipped, rgb[1].clipped, rgb[2].clipped}))));
    for (const std::string& warning : frame.warnings) print(fmt::format("{:8} {}", "", warning));
  };
  const Result<capture::ScanOutcome> outcome =
      capture::scan(request, *devices->lamps, *devices->camera, {.kept = show},
                    {.cancel = stop_on_signal(), .pause = nullptr});
  if (!outcome) return outcome.error();
  if (common.json) {
    print_json({{"rig", rig.name}, {"frames", rows}, {"warnings", outcome->warnings}});
  } else {
    for (const std::string& warning : outcome->warnings) note("weft: " + warning);
  }
  return kDone;
}

using Trial = Result<int> (*)(const capture::Rig& rig, const RigArguments& arguments,
                              const CommonArguments& common);

/// A trial by way of the rig's server, whoever else uses it.
Run run_shared(Trial trial, const std::shared_ptr<RigArguments>& a) {
  return [trial, a](const CommonArguments& common) -> Result<int> {
    const Result<capture::Rig> rig = capture::read_rig(find_rig(a->rig));
    if (!rig) return rig.error();
    return trial(*rig, *a, common);
  };
}

/// A trial of a rig that nobody else has meanwhile.
Run run_alone(Trial trial, const std::shared_ptr<RigArguments>& a) {
  return [trial, a](const CommonArguments& common) -> Result<int> {
    const Result<capture::Rig> rig = capture::read_rig(find_rig(a->rig));
    if (!rig) return rig.error();
    const Result<RigLock> lock = RigLock::take(*rig);
    if (!lock) return lock.error();
    return trial(*rig, *a, common);
  };
}

Run add_rig_status(Options& options) {
  const auto a = std::make_shared<RigArguments>();
  add_rig_file(options, a->rig);
  return run_alone(show_status, a);
}

Run add_rig_lights(Options& options) {
  const auto a = std::make_shared<RigArguments>();
  add_rig_file(options, a->rig);
  add_leds(options, a->leds);
  options.add("--seconds", &a->seconds, "That each LED is lit, s").shows_default().in_range(0.1, 30.0);
  return run_shared(light_in_turn, a);
}

Run add_rig_shot(Options& options) {
  const auto a = std::make_shared<RigArguments>();
  add_rig_file(options, a->rig);
  options.add("--led", &a->led, "The LED that is lit; 0: none").in_range(0, 10).shows_default();
  add_exposure(options, a->exposure_us, kLongestShot_us, exposure_words(kTestShot_us));
  options.add("-o,--output", &a->output, "Picture to write (PNG, at most 320 pixels)");
  return run_shared(take_test_shot, a);
}

void print_grid(const Json& grid, double factor, const char* pattern) {
  const auto columns = grid["columns"].get<std::size_t>();
  std::string line;
  for (std::size_t i = 0; i < grid["values"].size(); ++i) {
    const Json& value = grid["values"][i];
    line += value.is_number() ? fmt::format(fmt::runtime(pattern), factor * value.get<double>()) : "      -";
    if ((i + 1) % columns == 0) print(std::exchange(line, ""));
  }
}

/// What the finder sees of the table, and what the calibration knows of it.
Result<int> show_framing(const capture::Rig& rig, const RigArguments&, const CommonArguments& common) {
  const auto devices = OpenedDevices::open(rig);
  if (!devices) return devices.error();
  const RigClient& client = (*devices)->client();
  const Result<Json> known = client.get("/api/v1/rig/framing");
  if (!known && known.error().kind != ErrorKind::kNoInput) return known.error();
  if (const Result<Json> lit = client.post("/api/v1/rig/light", {{"round", true}}); !lit) return lit.error();
  Result<Json> seen = client.get("/api/v1/rig/live/framing?after=0");
  for (int look = 0; seen && look < kSettledLooks; ++look)  // the first ones may be from before the light
    seen = client.get(fmt::format("/api/v1/rig/live/framing?after={}", seen->at("frame").get<int>()));
  static_cast<void>(client.post("/api/v1/rig/light", {{"leds", Json::array()}}));
  if (!seen) return seen.error();
  if (common.json) {
    print_json({{"known", known ? *known : Json()}, {"seen", *seen}});
    return kDone;
  }
  if (known) {
    print(fmt::format("the camera sees {:.1f} x {:.1f} mm of the table", known->at("width_mm").get<double>(),
                      known->at("height_mm").get<double>()));
    if (!known->at("light").is_null()) {
      print("light on it, percent of the brightest place's:");
      print_grid(known->at("light"), 100, "{:>7.0f}");
    }
    if (!known->at("normal_deg").is_null()) {
      print("predicted error of normals 20 degrees steep, degrees:");
      print_grid(known->at("normal_deg"), 1, "{:>7.3f}");
    }
  }
  std::string tags = fmt::format("tags in sight: {}", seen->at("tags").size());
  if (const Json& off = seen->at("off_mm"); off.is_number()) {
    tags += fmt::format("; {} of {} that stay on the table, {:.1f} mm from where they belong",
                        seen->at("fiducials").get<int>(), known->at("tags").size(), off.get<double>());
  }
  print(tags);
  return kDone;
}

Run add_rig_framing(Options& options) {
  const auto a = std::make_shared<RigArguments>();
  add_rig_file(options, a->rig);
  return run_shared(show_framing, a);
}

Run add_rig_test(Options& options) {
  const auto a = std::make_shared<RigArguments>();
  add_rig_file(options, a->rig);
  add_leds(options, a->leds);
  return run_alone(photograph_in_turn, a);
}

}  // namespace

Verb rig_verb() {
  return {
      .name = "rig",
      .help = "Begin a rig, and try its parts",
      .verbs = {
          {"new", "Write a rig file that names the board and the camera that are plugged in", add_rig_new},
          {"status", "What board and camera say of themselves", add_rig_status},
          {"flash", "Put the light controller's firmware onto the Arduino at a port, by avrdude",
           add_rig_flash},
          {"check", "Has the rig moved since it was calibrated, by what scans show of it?", add_rig_check},
          {"lights", "Light the LEDs one after another", add_rig_lights},
          {"shot", "Take one photograph that is not kept: what is clipped, and a picture", add_rig_shot},
          {"plan", "What the LEDs tell of a cloth, and what one more, one moved or polarisers would",
           add_rig_plan},
          {"framing", "What is in sight, how it is lit, and whether the table's tags are where they belong",
           add_rig_framing},
          {"test", "Photograph the table under each LED: is each where it should be?", add_rig_test}}};
}

}  // namespace weft::app
