// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "solve/conditions/conditions.h"
#include "solver/frame_fit/cell_fit.h"

// How frames are spoken of.

namespace weft::solve {

/// The number of photograph k's LED in its rig, else in the list of photographs.
int number_of(const Exposures& exposures, std::size_t k);
/// "LED 5"; "photograph 3 (c.dng)" where no rig took it.
std::string name_of(const Exposures& exposures, std::size_t k);

/// What takes the frame of a LED, or the dark one (0), again.
std::string how_again(const Exposures& exposures, int number);

/// "turns the normals by 1.1\u00b0 and makes albedo 20 percent too bright".
std::string words_of(const solver::CellChange& cost);

}  // namespace weft::solve
