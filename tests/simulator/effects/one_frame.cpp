// SPDX-License-Identifier: Apache-2.0
#include "tests/simulator/effects/one_frame.h"

#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

namespace weft::simulator {
namespace {

constexpr int kSide = 256;

}  // namespace

extern "C" [[gnu::noinline]] bool weft_frame(PassRunner& runner, std::vector<std::uint16_t>& counts) {
  const int led = 1;
  counts.clear();
  return static_cast<bool>(runner.run(
      {0, 0, kSide, kSide}, {&led, 1}, {}, [](const PassTile&) {},
      [&](const PassTile& tile) { counts.insert(counts.end(), tile.counts.begin(), tile.counts.end()); }));
}

Scene scene_of_the_frame() {
  Scene scene;
  scene.camera.width = scene.camera.height = kSide;
  scene.effects.near_light = true;
  return scene;
}

int print_frame(PassList list) {
  PassRunner runner(std::move(list), {512, 32, 1});
  std::vector<std::uint16_t> counts;
  counts.reserve(kSide * kSide);
  if (!weft_frame(runner, counts) || !weft_frame(runner, counts)) return 1;
  std::uint64_t digest = 14695981039346656037u;  // FNV-1a
  for (const std::uint16_t count : counts) digest = (digest ^ count) * 1099511628211u;
  std::printf("%016llx of %zu\n", static_cast<unsigned long long>(digest), counts.size());
  return 0;
}

}  // namespace weft::simulator
