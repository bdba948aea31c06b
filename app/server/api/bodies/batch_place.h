// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"

// Where a daemon keeps plans of batches: STATE/batches/NAME/ with sessions.txt (what was asked for, a folder
// a line), plan.jsonl (weft.batch/1) and plan.results/ beside it.

namespace weft::app {

inline constexpr const char* kBatchFolder = "batches";

std::filesystem::path list_of_batch(const std::filesystem::path& batches, const std::string& name);
std::filesystem::path plan_of_batch(const std::filesystem::path& batches, const std::string& name);
/// Its report's folder, which need not be there.
std::filesystem::path report_of_batch(const std::filesystem::path& batches, const std::string& name);

/// The names of all, the newest first.
std::vector<std::string> batch_names(const std::filesystem::path& batches);
/// The folder of a batch. kNoInput where there is none of this name.
Result<std::filesystem::path> find_batch(const std::filesystem::path& batches, const std::string& name);
/// Makes the folder of a new one with its list of sessions; without a name it is the next number: "0001". Its
/// name. kUsage for what is no name, kCannotCreate where it is taken, errors of writing.
Result<std::string> begin_batch(const std::filesystem::path& batches, const std::string& name,
                                const std::vector<std::string>& sessions);
/// Removes a batch with its report. Solves lie in their sessions and stay.
void remove_batch(const std::filesystem::path& batches, const std::string& name);

}  // namespace weft::app
