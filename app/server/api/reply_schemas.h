// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/json_document.h"

namespace weft::app {

/// Components of OpenAPI: documents of replies that describe their fields.
Json reply_schemas();

}  // namespace weft::app
