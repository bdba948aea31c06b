// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace weft::solver {

/// Three of n readings, by index.
using Triple = std::array<std::size_t, 3>;

/// At most so many triples are tried.
inline constexpr std::size_t kMostTriples = 500;

/// All triples of 0 .. n-1 in lexical order, or where those are more than kMostTriples, so many drawn from a
/// counter-based generator: the same ones for the same n, everywhere. Each thread keeps its own.
const std::vector<Triple>& triples_of(std::size_t n);

/// How many of n readings least trimmed squares wants to agree: eight of ten.
inline std::size_t trimmed_count(std::size_t n) {
  return (8 * n + 9) / 10;
}

/// Three directions with a smaller determinant are left out: their solution is mostly noise.
inline constexpr double kLeastTripleDeterminant = 0.02;

}  // namespace weft::solver
