// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/request_lines.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>

namespace weft::capture {
namespace {

constexpr std::size_t kLongestLine = std::size_t{64} << 10;
constexpr auto kPatience = std::chrono::seconds(3);

}  // namespace

RequestLines::RequestLines(int in) : thread_([this, in] { read_all(in); }) {}

RequestLines::~RequestLines() {
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::optional<std::string> RequestLines::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return ended_ || !lines_.empty(); });
  // What the parent asked for and will not hear of any more is left undone.
  if (ended_) return {};
  std::string line = std::move(lines_.front());
  lines_.pop_front();
  return line;
}

bool RequestLines::ended() const {
  const std::lock_guard lock(mutex_);
  return ended_;
}

void RequestLines::read_all(int in) {
  std::array<char, 4096> block;
  for (;;) {
    const ssize_t n = ::read(in, block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    take({block.data(), static_cast<std::size_t>(n)});
  }
  std::unique_lock lock(mutex_);
  ended_ = true;
  changed_.notify_all();
  if (!changed_.wait_for(lock, kPatience, [this] { return done_; })) ::_exit(1);
}

void RequestLines::take(std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  for (const char c : bytes) {
    if (c == '\n') {
      lines_.push_back(too_long_ ? std::string() : std::move(part_));
      part_.clear();
      too_long_ = false;
    } else if (part_.size() == kLongestLine) {
      too_long_ = true;
    } else {
      part_ += c;
    }
  }
  changed_.notify_all();
}

}  // namespace weft::capture
