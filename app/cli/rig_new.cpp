// SPDX-License-Identifier: Apache-2.0
// weft rig new: a rig file that names what is plugged in.
#include "app/cli/rig_new.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "app/cli/rig_owner.h"
#include "app/cli/terminal.h"
#include "capture/rig.h"
#include "capture/rig_devices/rig_devices.h"
#include "core/base/files.h"
#include "core/toml/field_toml.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

struct NewRig {
  std::string name;
  fs::path output = "rig.toml";
  std::string board_port, camera_port;  ///< empty: looked for
};

// Where boards are, those with weft's own names first.
std::vector<std::string> likely_ports() {
  std::vector<std::string> ports;
  const auto add = [&](const fs::path& folder, std::string_view begin) {
    std::vector<std::string> found;
    std::error_code failed;
    for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end;
         entry.increment(failed)) {
      if (entry->path().filename().string().starts_with(begin)) found.push_back(entry->path().string());
    }
    std::ranges::sort(found);
    ports.insert(ports.end(), found.begin(), found.end());
  };
  add("/dev", "weft-led");
  add("/dev/serial/by-id", "");
  return ports;
}

// The first port at which a board answers, which `rig` is given.
std::string find_board(const NewRig& a, capture::Rig& rig) {
  const std::vector<std::string> ports =
      a.board_port.empty() ? likely_ports() : std::vector<std::string>{a.board_port};
  for (const std::string& port : ports) {
    rig.board.port = port;
    if (const auto board = capture::open_board(rig)) {
      rig.leds = (*board)->facts().leds;
      return fmt::format("board at {}: {}", port, words_of((*board)->facts(), port));
    }
  }
  rig.board = {};
  if (!a.board_port.empty()) rig.board.port = a.board_port;
  return "no LED board answers; plug it in and run weft doctor";
}

std::string find_camera(const NewRig& a, capture::Rig& rig) {
  rig.camera.port = a.camera_port;
  auto opened = capture::open_camera(rig);
  const Result<capture::CameraFacts> facts = opened ? (*opened)->connect() : opened.error();
  if (!facts) return "no camera answers: " + facts.error().message();
  rig.camera.serial = facts->serial;
  return fmt::format("camera {} {} at {}", facts->model, facts->serial, facts->port);
}

std::string text_of(const capture::Rig& rig) {
  return "# A rig of weft. Every key may be left out: docs/rig.md has them all.\n" +
         toml_of({{"name", rig.name}, {"leds", rig.leds}}) + "\n[board]\n" +
         toml_of({{"port", rig.board.port}}) + "\n[camera]  # an empty port: it is found on USB\n" +
         toml_of(
             {{"profile", rig.camera.profile}, {"port", rig.camera.port}, {"serial", rig.camera.serial}}) +
         "\n[scan]  # calibration: the folder that weft calibrate all makes\n" +
         toml_of({{"calibration", ""},
                  {"iso", rig.scan.iso},
                  {"f_number", rig.scan.f_number},
                  {"sessions", rig.scan.sessions.string()}});
}

bool is_utf8(const std::string& text) {
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)) == text;
}

Result<int> make_rig(const NewRig& a, const CommonArguments& common) {
  for (const auto& [option, text] :
       {std::pair("name", a.name), {"--board", a.board_port}, {"--camera", a.camera_port}}) {
    if (!is_utf8(text))
      return Error{ErrorKind::kUsage, "no rig file can be written", option, "it is no UTF-8",
                   "give another one"};
  }
  if (is_there(a.output)) {
    return Error{ErrorKind::kCannotCreate, "there is such a file", a.output.string(), "it would be lost",
                 "name another with -o"};
  }
  capture::Rig rig;
  rig.name = a.name;
  const std::vector<std::string> found = {find_board(a, rig), find_camera(a, rig)};
  if (Result<void> written = write_file(a.output, text_of(rig)); !written) return std::move(written).error();
  if (const Result<capture::Rig> read = capture::read_rig(a.output); !read) {
    std::error_code ignored;
    fs::remove(a.output, ignored);
    return read.error();
  }
  const std::string file = fs::absolute(a.output).lexically_normal().string();
  if (common.json) {
    print_json({{"file", file}, {"found", found}});
    return kDone;
  }
  print(file);
  for (const std::string& line : found) print("  " + line);
  print(fmt::format("  next: weft doctor --rig {}, then weft calibrate all --rig {}", a.output.string(),
                    a.output.string()));
  return kDone;
}

}  // namespace

Run add_rig_new(Options& options) {
  const auto a = std::make_shared<NewRig>();
  options.add("name", &a->name, "Name of the rig, in every session and calibration of it").required();
  options.add("-o,--output", &a->output, "Rig file to write; default rig.toml");
  options.add("--board", &a->board_port, "Port of the LED board; default the first at which one answers");
  options.add("--camera", &a->camera_port, "Port of the camera, as ptpip:HOST:15740:15740; default USB");
  return [a](const CommonArguments& common) { return make_rig(*a, common); };
}

}  // namespace weft::app
