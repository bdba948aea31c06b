// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/solve/solve.h"
#include "solve/bands/deblur.h"
#include "solve/levels/reference.h"
#include "solve/levels/shifts.h"
#include "solver/gates/gates.h"
#include "solver/method.h"

// What the pipeline found, as solve.json says it (docs/formats.md).

namespace weft::solve {

std::vector<GateFacts> facts_of(const solver::Gates& gates);
SolvedBy facts_of(const solver::SolveTally& tally);

SharpeningFacts facts_of(const DeblurFacts& facts);
ReferenceLevelFacts facts_of(const ReferenceFacts& facts);

/// What the reference level could not do, a sentence each.
std::vector<std::string> warnings_of(const ReferenceFacts& facts);

/// A shot each. `leds` are the numbers of the lights, if they have any.
std::vector<RegisteredShot> facts_of(const SessionShifts& shifts, const std::vector<int>& leds);

}  // namespace weft::solve
