// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/job.h"
#include "core/result.h"
#include "pipeline/photographs.h"
#include "solver/method.h"
#include "solver/reflectance/lobe_readings.h"
#include "solver/reflectance/measured_lobe.h"

namespace weft::pipeline {

/// From where the photographs see the cloth.
solver::Sight sight_of(const Photographs& photographs);

/// At most so many pixels of a material are fitted: more say nothing of a lobe that model error does not
/// drown.
inline constexpr std::size_t kGlossPixels = 4000;

/// The lobe that the pixels of the sample tiles (solver/sample_tiles.h) share, from where `base` solves them.
/// They depend on the photographs alone.
solver::MeasuredLobe measure_gloss(const Photographs& photographs, const solver::Method& base, int threads);

}  // namespace weft::pipeline
