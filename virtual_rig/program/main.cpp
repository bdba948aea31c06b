// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/cli/exit_code.h"
#include "core/base/files.h"
#include "simulator/scene/resolution.h"
#include "virtual_rig/board/foreign_device.h"
#include "virtual_rig/control_socket.h"
#include "virtual_rig/program/background.h"
#include "virtual_rig/program/run.h"

namespace weft::virtual_rig {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  fs::path scene, folder;
  std::string inject;
  double megapixels = 0;
  bool background = false, keep = false;
  int ready = -1;
  std::vector<std::string> command;
  VirtualRigOptions rig;
};

void define(CLI::App& app, Arguments& a) {
  app.add_option("SCENE", a.scene, "scene file (docs/scenes.md)");
  app.add_option("COMMAND", a.command,
                 "after --: a program to run inside the rig's environment; its end ends the rig")
      ->expected(-1);
  app.add_option("--folder", a.folder,
                 "folder of the rig, made where it is not there [one in the system's folder for temporary "
                 "files, removed at the end]");
  app.add_option("--megapixels", a.megapixels, "the same cloth at another resolution [the scene's]")
      ->check(CLI::Range(0.001, 100.0));
  app.add_option(
         "--body", a.rig.body,
         "d5100, whose trigger blocks while its shutter is open, or d80, whose trigger returns at once")
      ->transform(CLI::CheckedTransformer(std::map<std::string, simulator::Body>{
          {"d5100", simulator::Body::kD5100}, {"d80", simulator::Body::kD80}}))
      ->default_str("d5100");
  app.add_flag("--usb", a.rig.usb, "the camera hangs on USB, not on PTP/IP");
  app.add_option("--port", a.rig.port, "TCP port of PTP/IP on 127.0.0.1 [a free one]");
  app.add_option("--serial", a.rig.serial, "serial number of the camera")->capture_default_str();
  app.add_option("--bootloader", a.rig.bootloader_s, "seconds that the board is deaf for after a reset")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 10.0));
  app.add_option("--clock-offset", a.rig.clock_offset_s, "seconds that the camera's clock is fast")
      ->capture_default_str()
      ->check(CLI::Range(-1e8, 1e8));
  app.add_option("--readout", a.rig.readout_s,
                 "seconds from the exposure of the camera's first row to that of its last")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 10.0));
  app.add_option("--away", a.rig.away_s, "seconds that a fault keeps the camera or its cable away for")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1000.0));
  app.add_option("--late", a.rig.late_s, "seconds that a late picture is late by")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1000.0));
  app.add_flag("--same-noise", a.rig.same_noise,
               "noise follows from the LEDs that are lit: the same shot taken again is the same picture");
  app.add_flag(
      "--bare", a.rig.bare,
      "nobody has calibrated it: LEDs are where a tape has them, the camera is as its data sheet says");
  app.add_flag("--below", a.rig.below, "a light below the cloth hangs on the board");
  app.add_flag("--polariser", a.rig.polariser,
               "films hang before LEDs and lens, which the board turns: crossed they take the gloss away");
  app.add_option("--beside", a.rig.beside,
                 "another serial device, at the port FOLDER/beside: how it talks [none]")
      ->check(CLI::IsMember(foreign_kinds()));
  app.add_option("--cache", a.rig.cache, "folder of rendered light, shared by all rigs")
      ->capture_default_str();
  app.add_option("--threads", a.rig.render.tiles.threads, "threads [all the machine has]")
      ->check(CLI::Range(1, 1024));
  app.add_option("--firmware", a.rig.firmware, "ELF file on the board")->capture_default_str();
  app.add_flag("--keep", a.keep, "leave the folder as it is at the end: sessions and exposures.jsonl");
  app.add_flag("--no-wait", a.background,
               "return as soon as the rig is ready; it lives on until --inject end");
  app.add_option("--first", a.rig.first,
                 "a command as for --inject, done before the rig is ready; may be said again")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--ready", a.ready)->group("");  // run_in_background()
  app.add_option("--inject", a.inject, "send one command to the rig that lives in --folder, and end");
  std::string footer = "Commands for --inject, or a line each on the socket FOLDER/control:\n";
  for (const auto& [line, does, example] : virtual_rig_commands())
    footer += fmt::format("  {:<20} {}\n", line, does);
  app.footer(footer +
             "\nA fault of the camera befalls the SHOT that is given, counted from 1, the next one.\n"
             "Exit codes: that of COMMAND; 0 done, 64 usage, 65 bad scene, 66 no scene, 69 no rig in the\n"
             "folder, 73 cannot create, 74 input/output, 75 a rig lives in the folder, 130 interrupted");
}

