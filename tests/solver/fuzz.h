// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace weft::test {

/// Gives every method `pixels` pixels altogether of readings that are anything a float can hold, under lights
/// from anywhere, and fails on the first output that breaks the contract of solver/method.h: a normal of
/// another length than 1, a value that is not finite or out of its range, status bits that contradict the
/// rest.
void expect_sound_from_rubbish(std::int64_t pixels, std::uint64_t seed);

}  // namespace weft::test
