// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

namespace weft::capture {

/// The lines that arrive on a descriptor, read by a thread of its own, so that the end of the parent is
/// noticed while a call into libgphoto2 blocks. (PR_SET_PDEATHSIG would follow the thread that started this
/// process, not the parent.)
class RequestLines {
 public:
  explicit RequestLines(int in);
  /// Within 3 s of the end of the input: the process ends otherwise.
  ~RequestLines();
  RequestLines(const RequestLines&) = delete;
  RequestLines& operator=(const RequestLines&) = delete;

  /// Waits for the next line; nothing at the end. A line that is too long comes as an empty one.
  std::optional<std::string> next();
  /// Whether the input has ended.
  bool ended() const;

 private:
  void read_all(int in);
  void take(std::string_view bytes);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::string> lines_;
  std::string part_;
  bool too_long_ = false;
  bool ended_ = false;
  bool done_ = false;  // nobody asks any more
  std::thread thread_;
};

}  // namespace weft::capture
