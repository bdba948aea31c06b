// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

/// Shadow rays to a point, to a LED with a size, and bounce rays on the deep weave, one thread, against bare
/// Embree: a scene of one robust grid of the same points, the same rays ready in its own structures and in
/// the cache, traced one by one or (shadows) in packets of 16, whichever is quicker.
///   ns_per_ray  all of the effect: making rays, tracing them, adding up what they met
///   trace_ns    HeightMesh alone on ready rays
///   ratio       ns_per_ray over bare_ns;  trace_ratio  trace_ns over bare_ns
Result<Rows> effects_embree();

}  // namespace weft::bench
