// SPDX-License-Identifier: Apache-2.0
// libFuzzer program: any bytes as a file of lights.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "solve/input/light_list.h"

namespace {

void demand(bool promise) {
  if (!promise) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace weft::solve;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const char* name : {"l.lp", "l.csv"}) {
    const weft::Result<LightList> list = parse_light_list(bytes, name);
    if (!list) {
      demand(!list.error().why.empty() && !list.error().remedy.empty());
      continue;
    }
    demand(!list->lights.empty());
    for (const ListedLight& light : list->lights) {
      const double off = std::abs(length(light.direction()) - 1);
      demand(off < 1e-9);
      for (const double strength : light.strength_rgb) demand(strength > 0 && std::isfinite(strength));
    }
  }
  return 0;
}
