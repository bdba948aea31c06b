// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/process.h"
#include "core/base/result.h"

namespace weft::virtual_rig {

/// What weft-virtual-rig is started with.
struct RigProcessOptions {
  std::filesystem::path programs;  ///< folder with weft, weft-camera and weft-virtual-rig
  std::filesystem::path scene;
  std::filesystem::path folder;
  std::optional<double> megapixels = {};  ///< else the scene's
  bool is_bare = false;                   ///< nobody has calibrated it
  bool usb = false;
  bool has_more_outputs = false;  ///< a light below the cloth and a polariser
  bool same_noise = false;        ///< a shot taken again is the same picture
  /// Called while its light is rendered, which the first rig of a scene does, for as long as minutes.
  std::function<void(double share)> rendering = {};
};

/// What the program says before each percent of it.
inline constexpr const char* kRenders = "rendering light:";

/// weft-virtual-rig as a process of its own.
class RigProcess {
 public:
  static Result<std::unique_ptr<RigProcess>> start(const RigProcessOptions& options);

  /// One line to its control socket, and what it answers; kUsage where that is an error.
  Result<std::string> say(const std::string& line) const;
  /// Starts a program in the rig's environment, WEFT_RIG set.
  Result<std::unique_ptr<ChildProcess>> run(const std::vector<std::string>& command,
                                            const std::string& log) const;
  /// `weft` with these arguments.
  Result<std::unique_ptr<ChildProcess>> weft(std::vector<std::string> arguments,
                                             const std::string& log) const;

  const std::filesystem::path& folder() const { return options_.folder; }
  pid_t pid() const { return process_->pid(); }

 private:
  RigProcess(RigProcessOptions options, std::unique_ptr<ChildProcess> process,
             std::vector<std::string> environment)
      : options_(std::move(options)), environment_(std::move(environment)), process_(std::move(process)) {}

  RigProcessOptions options_;
  std::vector<std::string> environment_;
  std::unique_ptr<ChildProcess> process_;
};

}  // namespace weft::virtual_rig
