// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

// Points that cover the unit square evenly, for a pixel's rays: Sobol's first two dimensions (1967),
// scrambled as Owen does (1995) by the hash of Laine and Karras (2011) as in Burley, "Practical hash-based
// Owen scrambling" (JCGT 9(4), 2020, listing 1 and section 3). Each run of 2^m points from a multiple of 2^m
// on is a (0, m, 2)-net. Burley also shuffles the order of the points; a pixel takes them all, so this does
// not.

namespace weft::simulator {

/// What turns the one sequence into that of a pixel, dimension by dimension.
struct Scramble {
  std::uint32_t first = 0;
  std::uint32_t second = 0;
};

/// The scramble of a pixel by philox: independent from pixel to pixel (absolute, may be negative), seed to
/// seed and stream to stream. A stream is a use of random numbers, such as a LED's shadow or the bounces.
Scramble scramble_of(std::uint64_t seed, int x, int y, std::uint32_t stream);

/// A point of the unit square.
struct SquarePoint {
  float u = 0;  ///< in [0, 1), a multiple of 2^-24
  float v = 0;
};

namespace detail {

/// Written in this order, for else GCC makes a byte swap of it, and SSE2 has none for vectors.
inline std::uint32_t reversed_bits(std::uint32_t x) {
  x = x << 16 | x >> 16;
  x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
  x = (x & 0x00ff00ffu) << 8 | (x >> 8 & 0x00ff00ffu);
  x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
  return (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
}

/// Product with Pascal's triangle modulo 2, which is what makes Sobol's second dimension of the first. The
/// triangle of size 2n is the one of size n at three corners, hence a step for each power of two.
inline std::uint32_t pascal_product(std::uint32_t x) {
  x ^= (x & 0xaaaaaaaau) >> 1;
  x ^= (x & 0xccccccccu) >> 2;
  x ^= (x & 0xf0f0f0f0u) >> 4;
  x ^= (x & 0xff00ff00u) >> 8;
  return x ^ x >> 16;
}

/// A bit of the result depends on the same and lower bits of x, and on the seed.
inline std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  return x ^ x * 0x8d22f6e6u;
}

inline float unit_interval(std::uint32_t bits) {
  return static_cast<float>(static_cast<std::int32_t>(bits >> 8)) * 0x1p-24f;
}

}  // namespace detail

/// Inline, and without branches, so that a loop over `index` is done by vector instructions.
inline SquarePoint sobol(std::uint32_t index, Scramble scramble) {
  using namespace detail;
  return {unit_interval(reversed_bits(laine_karras(index, scramble.first))),
          unit_interval(reversed_bits(laine_karras(pascal_product(index), scramble.second)))};
}

}  // namespace weft::simulator
