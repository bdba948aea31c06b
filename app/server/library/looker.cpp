// SPDX-License-Identifier: Apache-2.0
#include "app/server/library/looker.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace weft::app {
namespace {

constexpr int kRest = 20;  // of the time that a look took
constexpr auto kPatience = std::chrono::seconds(1);

}  // namespace

struct Looker::State {
  State(Look its_look, Clock::duration its_fresh) : look(std::move(its_look)), fresh(its_fresh) {}

  const Look look;
  const Clock::duration fresh;
  mutable std::mutex mutex;
  std::condition_variable changed;
  bool is_wanted = true, is_expired = false, is_stopped = false, is_gone = false;
  std::uint64_t begun = 0, ended = 0;  // looks
  Clock::time_point beat, end;         // the last ones
  Clock::duration took = {};

  bool is_looking() const { return begun > ended; }
  bool is_due() const {
    return ended == 0 || is_expired || fresh == fresh.zero() ||
           Clock::now() - end >= std::max(fresh, took * kRest);
  }
  void run(const std::stop_token& stop);
};

void Looker::State::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex);
  for (;;) {
    changed.wait(lock, [&] { return is_wanted || is_stopped; });
    if (is_stopped) break;
    is_wanted = is_expired = false;
    ++begun;
    const Clock::time_point began = beat = Clock::now();
    lock.unlock();
    look(stop, [&] {
      const std::lock_guard beat_lock(mutex);
      beat = Clock::now();
    });
    lock.lock();
    ended = begun;
    end = Clock::now();
    took = end - began;
    changed.notify_all();
  }
  is_gone = true;
  changed.notify_all();
}

Looker::Looker(Look look, Clock::duration fresh) : state_(std::make_shared<State>(std::move(look), fresh)) {
  // A thread that waits for a disk for ever cannot be joined. It holds all that it works on.
  std::thread([state = state_, stop = stop_.get_token()] { state->run(stop); }).detach();
}

Looker::~Looker() {
  stop_.request_stop();
  std::unique_lock lock(state_->mutex);
  state_->is_stopped = true;
  state_->changed.notify_all();
  state_->changed.wait_for(lock, kPatience, [&] { return state_->is_gone; });
}

void Looker::expire() {
  const std::lock_guard lock(state_->mutex);
  state_->is_expired = true;
}

std::uint64_t Looker::ask() {
  const std::lock_guard lock(state_->mutex);
  const bool is_anew = state_->fresh == state_->fresh.zero() || state_->is_expired;
  if (state_->is_looking() && !is_anew) return state_->begun;
  if (!state_->is_due()) return state_->ended;
  state_->is_wanted = true;
  state_->changed.notify_all();
  return state_->begun + 1;
}

void Looker::wait(std::uint64_t look, Clock::time_point until) {
  std::unique_lock lock(state_->mutex);
  state_->changed.wait_until(lock, until, [&] { return state_->ended >= look; });
}

bool Looker::is_first() const {
  const std::lock_guard lock(state_->mutex);
  return state_->ended == 0;
}

bool Looker::is_stuck() const {
  const std::lock_guard lock(state_->mutex);
  return state_->is_looking() && Clock::now() - state_->beat > kStuck;
}

}  // namespace weft::app
