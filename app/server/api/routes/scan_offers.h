// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "app/server/api/api.h"
#include "app/server/api/bodies/scan_body.h"
#include "calibration/guide/scan_price.h"
#include "capture/scan/scan.h"
#include "core/base/result.h"

namespace weft::app {

/// What a shot took in the newest finished scan of this rig.
std::optional<calibration::ShotCost> last_shot_cost(const RigParts& parts);

/// The shots that may be bought for a request of this rig. Errors of calibration::price_scan().
Result<calibration::ScanPrices> offers_for(const RigParts& parts, const capture::ScanRequest& request,
                                           const ShotAims& aims);

/// The request with the shots that the aims choose. Errors of offers_for().
Result<void> take_chosen_shots(const RigParts& parts, const ShotAims& aims, capture::ScanRequest& request);

}  // namespace weft::app
