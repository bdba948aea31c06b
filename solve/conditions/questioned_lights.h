// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "solve/conditions/conditions.h"

namespace weft::solve {

/// Asks photographs without a rig whether their lights and values are what they are taken for
/// (solver/sanity/witnesses.h): the curve of the values, a light that is in all photographs, lamps that are
/// near, exposures that differ and files in the order of text, by how well left-out light is predicted.
/// Linear values that nothing but custom takes for sRGB, or the other way round, are mended where that is
/// sure; all else is a doubt, of which the likeliest alone is told. Those of a rig too are asked about the
/// axes of their lights (doubt_axes()).
Result<void> question_lights(const Exposures& exposures);

}  // namespace weft::solve
