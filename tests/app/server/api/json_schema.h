// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/json_document.h"

namespace weft::app {

/// What of `value` is not as a schema of an OpenAPI 3.0 document says, each with its place; nothing where it
/// fits. Understood are $ref, allOf, nullable, type, enum, required, properties, additionalProperties: false,
/// items, minimum, maximum, minLength and maxLength; a schema with another word that restricts is a fault, so
/// that none is overlooked.
std::vector<std::string> misfits(const Json& value, const Json& schema, const Json& document,
                                 const std::string& where = "");

/// What "$ref" in `node` leads to, or `node` itself.
const Json& followed(const Json& node, const Json& document);

}  // namespace weft::app
