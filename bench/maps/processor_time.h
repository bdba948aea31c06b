// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>

namespace weft::bench {

/// Processor time of all threads that body() took, in seconds: what a busy machine does not change much.
template <typename Body>
double processor_seconds(const Body& body) {
  const std::clock_t begin = std::clock();
  body();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

}  // namespace weft::bench
