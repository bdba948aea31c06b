// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/rig_process.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <thread>
#include <utility>

#include "core/base/files.h"
#include "virtual_rig/control_socket.h"

namespace weft::virtual_rig {
namespace {

namespace fs = std::filesystem;
using Steady = std::chrono::steady_clock;

constexpr double kStart_s = 600;  // the first rig of a scene renders it, on whatever machine
constexpr auto kPoll = std::chrono::milliseconds(5);

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// Where the program is with its light, by what it has said.
std::optional<double> share_rendered(const std::string& said) {
  const std::size_t last = said.rfind(kRenders);
  if (last == std::string::npos) return {};
  return std::atoi(said.c_str() + last + std::strlen(kRenders)) / 100.0;
}

Error rig_error(const std::string& why, const std::string& where) {
  return {ErrorKind::kTryAgain, "the virtual rig does not answer", where, why, "look at its log there"};
}

}  // namespace

Result<std::unique_ptr<RigProcess>> RigProcess::start(const RigProcessOptions& options) {
  std::error_code failed;
  fs::create_directories(options.folder.parent_path(), failed);
  if (failed) return cannot_write(options.folder.parent_path(), failed.value());
  std::vector<std::string> command = {(options.programs / "weft-virtual-rig").string(),
                                      options.scene.string(), "--folder", options.folder.string()};
  if (options.megapixels)
    command.insert(command.end(), {"--megapixels", fmt::format("{}", *options.megapixels)});
  if (options.has_more_outputs) command.insert(command.end(), {"--below", "--polariser"});
  if (options.same_noise) command.emplace_back("--same-noise");
  if (options.is_bare) command.emplace_back("--bare");
  if (options.usb) command.emplace_back("--usb");
  const fs::path log = options.folder.string() + ".log";
  Result<std::unique_ptr<ChildProcess>> process = ChildProcess::start(command, {}, log);
  if (!process) return std::move(process).error();
  const Steady::time_point deadline =
      Steady::now() + std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(kStart_s));
  for (std::string said; said.find("READY") == std::string::npos; said = (*process)->said()) {
    if (const auto share = share_rendered(said); share && options.rendering) options.rendering(*share);
    if (!(*process)->runs()) return rig_error((*process)->said(), options.folder.string());
    if (Steady::now() > deadline) return rig_error("it is not ready", options.folder.string());
    std::this_thread::sleep_for(kPoll);
  }
  std::vector<std::string> environment = lines_of(options.folder / "environment");
  environment.push_back("WEFT_RIG=" + (options.folder / "rig.toml").string());
  return std::unique_ptr<RigProcess>(new RigProcess(options, std::move(*process), std::move(environment)));
}

Result<std::string> RigProcess::say(const std::string& line) const {
  return tell_rig(options_.folder / "control", line);
}

Result<std::unique_ptr<ChildProcess>> RigProcess::run(const std::vector<std::string>& command,
                                                      const std::string& log) const {
  return ChildProcess::start(command, environment_, log.empty() ? fs::path() : options_.folder / log);
}

Result<std::unique_ptr<ChildProcess>> RigProcess::weft(std::vector<std::string> arguments,
                                                       const std::string& log) const {
  arguments.insert(arguments.begin(), (options_.programs / "weft").string());
  return run(arguments, log);
}

}  // namespace weft::virtual_rig
