// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/controls.h"

#include <algorithm>
#include <utility>

#include "app/server/http/http_guard.h"

namespace weft::app {
namespace {

constexpr std::size_t kLongestName = 60;

Error held_by(const std::string& name) {
  return {ErrorKind::kTryAgain, "somebody else holds the controls", name,
          "one client commands a rig at a time",
          "wait until they are free, or take them over (POST control with take)"};
}

bool is_plain(const std::string& name) {
  return !name.empty() && name.size() <= kLongestName && std::ranges::none_of(name, [](unsigned char c) {
    return c < 0x20 || c == 0x7f || c == '<' || c == '>';
  });
}

}  // namespace

Controls::Controls(std::function<void(const std::string& name)> changed, Clock::duration lease)
    : changed_(std::move(changed)),
      lease_time_(lease),
      watch_([this](const std::stop_token& stop) { watch(stop); }) {}

const Controls::Lease* Controls::held() const {
  return lease_ && Clock::now() < lease_->until ? &*lease_ : nullptr;
}

Result<std::string> Controls::take(const std::string& name, bool from_another) {
  if (!is_plain(name)) {
    return Error{ErrorKind::kUsage, "the controls need a name", "name",
                 "it must be 1 to 60 characters of plain text without < and >",
                 "say who commands, such as \"Ann at the desk\""};
  }
  Result<std::string> id = new_token();
  if (!id) return id;
  const std::lock_guard telling(telling_);
  {
    const std::lock_guard lock(mutex_);
    if (const Lease* other = held(); other != nullptr && !from_another) return held_by(other->name);
    lease_ = Lease{*id, name, Clock::now() + lease_time_};
  }
  renewed_.notify_all();
  changed_(name);
  return id;
}

bool Controls::renew(const std::string& id) {
  const std::lock_guard lock(mutex_);
  if (held() == nullptr || lease_->id != id) return false;
  lease_->until = Clock::now() + lease_time_;
  return true;
}

void Controls::release(const std::string& id) {
  const std::lock_guard telling(telling_);
  {
    const std::lock_guard lock(mutex_);
    if (held() == nullptr || lease_->id != id) return;
    lease_.reset();
  }
  changed_("");
}

void Controls::watch(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    {
      std::unique_lock lock(mutex_);
      if (!lease_) renewed_.wait(lock, stop, [&] { return lease_.has_value(); });
      if (!lease_) return;
      const Clock::time_point until = lease_->until;
      renewed_.wait_until(lock, stop, until, [&] { return !lease_ || lease_->until < until; });
    }
    const std::lock_guard telling(telling_);
    {
      const std::lock_guard lock(mutex_);
      if (stop.stop_requested() || !lease_ || held() != nullptr) continue;
      lease_.reset();
    }
    changed_("");
  }
}

std::string Controls::holder() const {
  const std::lock_guard lock(mutex_);
  const Lease* lease = held();
  return lease != nullptr ? lease->name : "";
}

std::string Controls::name_of(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const Lease* lease = held();
  return lease != nullptr && lease->id == id ? lease->name : "";
}

Result<std::string> Controls::commander(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const Lease* lease = held();
  if (lease == nullptr) return std::string();
  if (lease->id != id) return held_by(lease->name);
  return lease->name;
}

}  // namespace weft::app
