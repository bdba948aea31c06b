// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "material/assets/build.h"

namespace weft::material {

struct WatchOptions {
  BuildOptions build;
  int every_ms = 500;  ///< how often files are looked at
};

/// Builds, and builds again whenever a file of the materials has changed, until the caller stops it. Each
/// build, and each error, is told; after an error the files of the build before are watched on. Files are
/// looked at and not listened to, which works on shares of networks too.
void watch_materials(const WatchOptions& options, const JobContext& context,
                     const std::function<void(const Result<BuildReport>&)>& tell);

}  // namespace weft::material
