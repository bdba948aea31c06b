// SPDX-License-Identifier: Apache-2.0
#include "bench/capture/rig_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include "core/files.h"
#include "virtual_rig/control_socket.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;
using Steady = std::chrono::steady_clock;

constexpr double kStart_s = 120;  // the first rig of a scene renders it
constexpr double kAnswer_s = 10;
constexpr auto kPoll = std::chrono::milliseconds(5);

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> merged(const std::vector<std::string>& environment) {
  std::vector<std::string> all = environment;
  for (char** each = environ; *each != nullptr; ++each) {
    const std::string_view variable = *each;
    const std::string_view name = variable.substr(0, variable.find('=') + 1);
    const auto replaced = [&](const std::string& own) { return own.starts_with(name); };
    if (std::none_of(environment.begin(), environment.end(), replaced)) all.emplace_back(variable);
  }
  return all;
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

Error rig_error(const std::string& why, const std::string& where) {
  return {ErrorKind::kTryAgain, "the virtual rig does not answer", where, why, "look at its log there"};
}

}  // namespace

Result<std::unique_ptr<ChildProcess>> ChildProcess::start(const std::vector<std::string>& command,
                                                          const std::vector<std::string>& environment,
                                                          const fs::path& log) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  if (!log.empty()) {
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0600);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  } else {
    posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  }
  std::vector<std::string> arguments = command;
  std::vector<std::string> variables = merged(environment);
  pid_t pid = 0;
  const int failed = posix_spawn(&pid, command.front().c_str(), &actions, nullptr,
                                 pointers_to(arguments).data(), pointers_to(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  if (failed == 0) return std::unique_ptr<ChildProcess>(new ChildProcess(pid, log));
  return Error{ErrorKind::kNoInput, "a program cannot be started", command.front(), system_reason(failed),
               "build all of weft"};
}

ChildProcess::~ChildProcess() {
  if (code_) return;
  signal(SIGKILL);
  wait(kAnswer_s);
}

bool ChildProcess::runs() {
  return !wait(0);
}

void ChildProcess::signal(int number) const {
  if (!code_) ::kill(pid_, number);
}

std::optional<int> ChildProcess::wait(double most_s) {
  const Steady::time_point deadline =
      Steady::now() + std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(most_s));
  while (!code_) {
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) == pid_) {
      code_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    } else if (Steady::now() >= deadline) {
      return std::nullopt;
    } else {
      std::this_thread::sleep_for(kPoll);
    }
  }
  return code_;
}

std::string ChildProcess::said() const {
  return text_of(log_);
}

Result<std::unique_ptr<RigProcess>> RigProcess::start(const RigProcessOptions& options) {
  std::error_code failed;
  fs::create_directories(options.folder.parent_path(), failed);
  if (failed) return cannot_write(options.folder.parent_path(), failed.value());
  std::vector<std::string> command = {(options.programs / "weft-virtual-rig").string(),
                                      options.scene.string(), "--folder", options.folder.string()};
  if (options.megapixels)
    command.insert(command.end(), {"--megapixels", fmt::format("{}", *options.megapixels)});
  if (options.same_noise) command.emplace_back("--same-noise");
  if (options.usb) command.emplace_back("--usb");
  const fs::path log = options.folder.string() + ".log";
  Result<std::unique_ptr<ChildProcess>> process = ChildProcess::start(command, {}, log);
  if (!process) return std::move(process).error();
  const Steady::time_point deadline =
      Steady::now() + std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(kStart_s));
  while ((*process)->said().find("READY") == std::string::npos) {
    if (!(*process)->runs()) return rig_error((*process)->said(), options.folder.string());
    if (Steady::now() > deadline) return rig_error("it is not ready", options.folder.string());
    std::this_thread::sleep_for(kPoll);
  }
  std::vector<std::string> environment = lines_of(options.folder / "environment");
  environment.push_back("WEFT_RIG=" + (options.folder / "rig.toml").string());
  return std::unique_ptr<RigProcess>(new RigProcess(options, std::move(*process), std::move(environment)));
}

Result<std::string> RigProcess::say(const std::string& line) const {
  Result<std::string> answer = simulator::send_command(options_.folder / "control", line, kAnswer_s);
  if (answer && answer->starts_with("error"))
    return Error{ErrorKind::kUsage, "the virtual rig refuses a command", line, *answer,
                 "use one that it has"};
  return answer;
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

std::optional<ProcessSize> size_of(pid_t pid) {
  const fs::path folder = fs::path("/proc") / std::to_string(pid);
  ProcessSize size;
  for (const std::string& line : lines_of(folder / "status")) {
    if (line.starts_with("VmRSS:")) size.resident_bytes = std::stoull(line.substr(6)) << 10;
  }
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder / "fd", failed))
    size.descriptors += !entry.path().empty();
  if (failed || size.resident_bytes == 0) return std::nullopt;
  return size;
}

std::optional<pid_t> child_of(pid_t parent, const std::string& name) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc", ignored)) {
    const std::string number = entry.path().filename().string();
    pid_t pid = 0;
    if (std::from_chars(number.data(), number.data() + number.size(), pid).ec != std::errc()) continue;
    const std::string stat = text_of(entry.path() / "stat");
    const std::size_t open = stat.find('('), close = stat.rfind(')');
    if (open == std::string::npos || close == std::string::npos || stat.size() < close + 4) continue;
    if (stat.substr(open + 1, close - open - 1) == name &&
        std::strtol(stat.c_str() + close + 4, nullptr, 10) == parent)
      return pid;
  }
  return std::nullopt;
}

}  // namespace weft::bench
