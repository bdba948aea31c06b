// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace weft {

/// The system's host name.
std::string machine_name();

/// What a folder is called while this process makes it aside: `.TARGET.MACHINE.PROCESS.partial`. Two machines
/// that share a disk may have processes of one number.
std::string partial_name(const std::string& target);

/// What such a name says of the process that made the folder.
struct PartialMaker {
  bool is_of_this_machine = false;
  bool runs = false;  ///< nothing is known of another machine's: false
};
/// Nothing for a name of another form.
std::optional<PartialMaker> maker_of_partial(const std::filesystem::path& folder);

}  // namespace weft
