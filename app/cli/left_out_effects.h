// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "simulator/simulation_plan.h"

namespace weft::app {

/// A line an effect: its name, sigma of noise that it would change at most, and why. `saved_seconds` of each
/// may be empty.
void print_left_out(std::span<const simulator::LeftOutEffect> left_out,
                    std::span<const double> saved_seconds = {});

}  // namespace weft::app
