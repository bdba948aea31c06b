// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "exchange/document.h"

namespace weft::exchange {

/// U3M's "visualisation" of a material whose size is known; files and what is left out are added to
/// `document`. kBadData for textures that U3M cannot read.
Result<Json> u3m_front_of(const TexturedMaterial& material, Document& document);

}  // namespace weft::exchange
