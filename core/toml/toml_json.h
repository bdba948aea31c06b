// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include "core/json_document.h"

namespace weft {

/// Tables become objects and arrays lists, numbers keep their kind; dates and times become null.
Json json_of(const toml::node& node);

}  // namespace weft
