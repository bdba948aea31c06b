// SPDX-License-Identifier: Apache-2.0
#include "solver/sample_tiles.h"

#include <algorithm>

#include "core/tiles.h"

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

}  // namespace weft::solver
