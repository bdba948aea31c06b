// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace weft::virtual_rig {

/// A command of a virtual rig, for who is to say it.
struct CommandWords {
  std::string line;     ///< "light dead LED": capitals, brackets and dots stand for what is to be said
  std::string does;     ///< a sentence
  std::string example;  ///< as it may be said: "light dead 3"
};

}  // namespace weft::virtual_rig
