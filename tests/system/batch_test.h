// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "tests/system/program.h"
#include "tests/system/workspace.h"

namespace weft::test {

/// A test of a small archive: sessions of ten LEDs and a dark shot of a twill, 160 x 128. Each is simulated
/// once a program and copied.
class BatchTest : public testing::Test {
 protected:
  /// Copies cloth-0 ... below archive(). Each has photographs of its own.
  void fill_archive(int sessions);
  std::filesystem::path archive() const { return work_ / "archive"; }
  std::filesystem::path session(int number) const;
  std::filesystem::path plan_file() const { return work_ / "night.jsonl"; }

  /// Plans the archive, no session measured unless `more` says --sample; expects that to go well.
  Json plan(const std::vector<std::string>& more = {}) const;
  Outcome run(const std::vector<std::string>& more = {}, const RunOptions& options = {}) const;
  Outcome merge() const;
  Json report() const;  ///< report.json of the last merge

  /// Ids of the complete solves of a session.
  static std::vector<std::string> solves_of(const std::filesystem::path& session);
  /// Folders below the archive that somebody left half made.
  std::vector<std::string> half_made() const;

  Workspace work_;
};

/// A session of these tests, simulated when it is first asked for.
std::filesystem::path simulated_session(int number);

}  // namespace weft::test
