// SPDX-License-Identifier: Apache-2.0
#include "solver/in_double/triples.h"

#include <cstdint>
#include <map>

namespace weft::solver {
namespace {

// The i-th number of a stream that depends on n alone (splitmix64: Steele et al., OOPSLA 2014).
std::uint64_t hashed(std::uint64_t n, std::uint64_t i) {
  std::uint64_t z = (n << 32) + (i + 1) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

std::vector<Triple> all_triples(std::size_t n) {
  std::vector<Triple> triples;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      for (std::size_t k = j + 1; k < n; ++k) triples.push_back({i, j, k});
    }
  }
  return triples;
}

std::vector<Triple> drawn_triples(std::size_t n) {
  std::vector<Triple> triples;
  for (std::uint64_t counter = 0; triples.size() < kMostTriples; ++counter) {
    Triple t;
    for (std::size_t i = 0; i < 3; ++i) t[i] = static_cast<std::size_t>(hashed(n, 3 * counter + i) % n);
    if (t[0] != t[1] && t[1] != t[2] && t[0] != t[2]) triples.push_back(t);
  }
  return triples;
}

}  // namespace

const std::vector<Triple>& triples_of(std::size_t n) {
  thread_local std::map<std::size_t, std::vector<Triple>> made;
  const auto found = made.find(n);
  if (found != made.end()) return found->second;
  const bool few = n < 3 || n * (n - 1) * (n - 2) / 6 <= kMostTriples;
  return made.emplace(n, few ? all_triples(n) : drawn_triples(n)).first->second;
}

}  // namespace weft::solver
