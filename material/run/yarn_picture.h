// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "material/lattice/lattice.h"
#include "material/surface.h"
#include "report/drawing.h"

namespace weft::app {

/// The middle of a cloth, relit, with lines as its yarns lie by a lattice of kRepeat, four yarns apart: so
/// that a person sees whether those are its yarns.
report::Picture yarn_picture(const material::Surface& surface, const material::Lattice& lattice);

}  // namespace weft::app
