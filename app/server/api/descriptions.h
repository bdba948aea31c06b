// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace weft::app {

/// The texts of openapi.json and of each resource's part of it, RESOURCE.openapi.json: {"paths", "schemas"}.
const char* common_description();
const char* batches_description();
const char* calibrations_description();
const char* control_description();
const char* devices_description();
const char* events_description();
const char* exports_description();
const char* frames_description();
const char* jobs_description();
const char* library_description();
const char* login_description();
const char* maps_description();
const char* materials_description();
const char* rig_description();
const char* scan_description();
const char* server_description();
const char* sessions_description();
const char* solves_description();
const char* virtual_rig_description();

}  // namespace weft::app
