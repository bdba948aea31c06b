// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "solve/photographs/photographs.h"
#include "solver/left_out/left_out.h"
#include "solver/method.h"

namespace weft::solve {

class LightCorrection;

/// One way to solve photographs. What it points to must outlive it.
struct SolveVariant {
  const solver::Method* method = nullptr;
  LightCorrection* correction = nullptr;  ///< readings go through it, if there is one
  std::span<const double> gains = {};  ///< by light, its light over that of its calibration; empty: all are 1
  /// Predicts the parallel ones of crossed and parallel photographs, which show lobes; else `frames`.
  bool judged_by_parallel = false;
};

/// Leaves out each light of the photographs in turn, solves the patches with the others and predicts its
/// readings. Patches are in the order of patches_of(). Of RGB the green plane is predicted. Costs a solve of
/// the patches a turn, and one run of the correction over the frame. Returns kInterrupted on request.
Result<solver::LeftOut> leave_out_lights(const Photographs& photographs, const SolveVariant& variant,
                                         std::span<const solver::Patch> patches, const JobContext& context);

/// The patches of at most four rows of blocks, in the middles of equal parts of the frame, row by row: what a
/// correction is traced for where the whole frame would take too long.
std::vector<std::vector<solver::Patch>> patches_of_few_rows(std::span<const solver::Patch> patches,
                                                            Size size);

/// The same in one list.
std::vector<solver::Patch> of_few_rows(std::span<const solver::Patch> patches, Size size);

/// Where `better` predicts left-out light better than `base` by more than its own sigma, on patches that
/// choose; where readings are corrected, on few rows of blocks, and the others follow the frame. A frame with
/// too few of them is all `better`: nothing speaks against it.
Result<solver::BlockChoice> choose_by_block(const Photographs& photographs, const SolveVariant& base,
                                            const SolveVariant& better, const JobContext& context);

}  // namespace weft::solve
