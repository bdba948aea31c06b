// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "core/base/job_context.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

/// From now on standard error is for programs: a line of JSON for each change of progress (at most five a
/// second), each note, each error and the end (docs/http.md).
void speak_events();
/// {"event": "end", "exit_code": 0}, where events are spoken.
void tell_end(int exit_code);

/// Progress on standard error: one bar with an estimate on a terminal, a plain line a phase and every ten
/// seconds elsewhere, nothing at all when quiet.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  void update(std::string_view phase, double share);
  Progress callback();
  /// Says on a line of its own, above the bar, what is done next.
  std::function<void(const std::string& step)> teller();

 private:
  using Clock = std::chrono::steady_clock;
  void draw(double share, Clock::time_point now);

  std::mutex mutex_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  std::string phase_;
  Clock::time_point phase_began_, last_drawn_;
};

/// The stop token that SIGINT and SIGTERM request; a second signal ends the program at once.
std::stop_token stop_on_signal();
/// Whether the signal was SIGINT, as of Ctrl-C; a farm ends what it runs by SIGTERM.
bool is_stopped_by_hand();

/// A line that a person typed; nothing at the end of input or when stopped.
std::optional<std::string> typed_line(const std::stop_token& stop);

void print(std::string_view text);  ///< to standard output, with a line end
void print_json(const Json& document);
/// The document of a product with its `folder`, and whether it `was_there` before.
void print_product(Json document, const std::filesystem::path& folder, bool was_there);
/// kInputOutput if anything printed did not reach standard output: a full disk, a closed pipe.
Result<void> flush_output();
void complain(const Error& error);  ///< to standard error
void note(std::string_view text);   ///< to standard error

}  // namespace weft::app
