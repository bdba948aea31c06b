// SPDX-License-Identifier: Apache-2.0
// libFuzzer program: any bytes as what a camera has sent. Build it by the `fuzz` preset.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "capture/camera/photograph_facts.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto facts = weft::capture::photograph_facts([=](std::uint64_t offset, std::span<std::uint8_t> part) {
    if (offset > size || size - offset < part.size()) return false;
    std::copy_n(data + offset, part.size(), part.begin());
    return true;
  });
  const bool sane = facts.exposure_us >= 0 && facts.iso >= 0 && facts.f_number >= 0 &&
                    facts.resolution_s > 0 && (!facts.taken_s || std::isfinite(*facts.taken_s));
  if (!sane) std::abort();
  return 0;
}
