// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/accuracy/accuracy.h"
#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

/// What else trades accuracy for time, each as a curve over all scenes: resolution (preview, fast), float or
/// double (robust in float32 kernels and in double), rays a pixel and rounds of the reference level. Rows:
/// "curve", "setting", "mean_deg", "p95_deg", "albedo_mean_rel", "ns_per_pixel", "threads".
Result<Rows> accuracy_curves(const AccuracyTableOptions& options);

/// What the gates of the reference level decide, by scene: mean error with each gate's say, and with all
/// stages forced. Rows: "scene", "method" (gated, forced), "mean_deg", "p95_deg", "albedo_mean_rel",
/// "ns_per_pixel".
Result<Rows> accuracy_gates(const AccuracyTableOptions& options);

}  // namespace weft::bench
