// SPDX-License-Identifier: Apache-2.0
#include "core/base/process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <string_view>
#include <thread>

#include "core/base/descriptor.h"
#include "core/base/files.h"

namespace weft {
namespace {

namespace fs = std::filesystem;
using Steady = std::chrono::steady_clock;

constexpr double kEnd_s = 10;  // for the system to clear away a killed process
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

Error cannot_start(const fs::path& program, int error_number) {
  const bool is_passing = error_number == EAGAIN || error_number == ENOMEM;
  return {is_passing ? ErrorKind::kTryAgain : ErrorKind::kNoInput, "a program cannot be started",
          program.string(), system_reason(error_number), "install or build all of weft"};
}

int above_standard(int descriptor) {
  return ::fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
}

/// Input, output and errors, none of them among the standard ones.
using Streams = std::array<Descriptor, 3>;

Result<Streams> streams_of(const ProcessStart& start) {
  Streams streams;
  const std::array<const Stream*, 3> wanted = {&start.input, &start.output, &start.errors};
  for (std::size_t i = 0; i < streams.size(); ++i) {
    Descriptor opened;
    int number = -1;
    if (const auto* file = std::get_if<fs::path>(wanted[i])) {
      opened = Descriptor(*file, O_WRONLY | O_CREAT | O_TRUNC, 0600);
      if (!opened) return cannot_write(*file, errno);
      number = opened.get();
    } else {
      number = std::get<int>(*wanted[i]);
      if (number == kAsOutput) number = streams[1].get();
    }
    streams[i] = Descriptor(above_standard(number));
    if (streams[i]) continue;
    const Descriptor null("/dev/null", O_RDWR);
    streams[i] = Descriptor(above_standard(null.get()));
  }
  return streams;
}

/// All that the child needs: it may not ask for memory, as other threads may have held its lock.
struct Prepared {
  const ProcessStart& start;
  const Streams& streams;
  std::vector<char*> arguments, environment;
  pid_t parent;
};

bool is_set_up(const Prepared& prepared) {
  const ProcessStart& start = prepared.start;
  if (start.group == ProcessGroup::kOwn && ::setpgid(0, 0) != 0) return false;
  if (start.group == ProcessGroup::kOwnSession && ::setsid() < 0) return false;
  if (start.ends_with_parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != prepared.parent) ::_exit(0);
  }
  const rlimit limit = {start.memory_bytes, start.memory_bytes};
  if (start.memory_bytes > 0 && ::setrlimit(RLIMIT_DATA, &limit) != 0) return false;
  if (start.niceness != 0) ::setpriority(PRIO_PROCESS, 0, ::getpriority(PRIO_PROCESS, 0) + start.niceness);
  for (int i = 0; i < 3; ++i) {
    if (::dup2(prepared.streams[static_cast<std::size_t>(i)].get(), i) < 0) return false;
  }
  return start.handed_on < 0 || ::fcntl(start.handed_on, F_SETFD, 0) == 0;
}

[[noreturn]] void become_child(const Prepared& prepared, int fails) {
  if (is_set_up(prepared)) {
    for (const int number : {SIGINT, SIGTERM, SIGPIPE}) std::signal(number, SIG_DFL);
    sigset_t none;
    ::sigemptyset(&none);
    ::pthread_sigmask(SIG_SETMASK, &none, nullptr);
    ::execvpe(prepared.arguments.front(), prepared.arguments.data(), prepared.environment.data());
  }
  const int failed = errno;
  (void)!::write(fails, &failed, sizeof failed);
  ::_exit(1);
}

/// Whether the child has said why it could not become the program.
bool read_number(int from, int& number) {
  ssize_t n = 0;
  do {
    n = ::read(from, &number, sizeof number);
  } while (n < 0 && errno == EINTR);
  return n == static_cast<ssize_t>(sizeof number);
}

}  // namespace

fs::path program_beside(const std::string& name) {
  std::error_code failed;
  const fs::path here = fs::read_symlink("/proc/self/exe", failed).parent_path();
  for (const char* folder : {".", "../libexec/weft", "../../bin"}) {
    const fs::path program = (here / folder / name).lexically_normal();
    if (fs::is_regular_file(program, failed)) return program;
  }
  return here / name;
}

Error become(const fs::path& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  ::execv(program.c_str(), pointers_to(words).data());
  return cannot_start(program, errno);
}

Result<pid_t> start_process(const ProcessStart& start) {
  Result<Streams> streams = streams_of(start);
  if (!streams) return std::move(streams).error();
  std::vector<std::string> words = start.command, variables = merged(start.environment);
  const Prepared prepared = {start, *streams, pointers_to(words), pointers_to(variables), ::getpid()};
  std::array<int, 2> ends = {-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return cannot_start(start.command.front(), errno);
  const Descriptor failure(ends[0]);
  Descriptor fails(ends[1]);
  // No handler of this process's runs in the child before it is another program.
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t child = ::fork();
  if (child == 0) become_child(prepared, above_standard(fails.get()));
  const int no_child = errno;
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (child < 0) return cannot_start(start.command.front(), no_child);
  fails = Descriptor();
  int failed = 0;
  if (read_number(failure.get(), failed)) {
    ::waitpid(child, nullptr, 0);
    return cannot_start(start.command.front(), failed);
  }
  return child;
}

Result<std::unique_ptr<ChildProcess>> ChildProcess::start(const ProcessStart& start) {
  const Result<pid_t> pid = start_process(start);
  if (!pid) return pid.error();
  const auto* log = std::get_if<fs::path>(&start.output);
  return std::unique_ptr<ChildProcess>(new ChildProcess(*pid, log != nullptr ? *log : fs::path()));
}

Result<std::unique_ptr<ChildProcess>> ChildProcess::start(const std::vector<std::string>& command,
                                                          const std::vector<std::string>& environment,
                                                          const fs::path& log, const fs::path& errors) {
  ProcessStart start = {.command = command, .environment = environment, .output = STDERR_FILENO};
  if (!log.empty()) start.output = log;
  if (!errors.empty()) start.errors = errors;
  return ChildProcess::start(start);
}

ChildProcess::~ChildProcess() {
  if (code_) return;
  signal(SIGKILL);
  wait(kEnd_s);
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
      if (WIFSIGNALED(status)) killed_by_ = WTERMSIG(status);
      code_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    } else if (Steady::now() >= deadline) {
      return std::nullopt;
    } else {
      std::this_thread::sleep_for(kPoll);
    }
  }
  return code_;
}

int ChildProcess::wait() {
  constexpr double kLong_s = 3600;
  while (!wait(kLong_s)) {
  }
  return *code_;
}

std::string ChildProcess::said() const {
  std::ostringstream text;
  text << std::ifstream(log_).rdbuf();
  return text.str();
}

}  // namespace weft
