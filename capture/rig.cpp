// SPDX-License-Identifier: Apache-2.0
#include "capture/rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "core/calibration.h"
#include "core/toml/toml_keys.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPage = "docs/rig.md";
constexpr int kMostLeds = 10;

/// A path of the file, made absolute; empty stays empty.
fs::path beside(const fs::path& file, const std::string& path) {
  return path.empty() ? fs::path() : (file.parent_path() / path).lexically_normal();
}

std::string place(const fs::path& file, const char* table) {
  return file.string() + ": [" + table + "]";
}

Result<NearLight> read_led(const toml::table& table, std::string where) {
  TomlKeys keys(table, std::move(where), kPage);
  keys.know({"position_mm", "aim", "mu"});
  NearLight led;
  const std::vector<double> at = keys.numbers("position_mm", 3, 3);
  const std::vector<double> aim = keys.has("aim") ? keys.numbers("aim", 3, 3) : std::vector<double>();
  led.mu = keys.number_or("mu", 1, 0, 100);
  if (!at.empty()) led.position_mm = {at[0], at[1], at[2]};
  if (!at.empty() && !(at[2] >= 1 && length(led.position_mm) < 1e5))
    keys.reject("position_mm", "it must be at least 1 mm above the table");
  led.aim = aim.empty() ? -1.0 * led.position_mm : Vec3{aim[0], aim[1], aim[2]};
  if (!(length(led.aim) > 0)) keys.reject("aim", "it has no length");
  if (Result<void> ok = keys.status(); !ok) return std::move(ok).error();
  led.aim = normalized(led.aim);
  return led;
}

Result<void> read_leds(TomlKeys& keys, Rig& rig) {
  if (keys.has("led")) {
    const std::vector<const toml::table*> leds = keys.tables("led");
    if (Result<void> ok = keys.status(); !ok) return ok;
    rig.lights.emplace();
    for (std::size_t k = 0; k < leds.size(); ++k) {
      Result<NearLight> led = read_led(*leds[k], fmt::format("{}: LED {}", rig.file.string(), k + 1));
      if (!led) return std::move(led).error();
      rig.lights->leds.push_back(*led);
    }
    rig.leds = std::min(static_cast<int>(leds.size()), kMostLeds);
  }
  rig.leds = keys.integer_or("leds", rig.leds, 1, kMostLeds);
  if (rig.lights && keys.has("leds") && static_cast<std::size_t>(rig.leds) != rig.lights->leds.size())
    keys.reject("leds", fmt::format("there are {} [[led]]", rig.lights->leds.size()));
  return keys.status();
}

Result<void> read_board(const toml::table& table, Rig& rig) {
  TomlKeys keys(table, place(rig.file, "board"), kPage);
  keys.know({"port"});
  rig.board.port = keys.text_or("port", rig.board.port);
  if (rig.board.port.empty()) keys.reject("port", "it is empty");
  return keys.status();
}

Result<void> read_camera(const toml::table& table, Rig& rig) {
  TomlKeys keys(table, place(rig.file, "camera"), kPage);
  keys.know({"profile", "port", "serial"});
  rig.camera.profile = keys.text_or("profile", rig.camera.profile);
  if (rig.camera.profile.ends_with(".toml"))
    rig.camera.profile = beside(rig.file, rig.camera.profile).string();
  rig.camera.port = keys.text_or("port", rig.camera.port);
  rig.camera.serial = keys.text_or("serial", rig.camera.serial);
  const bool known =
      rig.camera.port.empty() || rig.camera.port.starts_with("usb:") || rig.camera.port.starts_with("ptpip:");
  if (!known) keys.reject("port", "it must be empty, usb:BUS,DEVICE or ptpip:ADDRESS:PORT:PORT");
  return keys.status();
}

Result<void> read_below(const toml::table& table, Rig& rig) {
  TomlKeys keys(table, place(rig.file, "below"), kPage);
  keys.know({"exposure_us"});
  rig.below.emplace();
  if (keys.has("exposure_us")) rig.below->exposure_us = keys.number("exposure_us", 1, 1e9);
  return keys.status();
}

Result<void> read_polariser(const toml::table& table, Rig& rig) {
  TomlKeys keys(table, place(rig.file, "polariser"), kPage);
  keys.know({"states", "settle_s"});
  for (const std::string& name : keys.texts_or("states", {})) {
    const std::optional<Polariser> state = polariser_of(name);
    if (!state || state == Polariser::kNone || std::ranges::count(rig.polariser.states, *state) > 0) {
      keys.reject("states", "it must be \"crossed\", \"parallel\" or both");
      break;
    }
    rig.polariser.states.push_back(*state);
  }
  rig.polariser.settle_s = keys.number_or("settle_s", rig.polariser.settle_s, 0, 60);
  return keys.status();
}

