// SPDX-License-Identifier: Apache-2.0
#include "solve/levels/work.h"

#include "solve/correction/leave_out_lights.h"
#include "solve/correction/light_choice.h"
#include "solver/left_out/blocks.h"
#include "solver/sample_tiles.h"

namespace weft::solve {
namespace {

// How much of each there is in a frame; one of `lobe`.
SolveWork amounts_in(Size frame) {
  SolveWork amounts;
  amounts.frame = static_cast<double>(frame.pixels());
  amounts.few_rows =
      static_cast<double>(of_few_rows(solver::patches_of(frame, solver::PatchUse::kChoose), frame).size());
  amounts.choice = static_cast<double>(light_choice_patches(frame));
  for (const Rect& tile : solver::sample_tiles(frame)) amounts.samples += static_cast<double>(tile.pixels());
  amounts.lobe = 1;
  return amounts;
}

}  // namespace

SolveWork carried_over(const SolveWork& work, Size from, Size to) {
  const SolveWork measured = amounts_in(from), wanted = amounts_in(to);
  SolveWork carried;
  for (double SolveWork::*part :
       {&SolveWork::frame, &SolveWork::few_rows, &SolveWork::choice, &SolveWork::samples, &SolveWork::lobe}) {
    if (measured.*part > 0) carried.*part = work.*part * (wanted.*part / measured.*part);
  }
  return carried;
}

}  // namespace weft::solve
