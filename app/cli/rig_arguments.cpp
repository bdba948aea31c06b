// SPDX-License-Identifier: Apache-2.0
#include "app/cli/rig_arguments.h"

#include <CLI/CLI.hpp>
#include <cstdlib>

namespace weft::app {
namespace {

namespace fs = std::filesystem;

void add_rig_file(CLI::App& verb, fs::path& rig) {
  verb.add_option("--rig", rig,
                  "Rig file (docs/rig.md); default $WEFT_RIG, ./rig.toml, ~/.config/weft/rig.toml");
}

void add_leds(CLI::App& verb, std::vector<int>& leds) {
  verb.add_option("--leds", leds, "LEDs, numbered from 1: 1,4,7; default all")
      ->delimiter(',')
      ->check(CLI::Range(1, 10));
}

CLI::App* add_serve(CLI::App& app, ServeArguments& a) {
  CLI::App* verb = app.add_subcommand("serve", "Own a rig and answer over HTTP (docs/http.md)");
  add_rig_file(*verb, a.rig);
  verb->add_option("--host", a.host,
                   "Address to listen on; default the rig file's, 127.0.0.1. Any other needs a token");
  verb->add_option("--port", a.port, "Port to listen on; 0 is any free one; default the rig file's, 8470")
      ->check(CLI::Range(0, 65535));
  return verb;
}

CLI::App* add_scan(CLI::App& app, ScanArguments& a) {
  CLI::App* verb = app.add_subcommand(
      "scan", "Photograph a cloth under each LED; run again, it finishes a scan that was cut short");
  add_rig_file(*verb, a.rig);
  verb->add_option("-o,--output", a.output,
                   "Session folder, NAME.weft, new or unfinished; default the one that the same command left "
                   "unfinished in the last hour, else a new one by the rig file's session_name");
  verb->add_option("--fabric", a.fabric, "Name of the cloth");
  add_leds(*verb, a.leds);
  verb->add_option("--exposure", a.exposure_us, "Shutter time, us; default metered for this cloth")
      ->check(CLI::Range(1.0, 1e9));
  verb->add_option("--bracket", a.bracket,
                   "Each LED once more at so many times the exposure, 0.001 to 100: for cloth that one "
                   "exposure cannot hold")
      ->check(CLI::Range(0.001, 100.0));
  verb->add_option("--height", a.cloth_height_mm,
                   "Of the cloth's surface above the table, mm; default the rig file's")
      ->check(CLI::Range(-1000.0, 1000.0));
  verb->add_option("--metadata", a.metadata, "KEY=VALUE to keep with the session: id, weight, side, notes");
  verb->add_flag("!--no-repeat", a.repeat, "Do not light the first LED once more at the end, to see drift");
  verb->add_flag("!--no-preview", a.preview, "Do not solve a quick preview at the end");
  verb->add_flag("--dry-run", a.dry_run, "Only say which session would be made or gone on with");
  return verb;
}

}  // namespace

RigVerbs add_rig_verbs(CLI::App& app, RigForms& forms) {
  RigVerbs verbs = {};
  verbs.serve = add_serve(app, forms.serve);
  verbs.scan = add_scan(app, forms.scan);
  verbs.rig = app.add_subcommand("rig", "Try the parts of a rig");
  verbs.rig->require_subcommand(1);
  verbs.status = verbs.rig->add_subcommand("status", "What board and camera say of themselves");
  verbs.lights = verbs.rig->add_subcommand("lights", "Light the LEDs one after another");
  verbs.test =
      verbs.rig->add_subcommand("test", "Photograph the table under each LED: is each where it should be?");
  for (CLI::App* verb : {verbs.status, verbs.lights, verbs.test}) add_rig_file(*verb, forms.rig.rig);
  for (CLI::App* verb : {verbs.lights, verbs.test}) add_leds(*verb, forms.rig.leds);
  verbs.lights->add_option("--seconds", forms.rig.seconds, "That each LED is lit, s")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 30.0));
  verbs.doctor = app.add_subcommand(
      "doctor", "What is wrong with this machine's set-up for a rig, and the command that mends it");
  add_rig_file(*verbs.doctor, forms.doctor.rig);
  verbs.copy = app.add_subcommand("copy", "Make or verify the second copy of a finished session");
  verbs.copy->add_option("session", forms.copy.session, "Session folder, NAME.weft")->required();
  verbs.copy->add_option("--to", forms.copy.to,
                         "Folder on another disk; default the one it was scanned with");
  return verbs;
}

fs::path find_rig(const fs::path& said) {
  if (!said.empty()) return said;
  if (const char* named = std::getenv("WEFT_RIG"); named != nullptr && *named != '\0') return named;
  std::error_code ignored;
  if (fs::exists("rig.toml", ignored)) return "rig.toml";
  const char* config = std::getenv("XDG_CONFIG_HOME");
  if (config != nullptr && *config != '\0') return fs::path(config) / "weft/rig.toml";
  const char* home = std::getenv("HOME");
  return fs::path(home == nullptr ? "/" : home) / ".config/weft/rig.toml";
}

}  // namespace weft::app
