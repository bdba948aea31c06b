// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/rig/session.h"

namespace weft::capture {

/// Where a session's second copy lies below `folder`: folder/RIG/NAME.weft, so that rigs can share a disk.
std::filesystem::path place_of_copy(const Session& session, const std::filesystem::path& folder);

/// Copies a session whose frames have all landed to its place below `folder` (on another disk), with
/// `session` as its session.json. Every frame is read back from there and held against the digest it was
/// received with. The copy is made aside and renamed: what is there under the session's name is whole. One of
/// the same frames that is there already is only read back, and one that lacks frames which were taken again
/// since gets them. kCannotCreate where another folder of that name
/// is there, kInputOutput where what is read back differs.
Result<void> copy_session(const Session& session, const std::filesystem::path& folder);

/// What session.json keeps of it under "copy": {"to": folder, "state": "verified"}, or {"to", "state":
/// "missing", "why"}.
Json record_of_copy(const std::filesystem::path& folder, const Result<void>& copied);

/// copy_session() of the finished session in this folder, into `to`, or where it is empty to where its
/// session.json says that the copy belongs; what became of it goes into session.json. Where the copy is.
/// kUsage where neither names a place, kTryAgain where the session is not finished.
Result<std::filesystem::path> copy_later(const std::filesystem::path& session, std::filesystem::path to);

/// The warning where a copy in `folder` would lie on the disk of the sessions themselves, or on a mount point
/// that nothing is mounted on.
std::optional<std::string> warning_of_one_disk(const std::filesystem::path& sessions,
                                               const std::filesystem::path& folder);

}  // namespace weft::capture
