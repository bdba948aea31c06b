// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace weft::app {

/// The fields of all documents as a page of Markdown: docs/reference/documents.md
/// without its last line end.
std::string documents_page();

}  // namespace weft::app
