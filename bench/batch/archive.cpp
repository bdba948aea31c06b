// SPDX-License-Identifier: Apache-2.0
#include "bench/batch/archive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/files.h"
#include "core/base/json_document.h"
#include "simulator/simulate.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

// A session with the photographs of another.
Result<void> link_to(const fs::path& own, const fs::path& folder, int number) {
  std::error_code failed;
  fs::create_directory(folder, failed);
  for (const char* part : {"raw", "calibration"}) {
    if (!failed) fs::create_directory_symlink(own / part, folder / part, failed);
  }
  if (failed) return cannot_write(folder, failed.value());
  Result<Json> session = read_json(own / "session.json", "weft.session", 1);
  if (!session) return std::move(session).error();
  (*session)["metadata"] = {{"notes", fmt::format("roll {}", number)}};
  return write_json(folder / "session.json", *session);
}

}  // namespace

Result<void> simulate_own(const fs::path& folder, const simulator::Scene& scene) {
  if (const auto made = simulator::simulate_session(scene, folder, {}); !made) return made.error();
  std::error_code ignored;
  fs::remove_all(folder / "truth", ignored);
  return {};
}

void set_size(simulator::CameraSettings& camera, double megapixels) {
  camera.width = static_cast<int>(std::lround(std::sqrt(megapixels * 1e6 * 1.25) / 32)) * 32;
  camera.height = static_cast<int>(std::lround(megapixels * 1e6 / camera.width / 2)) * 2;
}

fs::path session_in(const fs::path& folder, int number) {
  return folder / fmt::format("SESSION-{:05}.weft", number);
}

Result<void> make_archive(const fs::path& folder, const fs::path& scene_file, double megapixels, int sessions,
                          int of_their_own) {
  Result<simulator::Scene> scene = simulator::read_scene(scene_file);
  if (!scene) return std::move(scene).error();
  set_size(scene->camera, megapixels);
  const std::string fabric = scene->fabric;
  if (Result<void> made = make_writable_folder(folder); !made) return made;
  for (int i = 0; i < sessions; ++i) {
    scene->fabric = fmt::format("{} {}", fabric, i % of_their_own);
    const Result<void> made = i < of_their_own
                                  ? simulate_own(session_in(folder, i), *scene)
                                  : link_to(session_in(folder, i % of_their_own), session_in(folder, i), i);
    if (!made) return made;
    scene->seed += 1;
  }
  return {};
}

}  // namespace weft::bench
