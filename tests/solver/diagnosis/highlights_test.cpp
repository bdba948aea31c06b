// SPDX-License-Identifier: Apache-2.0
#include "solver/diagnosis/highlights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "bench/oracles/oracle_rig.h"

namespace weft::solver {
namespace {

/// Pixels under the ten LEDs of the rig as distant lights of strength 2; `light_of(pixel, normal, light)` is
/// the reading over strength. Their channels take turns.
template <typename LightOf>
Evidence pixels_of(const LightOf& light_of) {
  test::Random random(5);
  const NearLights rig = test::ten_leds();
  Evidence evidence;
  evidence.lights = rig.leds.size();
  for (int p = 0; p < 600; ++p) {
    evidence.position.push_back({0, 0});
    evidence.channel.push_back(p % 3);
    const Vec3 n = test::random_normal(random, 30);
    for (const NearLight& led : rig.leds) {
      const Vec3 l = normalized(led.position_mm);
      evidence.rows.push_back({l, 2, 2 * light_of(p, n, l)});
    }
  }
  return evidence;
}

double matt(double albedo, Vec3 n, Vec3 l) {
  return albedo * std::max(0.0, dot(n, l));
}

TEST(OutshiningShare, IsNoneOfMattClothInAnyColour) {
  const std::array<double, 3> albedo = {0.6, 0.04, 0.05};
  const Evidence evidence =
      pixels_of([&](int p, Vec3 n, Vec3 l) { return matt(albedo[static_cast<std::size_t>(p % 3)], n, l); });
  EXPECT_EQ(outshining_share(evidence), 0);
}

TEST(OutshiningShare, IsThatOfPixelsWithAHighlight) {
  int shining = 0, last = -1;
  const Evidence evidence = pixels_of([&](int p, Vec3 n, Vec3 l) {
    if (dot(n, normalized(l + Vec3{0, 0, 1})) < 0.97) return matt(0.04, n, l);
    shining += p != last;
    last = p;
    return matt(0.04, n, l) + 0.4;
  });
  ASSERT_GT(shining, 200);
  EXPECT_NEAR(outshining_share(evidence), shining / 600.0, 1e-9);
}

// In half of the pixels three lights reach the ground and the others only by way of the walls.
TEST(OutshiningShare, IsNoneOfHolesInMattLace) {
  const Evidence evidence = pixels_of([&](int p, Vec3 n, Vec3 l) {
    const bool is_hole = p % 2 == 0, sees = l.x > 0 && l.y > 0;
    return is_hole && !sees ? 0.06 : matt(0.6, n, l);
  });
  EXPECT_EQ(outshining_share(evidence), 0);
}

}  // namespace
}  // namespace weft::solver
