// SPDX-License-Identifier: Apache-2.0
// libFuzzer program: any bytes as a job that lies on the disk, and as the body that asks for one.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "app/server/api/bodies/job_body.h"
#include "app/server/api/bodies/scan_body.h"
#include "app/server/jobs/job.h"
#include "core/base/temporary_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace weft;
  static const TemporaryFolder folder;
  static const std::string rig = folder.path().string();
  const std::string text(reinterpret_cast<const char*>(data), size);

  if (const Json document = Json::parse(text, nullptr, false); !document.is_discarded()) {
    const Result<app::JobStatus> job = app::job_from_json(document, "job");
    if (job && !app::job_from_json(app::document_of(*job), "job again")) std::abort();
  }
  const Result<Json> body = app::parse_body(text);
  if (!body) return 0;
  const auto session = [](const std::string&) -> Result<std::filesystem::path> { return {rig + "/s.weft"}; };
  const app::JobPlaces places{.session = session,
                              .folder = folder.path(),
                              .rig = "north",
                              .sessions = {},
                              .copy = {},
                              .rig_file = folder.path() / "rig.toml"};
  const Result<app::JobSpec> spec = app::read_job_body(*body, places);
  if (!spec) return 0;
  // No argument leads out of the rig's folder.
  for (const std::string& argument : spec->arguments) {
    const bool is_recipe = argument.starts_with('{') && !argument.starts_with(app::kJobFiles);
    const bool is_path = argument.find('/') != std::string::npos && !argument.starts_with(app::kJobFiles);
    if (is_recipe) continue;
    if (is_path && (!argument.starts_with(rig + "/") || argument.find("..") != std::string::npos))
      std::abort();
  }
  return 0;
}
