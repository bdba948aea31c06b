// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/result.h"
#include "core/session.h"

namespace weft::capture {

/// Copies a session whose frames have all landed into `folder` (on another disk), with `session` as its
/// session.json; every file is verified by its digest as it reads back. It is made aside and renamed: what is
/// there under the session's name is whole. A copy of the same frames that is there already is taken for it.
/// kCannotCreate where another folder of that name is there.
Result<void> copy_session(const Session& session, const std::filesystem::path& folder);

}  // namespace weft::capture
