// SPDX-License-Identifier: Apache-2.0
#include "capture/frames/raw_picture.h"

#include <optional>

#include "core/rig/radiometry.h"
#include "core/rig/veil.h"

namespace weft::capture {

Image<float> half_size_picture(const RawFrame& frame, const Response& response) {
  const Radiometry radiometry(frame, nullptr, response, {1e6, 100});
  const Size size = frame.counts.size();
  const auto read = [&](Rect rows, View<float> out) { radiometry.read(frame.counts.plane(), rows, out); };
  std::optional<VeilOverFrame> veil;
  if (response.veil) veil.emplace(*response.veil, size, frame.cfa, read);
  Image<float> half({size.width / 2, size.height / 2}, 3), rows({size.width, 2});
  for (int y = 0; y < half.height(); ++y) {
    const Rect two = {0, 2 * y, size.width, 2 * y + 2};
    read(two, rows.plane());
    if (veil) veil->take_off(two, rows.plane());
    for (int x = 0; x < half.width(); ++x) {
      std::array<float, 3> sum = {}, count = {};
      for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) {
          const auto c = static_cast<std::size_t>(frame.cfa.channel_at(i, j));
          sum[c] += rows(2 * x + i, j);
          ++count[c];
        }
      }
      for (int c = 0; c < 3; ++c) {
        half(x, y, c) = sum[static_cast<std::size_t>(c)] / count[static_cast<std::size_t>(c)];
      }
    }
  }
  return half;
}

}  // namespace weft::capture
