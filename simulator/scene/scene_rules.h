// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "simulator/scene/scene.h"

// What the keys of a scene may not say together. Internal to simulator/scene.

namespace weft::simulator {

/// A combination of keys that makes no sense.
struct SceneRule {
  const char* key;  ///< the one that the rule speaks of, with dots
  bool (*is_broken)(const Scene&);
  const char* why;
  const char* remedy;
};

std::span<const SceneRule> scene_rules();

}  // namespace weft::simulator
