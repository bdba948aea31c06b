// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "simulator/targets/range.h"

// What the walk over the keys of a scene says of each. Internal to simulator/scene.

namespace weft::simulator {

/// One key; its default is that of its member.
struct SceneKey {
  const char* name;
  const char* unit = "";
  const char* says = "";    ///< what it is, in Markdown; links are those of docs/reference/scenes.md
  std::string unsaid = {};  ///< what holds without it, where the member does not say that
};

/// The values of a key that is a choice, as a scene spells them.
template <typename Value>
using Names = std::vector<std::pair<const char*, Value>>;

/// The accuracy of `effects = "auto"`, in sigma.
inline constexpr double kAutomaticSigma = 0.25;
inline constexpr Range kAutomaticRange = {1e-3, 100};

/// The key that chooses the alternative of a variant; another one than before starts from its defaults.
template <typename Visitor, typename... Alternatives>
void choose(Visitor& v, const SceneKey& key, std::variant<Alternatives...>& value,
            const std::array<const char*, sizeof...(Alternatives)>& spelled) {
  Names<std::size_t> names;
  for (const char* each : spelled) names.emplace_back(each, names.size());
  std::size_t index = value.index();
  v.kind(key, index, names);
  const std::array<std::variant<Alternatives...>, sizeof...(Alternatives)> fresh = {Alternatives{}...};
  if (index != value.index()) value = fresh[index];
}

}  // namespace weft::simulator
