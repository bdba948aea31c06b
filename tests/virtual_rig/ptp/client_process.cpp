// SPDX-License-Identifier: Apache-2.0
#include "tests/virtual_rig/ptp/client_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>

namespace weft::virtual_rig {
namespace {

using Clock = std::chrono::steady_clock;

ClientProcess::End wait_for(pid_t child, double deadline_s) {
  const auto end = Clock::now() + std::chrono::duration<double>(deadline_s);
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (Clock::now() > end) return {};
    poll(nullptr, 0, 5);
  }
  return {true, WIFEXITED(status) ? WEXITSTATUS(status) : -1, WIFSIGNALED(status) ? WTERMSIG(status) : 0};
}

std::string read_to_end(int fd) {
  std::string text;
  char part[4096];
  for (ssize_t count = 0; (count = read(fd, part, sizeof part)) > 0;)
    text.append(part, static_cast<std::size_t>(count));
  return text;
}

}  // namespace

ClientProcess::ClientProcess(const std::function<int(const std::string& port)>& client) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) std::abort();
  child_ = fork();
  if (child_ == 0) {
    close(ends[1]);
    const rlimit none = {0, 0};
    setrlimit(RLIMIT_CORE, &none);
    const std::string port = read_to_end(ends[0]);
    _exit(port.empty() ? 0 : client(port));
  }
  close(ends[0]);
  pipe_ = ends[1];
}

ClientProcess::~ClientProcess() {
  kill();
  if (pipe_ >= 0) close(pipe_);
}

void ClientProcess::begin(const std::string& port) {
  if (write(pipe_, port.data(), port.size()) != static_cast<ssize_t>(port.size())) std::abort();
  close(pipe_);
  pipe_ = -1;
}

void ClientProcess::kill() {
  if (child_ < 0) return;
  ::kill(child_, SIGKILL);
  waitpid(child_, nullptr, 0);
  child_ = -1;
}

ClientProcess::End ClientProcess::wait(double deadline_s) {
  const End end = wait_for(child_, deadline_s);
  if (end.ended) child_ = -1;
  return end;
}

ProgramRun run_program(const std::vector<std::string>& command, const std::vector<std::string>& environment,
                       const std::string& folder, double deadline_s) {
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  std::vector<char*> variables;
  for (const std::string& variable : environment) variables.push_back(const_cast<char*>(variable.c_str()));
  for (char** variable = environ; *variable; ++variable) variables.push_back(*variable);
  variables.push_back(nullptr);
  const std::string log = folder + "/program_output.txt";
  const int output = open(log.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);

  const pid_t child = fork();
  if (child == 0) {
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    if (chdir(folder.c_str()) == 0) execve(arguments[0], arguments.data(), variables.data());
    _exit(127);
  }
  const ClientProcess::End end = wait_for(child, deadline_s);
  if (!end.ended) {
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
  lseek(output, 0, SEEK_SET);
  ProgramRun run = {end.exit_code, read_to_end(output)};
  close(output);
  return run;
}

}  // namespace weft::virtual_rig
