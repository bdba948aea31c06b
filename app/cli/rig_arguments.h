// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace weft::app {

/// `weft serve`.
struct ServeArguments {
  std::filesystem::path rig;        ///< rig.toml; empty: found as find_rig() says
  std::optional<std::string> host;  ///< in place of what the rig file says
  std::optional<int> port;
};

/// `weft scan`.
struct ScanArguments {
  std::filesystem::path rig;
  std::filesystem::path output;  ///< session; empty: named by the rig file's template
  std::string fabric;
  std::vector<int> leds;  ///< empty: all
  std::optional<double> exposure_us, bracket, cloth_height_mm;
  std::vector<std::string> metadata;  ///< "key=value"
  bool repeat = true;
  bool preview = true;  ///< a quick solve at the end
  bool dry_run = false;
};

/// `weft rig status|lights|test`.
enum class RigTask { kStatus, kLights, kTest };
struct RigArguments {
  RigTask task = RigTask::kStatus;
  std::filesystem::path rig;
  std::vector<int> leds;  ///< of `lights` and `test`; empty: all
  double seconds = 1;     ///< of `lights`, each LED
};

/// `weft doctor`.
struct DoctorArguments {
  std::filesystem::path rig;
};

/// `weft copy`.
struct CopyArguments {
  std::filesystem::path session;
  std::filesystem::path to;  ///< folder; empty: where the session says that its copy belongs
};

/// What the verbs of a rig fill in.
struct RigForms {
  ServeArguments serve;
  ScanArguments scan;
  RigArguments rig;
  DoctorArguments doctor;
  CopyArguments copy;
};

/// The verbs of a rig, and where each of them puts what was said.
struct RigVerbs {
  CLI::App *serve, *scan, *rig, *status, *lights, *test, *doctor, *copy;
};
RigVerbs add_rig_verbs(CLI::App& app, RigForms& forms);

/// The rig file of a command: `said`, else $WEFT_RIG, else ./rig.toml, else
/// $XDG_CONFIG_HOME/weft/rig.toml (~/.config).
std::filesystem::path find_rig(const std::filesystem::path& said);

}  // namespace weft::app
