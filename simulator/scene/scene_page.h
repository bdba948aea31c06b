// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace weft::simulator {

/// Every key of a scene as a page of Markdown: docs/reference/scenes.md without its last line end.
std::string scene_page();

}  // namespace weft::simulator
