// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace weft::app {

/// Work that may hang for ever, on a disk that does not answer, and is then waited for no longer than `most`.
/// It goes on by itself, one at a time: who asks meanwhile waits for the same. It may outlive this object,
/// and so must own all that it works on. Safe from any thread.
template <typename T>
class Awaited {
 public:
  explicit Awaited(std::chrono::milliseconds most) : most_(most) {}

  /// Nothing where it takes longer.
  std::optional<T> get(std::function<T()> work) {
    std::shared_future<T> result;
    {
      const std::lock_guard lock(mutex_);
      const bool runs =
          result_.valid() && result_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
      if (!runs) {
        std::packaged_task<T()> task(std::move(work));
        result_ = task.get_future().share();
        std::thread(std::move(task)).detach();
      }
      result = result_;
    }
    if (result.wait_for(most_) != std::future_status::ready) return std::nullopt;
    return result.get();
  }

 private:
  const std::chrono::milliseconds most_;
  std::mutex mutex_;
  std::shared_future<T> result_;
};

}  // namespace weft::app
