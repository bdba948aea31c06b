// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/server/view/pixel_table.h"
#include "core/base/result.h"
#include "core/solve/solve.h"

namespace weft::app {

/// The readings of the solve that is asked about, in memory: read in the background when its first pixel is
/// asked for, and let go two minutes after the last. Safe from any thread.
class PixelTables {
 public:
  PixelTables();
  ~PixelTables();

  /// PixelTable::at(); nothing while readings are being read. kNoInput for a place outside; errors of
  /// PixelTable::read(), each said once.
  Result<std::optional<Json>> at(const std::filesystem::path& session, const SolveFacts& solve, int x, int y);

 private:
  struct Wanted {
    std::filesystem::path session;
    SolveFacts solve;
  };
  void run(const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<Wanted> wanted_;
  std::string id_;  ///< of the solve whose readings, or error, these are
  std::shared_ptr<const PixelTable> table_;
  std::optional<Error> error_;
  std::chrono::steady_clock::time_point asked_;
  std::jthread thread_;  ///< the last member: it uses all others
};

}  // namespace weft::app
