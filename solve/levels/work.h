// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image.h"

namespace weft::solve {

/// Wall seconds of a solve, by what they grow with.
struct SolveWork {
  double frame = 0;     ///< with the pixels of the frame
  double few_rows = 0;  ///< with the patches of few rows of blocks (solve/correction/leave_out_lights.h)
  double choice = 0;    ///< with the patches of choose_light()
  double samples = 0;   ///< with the pixels of the sample tiles
  double lobe = 0;      ///< with nothing: a lobe is sought in kGlossPixels pixels

  double total() const { return frame + few_rows + choice + samples + lobe; }
};

/// What work that was measured on one frame would take on another of the same cloth.
SolveWork carried_over(const SolveWork& work, Size from, Size to);

}  // namespace weft::solve
