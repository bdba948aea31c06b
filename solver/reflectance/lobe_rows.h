// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/vec.h"
#include "solver/kernels/row_task.h"
#include "solver/method.h"
#include "solver/reflectance/lobe_block.h"
#include "solver/reflectance/lobe_readings.h"

namespace weft::solver {

/// The readings of a tile, a row group at a time, in float32 vectors: as LobeReader reads them, over `unit`.
class LobeRows {
 public:
  /// `input` must outlive it.
  LobeRows(const TileInput& input, Sight sight, double unit = 1);
  LobeRows(const LobeRows&) = delete;
  LobeRows& operator=(const LobeRows&) = delete;
  /// Readings of a pixel, as LobeReader::count().
  std::size_t count() const { return input_.field->count() * tasks_.size(); }
  void go_to_row(int y);
  /// The pixels from column `x` of the tile, a multiple of kRowGroup, to the next or to the tile's end: all
  /// that a block has of readings. It is as if nothing were solved of it.
  void read(int x, LobeBlock& block) const;

 private:
  const TileInput& input_;
  Sight sight_;
  double unit_;
  std::vector<RowLight> lights_;
  std::vector<const float*> readings_;  ///< of one state of the films after the other
  std::vector<float> scratch_;
  RowPoints points_;
  std::vector<RowTask> tasks_;  ///< one a state
};

/// What a vector kernel reads.
struct LobeRowTask {
  const RowTask* states = nullptr;
  std::size_t state_count = 0;
  int planes = 1;
  float per_unit = 1;       ///< what readings over their strength are times
  bool is_far = false;      ///< the camera looks straight down from far away
  float camera_mm[3] = {};  ///< from the plane of the cloth
};

}  // namespace weft::solver
