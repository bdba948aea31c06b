// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace weft::exchange {

/// The closed lists of U3M 1.1, with the spelling of its schema ("TafFeta", "Micropolypch").
std::span<const std::string_view> u3m_fibres();
std::span<const std::string_view> u3m_constructions();
std::span<const std::string_view> u3m_material_types();

/// "Woven" or "Knit" for a word of u3m_constructions(); empty where it may be either.
std::string_view u3m_material_type_of(std::string_view construction);

}  // namespace weft::exchange
