// SPDX-License-Identifier: Apache-2.0
#include "solver/sample_tiles.h"

#include <algorithm>

#include "core/image/tiles.h"

namespace weft::solver {
namespace {

struct Span {
  int begin, end;
};

// Up to four spans over `length`, each in the middle of its quarter, starting on multiples of `group`.
std::vector<Span> spans(int length, int group) {
  const int count = std::clamp(length / kSampleTile, 1, 4);
  std::vector<Span> all;
  for (int i = 0; i < count; ++i) {
    const int part_begin = static_cast<int>(std::int64_t{length} * i / count);
    const int part_end = static_cast<int>(std::int64_t{length} * (i + 1) / count);
    const int slack = std::max(part_end - part_begin - kSampleTile, 0);
    int begin = (part_begin + slack / 2) / group * group;
    if (!all.empty()) begin = std::max(begin, (all.back().end + group - 1) / group * group);
    const int end = std::min(begin + kSampleTile, length);
    if (begin < end) all.push_back({begin, end});
  }
  return all;
}

}  // namespace

std::vector<Rect> sample_tiles(Size size) {
  std::vector<Rect> tiles;
  for (const Span& y : spans(size.height, 2)) {
    for (const Span& x : spans(size.width, kRowGroup)) tiles.push_back({x.begin, y.begin, x.end, y.end});
  }
  return tiles;
}

int sample_step(const std::vector<Rect>& tiles, std::size_t most_pixels) {
  const auto taken = [&](int step) {
    std::int64_t pixels = 0;
    for (const Rect& t : tiles) {
      pixels += std::int64_t{(t.width() + step - 1) / step} * ((t.height() + step - 1) / step);
    }
    return pixels;
  };
  int step = 1;
  while (step < kSampleTile && taken(step) > static_cast<std::int64_t>(most_pixels)) step += 2;
  return step;
}

}  // namespace weft::solver
