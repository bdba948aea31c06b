// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "app/server/http/http_guard.h"
#include "app/server/http/routes.h"
#include "app/server/jobs/job_queue.h"
#include "app/server/library/library_service.h"
#include "app/server/rig/attendance.h"
#include "app/server/rig/controls.h"
#include "app/server/rig/frame_pictures.h"
#include "app/server/rig/framing_guide.h"
#include "app/server/rig/once.h"
#include "app/server/rig/rig_keeper.h"
#include "app/server/rig/rig_watch.h"
#include "app/server/rig/set_keeper.h"
#include "app/server/view/pixel_tables.h"
#include "app/server/view/swatch.h"
#include "app/server/view/view_store.h"
#include "capture/rig.h"
#include "core/base/json_document.h"

namespace weft::app {

/// What the calls of the interface work on.
struct RigParts {
  const capture::Rig& rig;
  std::filesystem::path state;
  RigKeeper& keeper;
  FramePictures& pictures;
  Attendance& attendance;
  Screens& screens;
  Once& scans;
  SetKeeper& sets;
  FramingGuide& framing;
  RigWatch& watch;
  Controls& controls;
  JobQueue& jobs;
  LibraryService& library;
  ViewStore& views;
  Swatches& swatches;
  PixelTables& pixels;
  GuardRules guard;  ///< who may come in
};

/// What is asked for begins: the answer tells how to follow it.
inline constexpr int kAccepted = 202;

/// The calls of one resource.
struct Resource {
  std::vector<Route> routes;
};

// One file each. The parts must outlive the routes.
Resource server_resource(const RigParts& parts);
Resource login_resource(const RigParts& parts);
Resource rig_resource(const RigParts& parts);
Resource virtual_rig_resource(const RigParts& parts);
Resource control_resource(const RigParts& parts);
Resource devices_resource(const RigParts& parts);
Resource calibrations_resource(const RigParts& parts);
Resource scan_resource(const RigParts& parts);
Resource sessions_resource(const RigParts& parts);
Resource frames_resource(const RigParts& parts);
Resource maps_resource(const RigParts& parts);
Resource solves_resource(const RigParts& parts);
Resource exports_resource(const RigParts& parts);
Resource materials_resource(const RigParts& parts);
Resource jobs_resource(const RigParts& parts);
Resource batches_resource(const RigParts& parts);
Resource library_resource(const RigParts& parts);
Resource events_resource(const RigParts& parts);

/// The body of a call by who may command the rig. The errors of parse_body() and Controls::commander().
Result<Json> command_in(const RigParts& parts, const Call& call);

/// openapi.json: all calls and what they take and answer (OpenAPI 3).
Json api_description();

/// Every call of the interface, GET openapi.json among them.
std::vector<Route> api_routes(const RigParts& parts);

}  // namespace weft::app
