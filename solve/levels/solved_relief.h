// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/base/result.h"
#include "core/image/image.h"
#include "solve/correction/light_correction.h"
#include "solve/levels/reference.h"
#include "solve/photographs/photographs.h"
#include "solver/transport/relief.h"

namespace weft::solve {

/// A solved frame as a relief, and what its light does to readings.
class SolvedRelief {
 public:
  /// `photographs` must outlive it. Errors: of solver::height_from_normals() and solver::Relief.
  static Result<std::shared_ptr<SolvedRelief>> of(const Photographs& photographs, SolvedFrame solved,
                                                  const ReferenceOptions& options, int threads);

  /// These must not outlive it. Takes out what `facts` say, with every direction.
  LightCorrection correction() const { return correction_of(facts.stages); }
  LightCorrection correction_of(const LightStages& stages) const;
  /// As coarse as before the last round.
  LightCorrection early_correction() const;

  SolvedFrame solved;
  ReferenceOptions options;
  ReferenceRound facts;

 private:
  SolvedRelief(const Photographs& photographs, SolvedFrame frame, const ReferenceOptions& options,
               int threads);
  Result<void> integrate();

  const Photographs& photographs_;
  int threads_;
  Image<float> height_;
  solver::Relief relief_;
};

}  // namespace weft::solve
