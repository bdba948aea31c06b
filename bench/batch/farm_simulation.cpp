// SPDX-License-Identifier: Apache-2.0
#include "bench/batch/farm_simulation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <functional>
#include <limits>
#include <queue>
#include <random>
#include <tuple>
#include <vector>

namespace weft::bench {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

enum class Happening { kStart, kReady, kFailure, kReturn };

struct FarmEvent {
  double time = 0;
  std::uint64_t order = 0;  // of those at one time
  Happening what = Happening::kStart;
  std::size_t which = 0;  // task or node

  bool operator>(const FarmEvent& other) const {
    return std::tie(time, order) > std::tie(other.time, other.order);
  }
};

// The end of a session by the clock that runs as fast as the store lets sessions go on.
struct SessionEnd {
  double progress = 0;
  std::size_t slot = 0;
  std::uint64_t session = 0;

  bool operator>(const SessionEnd& other) const {
    return std::tie(progress, slot) > std::tie(other.progress, other.slot);
  }
};

struct Slot {
  std::size_t task = 0;
  bool is_taken = false;
  std::uint64_t session = 0;   // which of all that were ever begun
  double began = 0, rate = 0;  // bytes a second that it asks for
};

template <typename Item>
using Earliest = std::priority_queue<Item, std::vector<Item>, std::greater<>>;

class FarmSimulation {
 public:
  explicit FarmSimulation(const FarmModel& model)
      : m_(model),
        random_(model.seed),
        slots_(static_cast<std::size_t>(model.nodes) * static_cast<std::size_t>(model.slots)),
        is_up_(static_cast<std::size_t>(model.nodes), true),
        done_(static_cast<std::size_t>(model.tasks), 0) {
    for (std::size_t task = 0; task < done_.size(); ++task) ready_.push_back(task);
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) free_.push_back(slot);
  }

  FarmOutcome run() {
    const std::int64_t all = std::int64_t{m_.tasks} * m_.sessions;
    plan_failure();
    start_tasks();
    while (outcome_.sessions < all) {
      const double session_at = next_session_at();
      const double event_at = events_.empty() ? kNever : events_.top().time;
      go_to(std::min(session_at, event_at));
      if (session_at <= event_at) {
        end_session();
      } else {
        const FarmEvent event = events_.top();
        events_.pop();
        take(event);
      }
      start_tasks();
    }
    outcome_.seconds = now_;
    outcome_.busy = outcome_.useful_s / (now_ * static_cast<double>(slots_.size()));
    return outcome_;
  }

 private:
  double speed() const {
    if (m_.store_rate <= 0 || asked_rate_ <= m_.store_rate) return 1;
    return m_.store_rate / asked_rate_;
  }

  double next_session_at() {
    while (!ends_.empty() && slots_[ends_.top().slot].session != ends_.top().session) ends_.pop();
    if (ends_.empty()) return kNever;
    return std::max(now_, now_ + (ends_.top().progress - progress_) / speed());
  }

  void go_to(double time) {
    progress_ += (time - now_) * speed();
    now_ = time;
  }

  void plan(double time, Happening what, std::size_t which) { events_.push({time, ++order_, what, which}); }

  // Nodes fail without memory, so that one clock does for all.
  void plan_failure() {
    if (m_.failure_rate <= 0) return;
    std::exponential_distribution<double> wait(m_.failure_rate * m_.nodes);
    const double time = now_ + wait(random_);
    std::uniform_int_distribution<std::size_t> node(0, is_up_.size() - 1);
    plan(time, Happening::kFailure, node(random_));
  }

  double work_of_session() {
    double work = m_.session_s;
    if (m_.spread > 0) {
      const double variance = std::log1p(m_.spread * m_.spread);
      std::lognormal_distribution<double> seconds(std::log(m_.session_s) - variance / 2, std::sqrt(variance));
      work = seconds(random_);
    }
    if (m_.node_rate > 0) work = std::max(work, m_.bytes * m_.slots / m_.node_rate);
    return work;
  }

  void begin_session(std::size_t index, double start_s) {
    Slot& slot = slots_[index];
    const double work = work_of_session() + start_s;
    slot.session = ++begun_;
    slot.began = now_;
    slot.rate = work > 0 ? m_.bytes / work : 0;
    asked_rate_ += slot.rate;
    ends_.push({progress_ + work, index, slot.session});
  }

  // What a slot does is over, one way or the other.
  double stop_session(Slot& slot) {
    asked_rate_ = std::max(0.0, asked_rate_ - slot.rate);
    slot.session = 0;
    return now_ - slot.began;
  }

  void end_session() {
    const std::size_t index = ends_.top().slot;
    ends_.pop();
    Slot& slot = slots_[index];
    outcome_.useful_s += stop_session(slot);
    ++outcome_.sessions;
    if (++done_[slot.task] < m_.sessions) {
      begin_session(index, 0);
      return;
    }
    slot.is_taken = false;
    free_.push_back(index);
  }

  void start_tasks() {
    while (!ready_.empty() && !free_.empty()) {
      if (now_ < next_start_) {
        if (!is_start_planned_) plan(next_start_, Happening::kStart, 0);
        is_start_planned_ = true;
        return;
      }
      const std::size_t index = free_.front();
      free_.pop_front();
      slots_[index].task = ready_.front();
      slots_[index].is_taken = true;
      ready_.pop_front();
      begin_session(index, m_.start_s);
      if (m_.starts_rate > 0) next_start_ = now_ + 1 / m_.starts_rate;
    }
  }

  void take(const FarmEvent& event) {
    switch (event.what) {
      case Happening::kStart:
        is_start_planned_ = false;
        return;
      case Happening::kReady:
        ready_.push_back(event.which);
        return;
      case Happening::kFailure:
        if (is_up_[event.which]) fail(event.which);
        plan_failure();
        return;
      case Happening::kReturn:
        give_back(event.which);
        return;
    }
  }

  void fail(std::size_t node) {
    ++outcome_.failures;
    is_up_[node] = false;
    const auto slots = static_cast<std::size_t>(m_.slots);
    for (std::size_t index = node * slots; index < (node + 1) * slots; ++index) {
      Slot& slot = slots_[index];
      if (!slot.is_taken) continue;
      outcome_.lost_s += stop_session(slot);
      ++outcome_.lost;
      ++outcome_.requeued;
      slot.is_taken = false;
      plan(now_ + m_.notice_s + m_.wait_s, Happening::kReady, slot.task);
    }
    std::erase_if(free_, [&](std::size_t index) { return index / slots == node; });
    plan(now_ + m_.repair_s, Happening::kReturn, node);
  }

  void give_back(std::size_t node) {
    is_up_[node] = true;
    const auto slots = static_cast<std::size_t>(m_.slots);
    for (std::size_t index = node * slots; index < (node + 1) * slots; ++index) free_.push_back(index);
  }

  const FarmModel& m_;
  std::mt19937_64 random_;
  std::vector<Slot> slots_;
  std::vector<bool> is_up_;
  std::vector<int> done_;  // sessions, by task
  std::deque<std::size_t> ready_, free_;
  Earliest<FarmEvent> events_;
  Earliest<SessionEnd> ends_;
  double now_ = 0, progress_ = 0, asked_rate_ = 0, next_start_ = 0;
  bool is_start_planned_ = false;
  std::uint64_t order_ = 0, begun_ = 0;
  FarmOutcome outcome_;
};

}  // namespace

FarmOutcome simulate_farm(const FarmModel& model) {
  return FarmSimulation(model).run();
}

}  // namespace weft::bench
