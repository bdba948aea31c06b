// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/presets.h"

#include <algorithm>

#include "core/base/text.h"

namespace weft::simulator {
namespace {

std::string names_nearest_first(std::string_view wanted) {
  std::vector<std::string_view> names;
  for (const ClothPreset& each : presets()) names.push_back(each.name);
  std::stable_sort(names.begin(), names.end(),
                   [&](auto a, auto b) { return edit_distance(wanted, a) < edit_distance(wanted, b); });
  std::string list;
  for (const std::string_view name : names) list += (list.empty() ? "" : ", ") + std::string(name);
  return list;
}

Rgb grey(double value) {
  return {value, value, value};
}

std::vector<ClothPreset> make_presets() {
  return {
      {"matte-cotton",
       MultipleScattering{0.2},
       {0.6, 0.57, 0.5},
       {{"gloss", "0.2: short fibres in all directions, so that only bounced light is left and no highlight"},
        {"albedo", "0.60, 0.57, 0.50: unbleached"}}},
      {"wool",
       Cloth{0.7, 4, grey(0.046)},
       {0.3, 0.24, 0.18},
       {{"alpha", "0.7: crimped fibres stand off at all angles, a wide and faint fuzz"},
        {"amplitude", "4: as Ashikhmin and Premoze have it"},
        {"f0", "0.046: keratin, refractive index 1.55"},
        {"albedo", "0.30, 0.24, 0.18: undyed brown"}}},
      {"velvet",
       Cloth{0.3, 4, grey(0.05)},
       {0.04, 0.012, 0.012},
       {{"alpha", "0.3: a pile that stands nearly upright, bright at the rim"},
        {"amplitude", "4: as Ashikhmin and Premoze have it"},
        {"f0", "0.05: silk or viscose, refractive index 1.54 to 1.58"},
        {"albedo", "0.040, 0.012, 0.012: dark red, as light is lost between the fibres"}}},
      {"two-tone-velvet",
       Cloth{0.35, 4, {0.04, 0.09, 0.2}},
       {0.06, 0.01, 0.02},
       {{"alpha", "0.35: a pile that stands nearly upright"},
        {"amplitude", "4: as Ashikhmin and Premoze have it"},
        {"f0", "0.04, 0.09, 0.20: blue fuzz, the light that dyed tips pass on counted with what they mirror"},
        {"albedo", "0.06, 0.01, 0.02: red ground"}}},
      {"satin",
       AnisotropicGgx{0.45, 0.65, grey(0.05), Beneath::kBalanced},
       {0.45, 0.4, 0.36},
       {{"alpha", "0.45: across the floats, over whose round filaments the facets spread"},
        {"anisotropy", "0.65: along the floats the roughness is 0.16, filaments being straight and smooth"},
        {"f0", "0.05: silk or polyester, refractive index 1.54 to 1.6"},
        {"beneath", "balanced: what the filaments mirror does not reach the dye"},
        {"albedo", "0.45, 0.40, 0.36: ivory"}}},
      {"dark-satin",
       AnisotropicGgx{0.35, 0.6, grey(0.05), Beneath::kBalanced},
       grey(0.06),
       {{"alpha", "0.35: across the floats; calendered, so smoother than satin"},
        {"anisotropy", "0.60: along the floats the roughness is 0.14"},
        {"f0", "0.05: polyester, refractive index 1.57 to 1.6"},
        {"beneath", "balanced: what the filaments mirror does not reach the dye"},
        {"albedo", "0.06: black dye; the highlight outshines it, the hardest case for photometric stereo"}}},
  };
}

}  // namespace

std::span<const ClothPreset> presets() {
  static const std::vector<ClothPreset> all = make_presets();
  return all;
}

Result<ClothPreset> preset(std::string_view name) {
  for (const ClothPreset& each : presets()) {
    if (each.name == name) return each;
  }
  return Error{ErrorKind::kBadData, "no such material", std::string(name),
               "there are " + names_nearest_first(name), "choose one of these names"};
}

}  // namespace weft::simulator
