// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/result.h"

namespace weft::app {

/// What of a request decides whether it may come in; empty where the header is absent.
struct Visitor {
  std::string method, host, origin, authorization, content_type;
};

/// Who may come in.
struct GuardRules {
  std::string listening_host;  ///< as in the rig file
  std::string token;           ///< empty: none is asked for
};

/// What a visitor who may not come in is answered.
struct Refused {
  int status = 0;
  Error error;
};

/// Nothing where the visitor may come in. Refused are: methods but GET, HEAD and POST (405); a Host that is
/// neither localhost nor the address that is listened on, since a page from elsewhere can have its own name
/// lead to this machine (DNS rebinding, 421); an Origin that is not this very server (403); a missing or
/// wrong token (401); a POST that is not JSON, which a page from elsewhere could send without asking (415).
/// The port in Host is not looked at, so that a tunnel may begin at another one.
std::optional<Refused> turned_away(const Visitor& visitor, const GuardRules& rules);

/// A token that nobody can guess: 64 hexadecimal digits. kTryAgain where the system has no random numbers.
Result<std::string> new_token();

/// The token in a file, without white space around it. kBadData if it is shorter than 16 characters, is not
/// printable, or if others than the owner may read the file.
Result<std::string> read_token(const std::string& file);

}  // namespace weft::app
