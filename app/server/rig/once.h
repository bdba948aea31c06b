// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <string>

#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

/// A deed that a client asks for by an id of its own, so that a click that comes twice is done once. Safe
/// from any thread.
class Once {
 public:
  /// What `deed` answers; the last answer where this id asked for it. Without an id it is done each time.
  Result<Json> answer(const std::string& id, const std::function<Result<Json>()>& deed) {
    const std::lock_guard lock(mutex_);
    if (!id.empty() && id == last_) return answer_;
    Result<Json> answer = deed();
    if (answer) last_ = id, answer_ = *answer;
    return answer;
  }

 private:
  std::mutex mutex_;
  std::string last_;
  Json answer_;
};

}  // namespace weft::app
