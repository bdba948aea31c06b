// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "simulator/scene/scene.h"

// Kinds of cloth that studios scan, each drawn anew by its seed: what errors, sigma and the words of a solve
// are judged on, beyond the six materials of the accuracy set.

namespace weft::bench {

/// What a part of a cloth is made of, in the places where `is_there` says so (mm on the table).
struct ClothPart {
  simulator::MaterialSettings material;
  std::function<bool(double x_mm, double y_mm)> is_there;
};

struct KindOfCloth {
  std::string name;
  simulator::Scene scene;        ///< all of it but for the parts
  std::vector<ClothPart> parts;  ///< a later one lies over an earlier one
};

/// Thresholds are chosen on the first half of the kinds alone, and weights learned from cloths of no kind.
enum class KindSet { kChosenOn, kHeldOut, kAnything };

std::span<const std::string> names_of_kinds(KindSet set);

/// The kind of this name, else a cloth of no kind, of whatever relief, colours and reflectance; other seeds
/// draw another weave, other colours, lobes and lights.
KindOfCloth draw_kind(const std::string& name, std::uint32_t seed);

}  // namespace weft::bench
