// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "library/catalogue/metadata.h"

namespace weft::library {

/// So many changes can be undone.
inline constexpr std::size_t kMostEdits = 20;

/// The last changes that people made, in a file, so that they can be undone after a restart too. One process
/// at a time writes it.
class Edits {
 public:
  /// Begins anew where there is no such file. kBadData where it is none of ours, kNoInput.
  static Result<Edits> open(const std::filesystem::path& file);

  /// Remembers a change that was made; what had been undone can no longer be made again.
  Result<void> add(const MetadataChange& change, const std::string& by);

  /// Takes the last change back, or makes the one that was taken back last again, and says what that was.
  /// Errors: kUsage (there is none), those of change_metadata(): kTryAgain where the field was changed by
  /// somebody else.
  Result<MetadataChange> undo();
  Result<MetadataChange> redo();

 private:
  Edits(std::filesystem::path file, Json done, Json undone)
      : file_(std::move(file)), done_(std::move(done)), undone_(std::move(undone)) {}
  Result<MetadataChange> move(Json& from, Json& to, const char* set, const char* expected);
  Result<void> write() const;

  std::filesystem::path file_;
  Json done_, undone_;  // lists, the last at the end
};

}  // namespace weft::library
