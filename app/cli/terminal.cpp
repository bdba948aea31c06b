// SPDX-License-Identifier: Apache-2.0
#include "app/cli/terminal.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <optional>
#include <thread>

#include "core/base/files.h"
#include "core/describe/error_json.h"

namespace weft::app {
namespace {

constexpr int kBarCells = 30;

volatile std::sig_atomic_t signal_seen = 0;

extern "C" void on_signal(int signal) {
  if (signal_seen != 0) _exit(130);
  signal_seen = signal;
}

bool speaks_events = false;

void write_all(std::FILE* stream, std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stream);
}

// Texts that are no UTF-8, a file's name say, are mended rather than lost.
void tell(const Json& event) {
  write_all(stderr, event.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

// Names of files and words of people must not steer a terminal.
std::string shown(std::string_view text) {
  std::string line(text);
  const auto steers = [](char c) { return (c >= 0 && c < ' ' && c != '\n' && c != '\t') || c == 0x7f; };
  std::ranges::replace_if(line, steers, ' ');
  return line + '\n';
}

// What is left of a phase that began `seconds` ago; nothing where it is too early to say.
std::optional<double> seconds_left(double share, double seconds) {
  if (share <= 0.02 || seconds <= 0.5) return std::nullopt;
  return seconds / share * (1 - share);
}

}  // namespace

void speak_events() {
  speaks_events = true;
}
void tell_end(int exit_code) {
  if (speaks_events) tell({{"event", "end"}, {"exit_code", exit_code}});
}

ProgressLine::ProgressLine(bool quiet)
    : quiet_(quiet && !speaks_events), terminal_(!speaks_events && isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (drawn_ && terminal_) write_all(stderr, "\r\x1b[K");
}

Progress ProgressLine::callback() {
  return [this](std::string_view phase, double share) { update(phase, share); };
}

void ProgressLine::update(std::string_view phase, double share) {
  const std::lock_guard lock(mutex_);
  if (quiet_) return;
  const Clock::time_point now = Clock::now();
  const bool new_phase = phase != phase_;
  if (new_phase) {
    phase_ = phase;
    phase_began_ = now;
  }
  const std::chrono::milliseconds pause(speaks_events ? 200 : terminal_ ? 100 : 10000);
  if (!new_phase && now - last_drawn_ < pause && share < 1) return;
  if (!terminal_ && !new_phase && share >= 1) return;
  last_drawn_ = now;
  draw(share, now);
}

std::function<void(const std::string&)> ProgressLine::teller() {
  return [this](const std::string& step) {
    const std::scoped_lock lock(mutex_);
    if (quiet_) return;
    if (terminal_ && drawn_) write_all(stderr, "\r\x1b[K");
    drawn_ = false;
    note(step);
  };
}

void ProgressLine::draw(double share, Clock::time_point now) {
  drawn_ = true;
  const double seconds = std::chrono::duration<double>(now - phase_began_).count();
  const std::optional<double> left_s = seconds_left(share, seconds);
  if (speaks_events) {
    tell({{"event", "progress"},
          {"phase", phase_},
          {"share", share},
          {"left_s", left_s ? Json(*left_s) : Json()}});
    return;
  }
  const std::string left = left_s ? fmt::format("  {:.0f} s left", *left_s) : "";
  if (!terminal_) {
    write_all(stderr, fmt::format("{} {:.0f} %{}\n", phase_, 100 * share, left));
    return;
  }
  const int full = static_cast<int>(share * kBarCells);
  write_all(stderr,
            fmt::format("\r{:<9} [{}{}] {:3.0f} %{}\x1b[K", phase_,
                        std::string(static_cast<std::size_t>(full), '#'),
                        std::string(static_cast<std::size_t>(kBarCells - full), '.'), 100 * share, left));
  std::fflush(stderr);
}

bool is_stopped_by_hand() {
  return signal_seen == SIGINT;
}

std::stop_token stop_on_signal() {
  static std::stop_source source;
  static std::jthread watcher([](const std::stop_token& ending) {
    while (!ending.stop_requested()) {
      if (signal_seen != 0) source.request_stop();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  });
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  // A full disk quota and a closed pipe come back as errors of the call, not as the end of the program.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  return source.get_token();
}

std::optional<std::string> typed_line(const std::stop_token& stop) {
  std::string line;
  while (!stop.stop_requested()) {
    pollfd waiting = {STDIN_FILENO, POLLIN, 0};
    if (::poll(&waiting, 1, 100) <= 0) continue;
    char c = 0;
    if (::read(STDIN_FILENO, &c, 1) != 1) return std::nullopt;
    if (c == '\n') return line;
    line += c;
  }
  return std::nullopt;
}

void print(std::string_view text) {
  write_all(stdout, shown(text));
}
void print_json(const Json& document) {
  write_all(stdout, document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void print_product(Json document, const std::filesystem::path& folder, bool was_there) {
  document["folder"] = folder.string();
  document["was_there"] = was_there;
  print_json(document);
}

Result<void> flush_output() {
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (flushed) return {};
  return cannot_write("standard output", errno != 0 ? errno : EIO);
}
void complain(const Error& error) {
  if (!speaks_events) return note("weft: " + error.message());
  Json event = {{"event", "error"}};
  event.update(json_of(error));
  tell(event);
}
void note(std::string_view text) {
  if (speaks_events) return tell({{"event", "note"}, {"text", text}});
  write_all(stderr, shown(text));
}

}  // namespace weft::app
