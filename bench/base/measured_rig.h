// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image.h"
#include "core/rig/camera.h"
#include "core/rig/lights.h"

namespace weft::bench {

/// Ten near LEDs, four at 35 degrees from the zenith and six at 62, 600 mm from the table's centre; with
/// gains, a vignette and a few per cent of a LED's own.
NearLights bench_lights(double mu, bool gains);

/// A frame of 3:2 with about so many pixels, both sides even.
Size bench_size(double megapixels);

/// Straight above the table, seeing 200 mm across.
CameraModel bench_camera(Size size);

}  // namespace weft::bench
