// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/lobe_parameters.h"

#include <concepts>

namespace weft::simulator {
namespace {

template <typename Model>
std::optional<LobeParameters> parameters_of(const Model& model) {
  if constexpr (std::same_as<Model, AnisotropicGgx>) {
    return LobeParameters{model.alpha, model.alpha * (1 - model.anisotropy), true, model.f0};
  } else if constexpr (std::same_as<Model, Ggx> || std::same_as<Model, Beckmann> ||
                       std::same_as<Model, Cloth>) {
    return LobeParameters{model.alpha, model.alpha, false, model.f0};
  } else {
    return std::nullopt;
  }
}

}  // namespace

std::optional<LobeParameters> lobe_parameters_of(const Reflectance& model) {
  return std::visit([](const auto& each) { return parameters_of(each); }, model);
}

}  // namespace weft::simulator
