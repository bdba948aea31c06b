// SPDX-License-Identifier: Apache-2.0
#include "library/batch/choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace weft::library {
namespace {

constexpr std::size_t kCurvePoints = 12;

// Indices of the options that a session climbs: dearer and better, each step worth less a second than the one
// before.
std::vector<std::size_t> hull_of(const std::vector<LevelOption>& options) {
  std::vector<std::size_t> order(options.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    return std::tuple(options[a].seconds, options[a].degrees, a) <
           std::tuple(options[b].seconds, options[b].degrees, b);
  });
  const auto gain = [&](std::size_t from, std::size_t to) {
    return (options[from].degrees - options[to].degrees) / (options[to].seconds - options[from].seconds);
  };
  std::vector<std::size_t> hull;
  for (const std::size_t i : order) {
    if (!hull.empty() && !(options[i].degrees < options[hull.back()].degrees)) continue;
    while (hull.size() > 1 && gain(hull.back(), i) >= gain(hull[hull.size() - 2], hull.back()))
      hull.pop_back();
    hull.push_back(i);
  }
  return hull;
}

struct Step {
  double gain = 0, seconds = 0, degrees = 0;
  std::size_t session = 0, place = 0;  // of the hull that it leads to
};

}  // namespace

std::optional<std::size_t> cheapest_within(std::span<const LevelOption> options, double to_deg) {
  std::optional<std::size_t> cheapest;
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (options[i].degrees > to_deg) continue;
    if (!cheapest || options[i].seconds < options[*cheapest].seconds) cheapest = i;
  }
  return cheapest;
}

Result<Spending> spend(std::span<const std::vector<LevelOption>> sessions, double seconds) {
  Spending spending;
  std::vector<std::vector<std::size_t>> hulls;
  std::vector<Step> steps;
  double spent = 0, degrees = 0;
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    hulls.push_back(hull_of(sessions[s]));
    const std::vector<std::size_t>& hull = hulls.back();
    spending.chosen.push_back(hull.front());
    spent += sessions[s][hull.front()].seconds;
    degrees += sessions[s][hull.front()].degrees;
    for (std::size_t p = 1; p < hull.size(); ++p) {
      const LevelOption &from = sessions[s][hull[p - 1]], &to = sessions[s][hull[p]];
      const double more = to.seconds - from.seconds, less = from.degrees - to.degrees;
      steps.push_back({less / more, more, less, s, p});
    }
  }
  if (spent > seconds) {
    return Error{ErrorKind::kUsage, "there is not that little to do", fmt::format("--within {:g} s", seconds),
                 fmt::format("the cheapest level of all {} sessions takes {:.3g} hours", sessions.size(),
                             spent / 3600),
                 "allow more hours, or plan fewer sessions"};
  }
  // Steps of one session fall along its hull, so that this order never takes a later one first.
  std::ranges::stable_sort(steps, [](const Step& a, const Step& b) { return a.gain > b.gain; });
  const double count = static_cast<double>(std::max<std::size_t>(sessions.size(), 1));
  const std::size_t stride = std::max<std::size_t>(1, steps.size() / kCurvePoints);
  double along = spent, error = degrees;
  spending.curve.push_back({along / 3600, error / count});
  bool is_open = true;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Step& step = steps[i];
    if (is_open && spent + step.seconds <= seconds) {
      spent += step.seconds;
      spending.chosen[step.session] = hulls[step.session][step.place];
    } else {
      is_open = false;
    }
    along += step.seconds, error -= step.degrees;
    if ((i + 1) % stride == 0 || i + 1 == steps.size())
      spending.curve.push_back({along / 3600, error / count});
  }
  return spending;
}

}  // namespace weft::library