Result<void> read_scan(const toml::table& table, Rig& rig) {
  TomlKeys keys(table, place(rig.file, "scan"), kPage);
  keys.know({"calibration", "iso", "f_number", "exposure_us", "cloth_height_mm", "sessions", "copy",
             "session_name"});
  Rig::Scan& scan = rig.scan;
  scan.calibration = beside(rig.file, keys.text_or("calibration", ""));
  scan.iso = keys.number_or("iso", scan.iso, 1, 1e6);
  scan.f_number = keys.number_or("f_number", scan.f_number, 0.5, 128);
  if (keys.has("exposure_us")) scan.exposure_us = keys.number("exposure_us", 1, 1e9);
  scan.cloth_height_mm = keys.number_or("cloth_height_mm", 0, -1000, 1000);
  scan.sessions = beside(rig.file, keys.text_or("sessions", scan.sessions.string()));
  scan.copy = beside(rig.file, keys.text_or("copy", ""));
  scan.session_name = keys.text_or("session_name", scan.session_name);
  if (scan.session_name.empty() || scan.session_name.find('/') != std::string::npos)
    keys.reject("session_name", "it must be the name of one folder");
  return keys.status();
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

Result<void> read_daemon(const toml::table& table, Rig& rig) {
  TomlKeys keys(table, place(rig.file, "daemon"), kPage);
  keys.know({"host", "port", "token", "look_token", "names", "origins", "archives", "preview", "screen",
             "page_dark_ms", "state", "virtual_control"});
  rig.daemon.host = keys.text_or("host", rig.daemon.host);
  rig.daemon.port = keys.integer_or("port", rig.daemon.port, 0, 65535);
  rig.daemon.token = beside(rig.file, keys.text_or("token", ""));
  rig.daemon.look_token = beside(rig.file, keys.text_or("look_token", ""));
  if (!rig.daemon.look_token.empty() && rig.daemon.token.empty())
    keys.reject("look_token", "it needs daemon.token beside it: without one everybody operates");
  rig.daemon.names = keys.texts_or("names", {});
  for (const std::string& name : rig.daemon.names) {
    if (!is_host_name(name)) keys.reject("names", "each is a name without a port, as in [\"rig.local\"]");
  }
  for (const std::string& archive : keys.texts_or("archives", {}))
    rig.daemon.archives.push_back(beside(rig.file, archive));
  rig.daemon.preview = keys.flag_or("preview", rig.daemon.preview);
  const std::string screen = keys.text_or("screen", "seen");
  if (screen != "seen" && screen != "unseen")
    keys.reject("screen", "it is \"seen\" or \"unseen\" by the cloth");
  rig.daemon.is_screen_seen = screen == "seen";
  rig.daemon.page_dark_ms = keys.integer_or("page_dark_ms", rig.daemon.page_dark_ms, 0, 5000);
  rig.daemon.origins = keys.texts_or("origins", {});
  for (const std::string& origin : rig.daemon.origins) {
    if (!is_origin(origin)) keys.reject("origins", "each is as in [\"https://rig.local\"], without a path");
  }
  rig.daemon.virtual_control = beside(rig.file, keys.text_or("virtual_control", ""));
  rig.daemon.state = beside(rig.file, keys.text_or("state", rig.name + ".state"));
  return keys.status();
}

}  // namespace

Result<Rig> read_rig(const fs::path& file) {
  const Result<toml::table> table = read_toml(file);
  if (!table) return table.error();
  Rig rig;
  rig.file = fs::absolute(file).lexically_normal();
  TomlKeys keys(*table, file.string(), kPage);
  keys.know({"name", "leds", "led", "board", "camera", "below", "polariser", "scan", "daemon"});
  rig.name = keys.text_or("name", "rig");
  if (rig.name.empty() || rig.name.find('/') != std::string::npos)
    keys.reject("name", "it must be a plain name");
  if (Result<void> ok = read_leds(keys, rig); !ok) return std::move(ok).error();
  const toml::table& board = keys.table("board");
  const toml::table& camera = keys.table("camera");
  const toml::table& polariser = keys.table("polariser");
  const toml::table& below = keys.table("below");
  const toml::table& scan = keys.table("scan");
  const toml::table& daemon = keys.table("daemon");
  if (Result<void> ok = keys.status(); !ok) return std::move(ok).error();
  for (const Result<void>& read :
       {read_board(board, rig), read_camera(camera, rig), read_polariser(polariser, rig),
        keys.has("below") ? read_below(below, rig) : Result<void>(), read_scan(scan, rig),
        read_daemon(daemon, rig)}) {
    if (!read) return read.error();
  }
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
