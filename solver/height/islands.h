// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/image/image.h"
#include "solver/height/slopes.h"

namespace weft::solver {

/// The parts of a mask whose pixels are joined along edges. Memory: 32 bytes a run of pixels in a row.
class Islands {
 public:
  explicit Islands(const Slopes& slopes);
  std::int64_t count() const { return count_; }
  /// Takes from every island the mean of its heights; what lies outside stays as it is.
  void remove_means(View<float> height, int threads) const;
  /// Writes 0 wherever there is no island.
  void clear_outside(View<float> height, int threads) const;

 private:
  /// Columns x0 <= x < x1 of row y.
  struct Run {
    int y, x0, x1;
  };
  std::vector<Run> runs_;
  std::vector<std::uint32_t> island_;  ///< of each run
  std::int64_t count_ = 0;
};

}  // namespace weft::solver