int complain(const Error& error) {
  fmt::print(stderr, "weft-virtual-rig: {}\n", error.message());
  return app::exit_code_of(error.kind);
}

int inject(const Arguments& a) {
  if (a.folder.empty()) {
    return complain({ErrorKind::kUsage, "no rig is named", "--inject", "there may be several",
                     "name its folder with --folder"});
  }
  const Result<std::string> answer = send_command(a.folder / "control", a.inject);
  if (!answer) return complain(answer.error());
  const bool is_refused = answer->starts_with("error");
  fmt::print(is_refused ? stderr : stdout, "{}\n", *answer);
  return is_refused ? app::kUsageError : app::kDone;
}

/// A new folder of this run alone.
Result<fs::path> temporary_folder() {
  std::error_code failed;
  std::string name = (fs::temp_directory_path(failed) / "weft-rig-XXXXXX").string();
  if (failed || ::mkdtemp(name.data()) == nullptr) return cannot_write(name, errno);
  return fs::path(name);
}

int run(Arguments& a) {
  if (a.scene.empty()) {
    return complain({ErrorKind::kUsage, "no scene", "SCENE", "a rig photographs something",
                     "name a scene file, as testdata/scenes/satin.toml"});
  }
  Result<simulator::Scene> scene = simulator::read_scene(a.scene);
  if (!scene) return complain(scene.error());
  if (a.megapixels > 0) simulator::resize(scene->camera, a.megapixels);
  a.rig.scene = std::move(*scene);
  a.rig.preloads = {WEFT_TERMINAL_SHIM, WEFT_DISK_SHIM};
  if (a.rig.usb) a.rig.preloads.emplace_back(WEFT_USB_SHIM);
  a.rig.keep_log = a.keep;
  const bool is_temporary = a.folder.empty();
  if (is_temporary) {
    Result<fs::path> folder = temporary_folder();
    if (!folder) return complain(folder.error());
    a.folder = *folder;
  }
  a.rig.folder = a.folder;
  const Result<int> ended = run_virtual_rig(a.rig, a.command, a.ready);
  std::error_code ignored;
  if (is_temporary && !a.keep) fs::remove_all(a.folder, ignored);
  return ended ? *ended : complain(ended.error());
}

std::vector<std::string> without(int argc, char** argv, std::string_view option) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  std::erase(arguments, option);
  return arguments;
}

int main_of(int argc, char** argv) {
  Arguments arguments;
  arguments.rig.firmware = WEFT_FIRMWARE;
  CLI::App app(
      "A textile scanner that is not there: the real firmware in a simulated microcontroller on a\n"
      "pseudo-terminal, and a camera that photographs what its pins light.");
  define(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? app::kDone : app::kUsageError;
  }
  std::signal(SIGPIPE, SIG_IGN);
  if (!arguments.inject.empty()) return inject(arguments);
  if (arguments.ready >= 0) ::fcntl(arguments.ready, F_SETFD, FD_CLOEXEC);
  if (arguments.background && !arguments.command.empty()) {
    return complain({ErrorKind::kUsage, "a command in the background", "--no-wait",
                     "nobody would get its exit code", "leave out --no-wait or the command"});
  }
  if (arguments.background) return run_in_background(without(argc, argv, "--no-wait"));
  return run(arguments);
}

}  // namespace
}  // namespace weft::virtual_rig

int main(int argc, char** argv) {
  return weft::virtual_rig::main_of(argc, argv);
}
