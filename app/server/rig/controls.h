// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "core/base/result.h"

namespace weft::app {

/// Who commands a rig. One client at a time may hold its controls, by a lease that it renews; another takes
/// them over only where it says so. While nobody holds them, whoever may operate the rig commands it. Safe
/// from any thread.
class Controls {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kLease{10};

  /// `changed` hears the holder's name whenever there is another one; empty: nobody.
  explicit Controls(std::function<void(const std::string& name)> changed, Clock::duration lease = kLease);

  /// Gives the controls to who calls itself `name`, and the id to command and renew with. kTryAgain, naming
  /// the holder, where another one has them and `from_another` is false; kUsage for a name that is empty,
  /// over 60 characters or not plain text.
  Result<std::string> take(const std::string& name, bool from_another);
  /// Leases that run out are not told any more.
  void stop() { watch_ = {}; }

  /// False where this is not the holder's id.
  bool renew(const std::string& id);
  void release(const std::string& id);

  /// The holder's name; empty: nobody.
  std::string holder() const;
  /// The holder's name where this is its id, else empty.
  std::string name_of(const std::string& id) const;
  /// Who commands with this id, which may be empty: the holder's name, or "" where nobody holds the controls.
  /// kTryAgain, naming the holder, where another one does.
  Result<std::string> commander(const std::string& id) const;

 private:
  struct Lease {
    std::string id, name;
    Clock::time_point until;
  };
  const Lease* held() const;  ///< null where nobody, or no more
  void watch(const std::stop_token& stop);

  const std::function<void(const std::string& name)> changed_;
  const Clock::duration lease_time_;
  std::mutex telling_;  ///< held from a change until it is told
  mutable std::mutex mutex_;
  std::condition_variable_any renewed_;
  std::optional<Lease> lease_;
  std::jthread watch_;  ///< tells of leases that run out
};

}  // namespace weft::app
