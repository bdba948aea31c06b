// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace weft::app {

/// testdata/scenes/torture.toml.
const char* torture_scene();

}  // namespace weft::app
