// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/json_document.h"

namespace weft::app {

/// A document that weft writes.
struct DocumentSchema {
  const char* name;  ///< "weft.solve"
  const char* says;  ///< where it stands
  Json (*fields)();  ///< schema of its fields
  bool is_versioned = true;
};

const std::vector<DocumentSchema>& document_schemas();

/// JSON Schema (2020-12) of all its versions: what a reader of today takes. Fields that a newer minor version
/// adds are none of its concern.
Json schema_document(const DocumentSchema& document);

}  // namespace weft::app
