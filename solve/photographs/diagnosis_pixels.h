// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "solve/photographs/photographs.h"
#include "solver/diagnosis/evidence_row.h"

namespace weft::solve {

/// Pixels for a diagnosis (solver/diagnosis/diagnosis.h), evenly from the sample tiles
/// (solver/sample_tiles.h): at most 1600, or fewer where there are more than twenty lights, down to 400;
/// those with fewer than three readings are left out. They depend on the photographs alone. Of RGB the
/// weighted sum of the channels, each over its strength, stands for the reading.
solver::Evidence read_evidence(const Photographs& photographs);

}  // namespace weft::solve
