// SPDX-License-Identifier: Apache-2.0
#include "library/import/capture_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <utility>

#include "core/base/text.h"

namespace weft::library {
namespace {

using Indices = std::vector<std::size_t>;

constexpr std::size_t kFramesAStep = 8;  ///< a clock without a battery begins anew with each session
constexpr std::size_t kMostGaps = 2;     ///< times as many numbers as frames

std::size_t counted_number(const SourceFrame& frame) {
  return frame.said.index ? static_cast<std::size_t>(*frame.said.index) : count_of(frame.label).number;
}

bool names_count_on(const std::vector<SourceFrame>& frames, const Indices& order) {
  const std::string word = count_of(frames[order.front()].label).word;
  const auto is_counted = [&](const SourceFrame& frame) {
    return frame.said.index || (count_of(frame.label).word == word && count_of(frame.label).end > 1);
  };
  if (!std::ranges::all_of(frames, is_counted)) return false;
  for (std::size_t i = 1; i < order.size(); ++i)
    if (counted_number(frames[order[i]]) <= counted_number(frames[order[i - 1]])) return false;
  return counted_number(frames[order.back()]) - counted_number(frames[order.front()]) <
         kMostGaps * frames.size();
}

/// True too where a photograph does not say its count.
bool camera_counts_on(const std::vector<SourceFrame>& frames, const Indices& order) {
  if (!std::ranges::all_of(frames, [](const SourceFrame& f) { return f.image_number.has_value(); }))
    return true;
  return std::ranges::adjacent_find(order, [&](std::size_t a, std::size_t b) {
           return *frames[a].image_number >= *frames[b].image_number;
         }) == order.end();
}

}  // namespace

std::vector<std::size_t> order_of_names(const std::vector<SourceFrame>& frames) {
  Indices order(frames.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    const auto &left = frames[a].said.index, &right = frames[b].said.index;
    if (left && right && *left != *right) return *left < *right;
    return stands_before(frames[a].label, frames[b].label);
  });
  return order;
}

std::optional<std::vector<std::size_t>> order_of_times(const std::vector<SourceFrame>& frames) {
  if (!std::ranges::all_of(frames, [](const SourceFrame& f) { return f.taken_s.has_value(); })) return {};
  Indices order = order_of_names(frames);
  std::ranges::stable_sort(
      order, [&](std::size_t a, std::size_t b) { return *frames[a].taken_s < *frames[b].taken_s; });
  return order;
}

NameCount count_of(const std::string& label) {
  const std::filesystem::path path(label);
  NameCount count = {(path.parent_path() / path.stem()).string(), 0, 1};
  for (; !count.word.empty() && count.word.back() >= '0' && count.word.back() <= '9' && count.end < 1'000'000;
       count.word.pop_back()) {
    count.number += static_cast<std::size_t>(count.word.back() - '0') * count.end;
    count.end *= 10;
  }
  return count;
}

std::string words_of(const ClockStep& step, const std::vector<SourceFrame>& frames) {
  return fmt::format("the camera's clock went back by {:.0f} s between {} and {}", step.back_s,
                     frames[step.before].label, frames[step.after].label);
}

std::optional<CountedOrder> counted_order(const std::vector<SourceFrame>& frames) {
  if (frames.empty()) return {};
  CountedOrder counted = {order_of_names(frames), {}};
  if (!names_count_on(frames, counted.order) || !camera_counts_on(frames, counted.order)) return {};
  std::optional<std::size_t> last;
  for (const std::size_t f : counted.order) {
    if (!frames[f].taken_s) continue;
    if (const double back_s = last ? *frames[*last].taken_s - *frames[f].taken_s : 0; back_s > 0)
      counted.steps.push_back({*last, f, back_s});
    last = f;
  }
  if (counted.steps.size() > std::max<std::size_t>(1, frames.size() / kFramesAStep)) return {};
  return counted;
}

}  // namespace weft::library
