// SPDX-License-Identifier: Apache-2.0
#include "capture/rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/describe/fields.h"
#include "core/rig/calibration.h"
#include "core/toml/field_toml.h"
#include "core/toml/toml_json.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPage = "docs/rig.md";
constexpr int kMostLeds = 10;
constexpr double kFarthest_mm = 1e5;
constexpr NumberRange kExposure_us = {1, 1e9};

/// A path of the file, made absolute; empty stays empty.
fs::path beside(const fs::path& file, const std::string& path) {
  return path.empty() ? fs::path() : (file.parent_path() / path).lexically_normal();
}

Vec3 vec3(const std::vector<double>& xyz) {
  return {xyz[0], xyz[1], xyz[2]};
}

bool is_plain_name(const std::string& name) {
  return !name.empty() && name.find('/') == std::string::npos;
}

/// An LED as [[led]] has it.
struct LedEntry {
  std::vector<double> position_mm, aim;
  double mu = 1;
};

void describe(Fields& fields, LedEntry& led) {
  fields.value({.name = "position_mm",
                .says = "Where it is in the rig frame, mm",
                .need = kMustSay,
                .fewest = 3,
                .most = 3},
               led.position_mm);
  const std::vector<double>& at = led.position_mm;
  fields.require(at.size() != 3 || (at[2] >= 1 && length(vec3(at)) < kFarthest_mm), "position_mm",
                 "must be at least 1 mm above the table");
  fields.value({.name = "aim",
                .says = "Its axis; default at the table's centre",
                .need = kUnlessEmpty,
                .fewest = 3,
                .most = 3},
               led.aim);
  fields.require(led.aim.size() != 3 || length(vec3(led.aim)) > 0, "aim", "must have a length");
  fields.value({"mu", "How narrow its lobe is, cosine to this power", {0, 100}}, led.mu);
}

bool is_host_name(std::string_view name) {
  return !name.empty() && name.size() <= 253 && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '-';
  });
}

bool is_origin(std::string_view origin) {
  const bool plain = origin.starts_with("http://");
  if (!plain && !origin.starts_with("https://")) return false;
  const std::string_view host = origin.substr(plain ? 7 : 8);
  const std::size_t colon = host.find(':');
  return is_host_name(host.substr(0, colon)) &&
         (colon == host.npos || host.find_first_not_of("0123456789", colon + 1) == host.npos);
}

}  // namespace

void describe(Fields& fields, Rig::Board& board) {
  fields.value({"port", "Any name that leads to the LED board"}, board.port);
  fields.require(!board.port.empty(), "port", "must not be empty");
}

void describe(Fields& fields, Rig::Camera& camera) {
  fields.value({"profile", "Built in, or a profile beside this file"}, camera.profile);
  fields.value({"port", "usb:BUS,DEVICE or ptpip:ADDRESS:PORT:PORT; empty: found on USB"}, camera.port);
  const std::string& port = camera.port;
  fields.require(port.empty() || port.starts_with("usb:") || port.starts_with("ptpip:"), "port",
                 "must be empty, usb:BUS,DEVICE or ptpip:ADDRESS:PORT:PORT");
  fields.value({"serial", "Of the body; empty: the calibration's"}, camera.serial);
}

void describe(Fields& fields, Rig::Below& below) {
  fields.value({"exposure_us", "Of the light below, us; default metered for each cloth", kExposure_us},
               below.exposure_us);
}

void describe(Fields& fields, Rig::PolariserFilm& film) {
  std::vector<std::string> names;
  for (const Polariser state : film.states) names.emplace_back(name_of(state));
  fields.value({.name = "states",
                .says = "What each scan photographs the LEDs in, one after the other; the first is solved",
                .need = kUnlessEmpty,
                .words = {"crossed", "parallel"}},
               names);
  const bool is_each_once = names.size() < 2 || (names.size() == 2 && names[0] != names[1]);
  fields.require(is_each_once, "states", "must be \"crossed\", \"parallel\" or both");
  film.states.clear();
  for (const std::string& name : names) film.states.push_back(polariser_of(name).value_or(Polariser::kNone));
  fields.value({"settle_s", "From the command to turn until it stands, s", {0, 60}}, film.settle_s);
}

void describe(Fields& fields, Rig::Scan& scan) {
  fields.value({"calibration", "Its folder"}, scan.calibration);
  fields.value({"iso", "Of all photographs", {1, 1e6}}, scan.iso);
  fields.value({"f_number", "Of the lens", {0.5, 128}}, scan.f_number);
  fields.value({"exposure_us", "Of each LED, us; default metered for each cloth", kExposure_us},
               scan.exposure_us);
  fields.value({"cloth_height_mm", "Of the cloth's surface above the table, mm", {-1000, 1000}},
               scan.cloth_height_mm);
  fields.value({"sessions", "Folder of sessions without a path of their own"}, scan.sessions);
  fields.value({"copy", "Folder of a second copy of each session"}, scan.copy);
  fields.value({"session_name", "Template of {date}, {fabric}, {count}"}, scan.session_name);
  fields.require(is_plain_name(scan.session_name), "session_name", "must be the name of one folder");
}

