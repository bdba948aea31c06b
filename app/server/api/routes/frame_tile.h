// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/server/api/api.h"
#include "app/server/http/routes.h"
#include "core/base/result.h"

namespace weft::app {

/// A tile of a raw frame's own pixels, for people with frame_gains(): `tile` is X_Y.EXT. The reply says
/// nothing of how long it may be kept. kNoInput beyond the frame.
Result<Reply> tile_of_frame(const RigParts& parts, const FrameFile& frame, const std::string& level,
                            const std::string& tile, const Call& call);

}  // namespace weft::app
