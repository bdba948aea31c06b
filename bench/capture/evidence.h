// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

/// Example scenes, cloths that evidence by light was made for and cloths that it was not.
std::vector<std::string> evidence_scenes();

struct EvidenceOptions {
  std::filesystem::path scenes;  ///< folder of the example scenes
  std::function<void(int done, int scenes)> progress = [](int, int) {};
};

/// How often evidence by light is wrong: a row a scene, with an undisturbed session, and with sessions of
/// mixed-up, dead, weak and stuck LEDs and of room light as "refused/tried" ("exchanged" and "stays_lit":
/// "named rightly/refused/tried"). Errors: those of read_scene().
Result<Rows> capture_evidence_table(const EvidenceOptions& options);

}  // namespace weft::bench
