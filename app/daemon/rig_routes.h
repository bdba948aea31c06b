// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "app/daemon/frame_pictures.h"
#include "app/daemon/rig_keeper.h"
#include "app/daemon/routes.h"
#include "app/daemon/session_catalog.h"
#include "capture/rig.h"

namespace weft::app {

/// What the calls of a rig's interface work on.
struct RigParts {
  const capture::Rig& rig;
  std::filesystem::path state;
  RigKeeper& keeper;
  SessionCatalog& sessions;
  FramePictures& pictures;
};

/// Every call of the interface, as app/daemon/openapi.json describes it. The parts must outlive them.
std::vector<Route> rig_routes(const RigParts& parts);

/// The text of app/daemon/openapi.json.
const char* openapi_text();

}  // namespace weft::app