void describe(Fields& fields, Rig::Daemon& daemon) {
  fields.value({"host", "Address that it listens on; another one needs a token"}, daemon.host);
  fields.value({"port", "That it listens on; 0: any free one", {0, 65535}}, daemon.port);
  fields.value({"token", "File that holds it; empty: none"}, daemon.token);
  fields.value({"look_token", "File with that of who may only look"}, daemon.look_token);
  fields.require(daemon.look_token.empty() || !daemon.token.empty(), "look_token",
                 "needs daemon.token beside it: without one everybody operates");
  fields.value({"names", "More names that lead to it"}, daemon.names);
  fields.require(std::ranges::all_of(daemon.names, is_host_name), "names",
                 "must be names without a port, as in [\"rig.local\"]");
  fields.value({"origins", "Of pages behind a proxy"}, daemon.origins);
  fields.require(std::ranges::all_of(daemon.origins, is_origin), "origins",
                 "must be as in [\"https://rig.local\"], without a path");
  fields.value({"archives", "More folders of sessions, to look at"}, daemon.archives);
  fields.value({"preview", "Each finished scan is solved once quickly"}, daemon.preview);
  std::string screen = daemon.is_screen_seen ? "seen" : "unseen";
  fields.value(
      {.name = "screen", .says = "By the cloth: whether pages go black", .words = {"seen", "unseen"}},
      screen);
  daemon.is_screen_seen = screen == "seen";
  fields.value({"page_dark_ms", "That pages have to become black, ms", {0, 5000}}, daemon.page_dark_ms);
  fields.value({"virtual_control", "Socket of weft-virtual-rig; empty: a real rig"}, daemon.virtual_control);
  fields.value({"state", "Folder for its lock, address and log"}, daemon.state);
}

namespace {

/// What the file says.
struct RigFile {
  std::string name = "rig";
  std::optional<int> leds;
  std::vector<LedEntry> led;
  Rig::Board board;
  Rig::Camera camera;
  std::optional<Rig::Below> below;
  Rig::PolariserFilm polariser;
  Rig::Scan scan;
  Rig::Daemon daemon;
};

void describe(Fields& fields, RigFile& rig) {
  fields.value({"name", "In every session and calibration of it"}, rig.name);
  fields.require(is_plain_name(rig.name), "name", "must be a plain name");
  fields.value({"leds", "How many there are; default as many as [[led]]", {1, kMostLeds}}, rig.leds);
  fields.list({"led", "Where a tape has them"}, rig.led);
  fields.require(rig.led.empty() || !rig.leds || static_cast<std::size_t>(*rig.leds) == rig.led.size(),
                 "leds", fmt::format("must be that of [[led]], which is {}", rig.led.size()));
  fields.object({"board", "The LED board"}, rig.board);
  fields.object({"camera", "The camera"}, rig.camera);
  fields.object({"below", "A light below the cloth"}, rig.below);
  fields.object({"polariser", "One before the lens"}, rig.polariser);
  fields.object({"scan", "What scans take"}, rig.scan);
  fields.object({"daemon", "What weft serve is"}, rig.daemon);
}

NearLight light_of(const LedEntry& led) {
  NearLight light;
  light.position_mm = vec3(led.position_mm);
  light.aim = normalized(led.aim.empty() ? -1.0 * light.position_mm : vec3(led.aim));
  light.mu = led.mu;
  return light;
}

// Relative paths are of the file's folder.
void lay_paths(Rig& rig) {
  for (fs::path* path : {&rig.scan.calibration, &rig.scan.sessions, &rig.scan.copy, &rig.daemon.token,
                         &rig.daemon.look_token, &rig.daemon.virtual_control, &rig.daemon.state})
    *path = beside(rig.file, path->string());
  for (fs::path& archive : rig.daemon.archives) archive = beside(rig.file, archive.string());
  if (rig.camera.profile.ends_with(".toml"))
    rig.camera.profile = beside(rig.file, rig.camera.profile).string();
}

}  // namespace

Result<Rig> read_rig(const fs::path& file) {
  Result<RigFile> said = read_file<RigFile>(file, kPage);
  if (!said) return std::move(said).error();
  Rig rig;
  rig.file = fs::absolute(file).lexically_normal();
  rig.name = said->name;
  if (!said->led.empty()) {
    rig.lights.emplace();
    for (const LedEntry& led : said->led) rig.lights->leds.push_back(light_of(led));
    rig.leds = std::min(static_cast<int>(said->led.size()), kMostLeds);
  }
  rig.leds = said->leds.value_or(rig.leds);
  rig.board = said->board;
  rig.camera = said->camera;
  rig.below = said->below;
  rig.polariser = said->polariser;
  rig.scan = said->scan;
  rig.daemon = said->daemon;
  if (rig.daemon.state.empty()) rig.daemon.state = rig.name + ".state";
  lay_paths(rig);
  return rig;
}

std::filesystem::path calibration_now(const Rig& rig) {
  const Result<Rig> now = read_rig(rig.file);
  return now ? now->scan.calibration : rig.scan.calibration;
}

std::string camera_serial(const Rig& rig) {
  if (!rig.camera.serial.empty() || rig.scan.calibration.empty()) return rig.camera.serial;
  const Result<Calibration> calibration = read_calibration(rig.scan.calibration);
  return calibration ? calibration->subject.camera_serial : "";
}

}  // namespace weft::capture
