// SPDX-License-Identifier: Apache-2.0
#include "app/server/view/pixel_tables.h"

#include <chrono>
#include <exception>
#include <utility>

#include "app/server/http/error_reply.h"

namespace weft::app {
namespace {

constexpr std::chrono::minutes kHeld(2);
constexpr int kReaders = 2;  // threads: a scan may run beside

}  // namespace

PixelTables::PixelTables() : thread_([this](const std::stop_token& stop) { run(stop); }) {}
PixelTables::~PixelTables() = default;

Result<std::optional<Json>> PixelTables::at(const std::filesystem::path& session, const SolveFacts& solve,
                                            int x, int y) {
  if (x < 0 || y < 0 || x >= solve.size.width || y >= solve.size.height)
    return Error{ErrorKind::kNoInput, "the place is outside the maps", "", "",
                 "see the solve for their size"};
  std::shared_ptr<const PixelTable> table;
  {
    const std::lock_guard lock(mutex_);
    asked_ = std::chrono::steady_clock::now();
    const bool is_there = id_ == solve.id;
    if (is_there && error_) {
      id_.clear();
      return *std::exchange(error_, std::nullopt);
    }
    if (!is_there || table_ == nullptr) {
      wanted_ = Wanted{session, solve};
      changed_.notify_all();
      return std::optional<Json>();
    }
    table = table_;
  }
  return std::optional(table->at(x, y));
}

void PixelTables::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    if (!changed_.wait_for(lock, stop, std::chrono::seconds(5), [&] { return wanted_.has_value(); })) {
      if (std::chrono::steady_clock::now() - asked_ > kHeld) table_.reset();
      continue;
    }
    const Wanted wanted = *std::exchange(wanted_, std::nullopt);
    if (id_ == wanted.solve.id && table_ != nullptr) continue;
    table_.reset();  // before others are read: both may be large
    error_.reset();
    id_.clear();
    lock.unlock();
    Result<std::unique_ptr<PixelTable>> read = [&]() -> Result<std::unique_ptr<PixelTable>> {
      try {
        return PixelTable::read(wanted.session, wanted.solve, {.threads = kReaders, .stop = stop});
      } catch (const std::exception& thrown) {
        return error_of_exception(thrown, wanted.session.string());
      }
    }();
    lock.lock();
    id_ = wanted.solve.id;
    if (read) {
      table_ = std::move(*read);
    } else {
      error_ = read.error();
    }
  }
}

}  // namespace weft::app
