// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image.h"

namespace weft {

/// The pages of an image that Image::on_disk() made leave this process until they are used again, whoever
/// uses them meanwhile. No other image survives it.
void page_out(const Image<float>& on_disk);

}  // namespace weft
