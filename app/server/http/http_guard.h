// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace weft::app {

/// What of a request decides whether it may come in; empty where the header is absent.
struct Visitor {
  std::string method, host, origin, authorization, content_type;
  std::string path = {}, cookie = {}, fetch_site = {}, fetch_mode = {};
};

/// What who comes in may do.
enum class Role { kLook, kOperate };
const char* name_of(Role role);  ///< "look", "operate"

/// Who may come in.
struct GuardRules {
  std::string listening_host;             ///< as in the rig file
  std::string token;                      ///< of who operates the rig; empty: everybody does
  std::string look_token = {};            ///< of who may only look; empty: nobody
  std::vector<std::string> names = {};    ///< more names of this server, without a port
  std::vector<std::string> origins = {};  ///< of its pages, where a proxy stands before it
  std::vector<std::string> open = {};     ///< "METHOD /path/{of}" of what needs no token
  int port = 0;                           ///< in the cookie's name: cookies do not know ports
};

/// What a visitor who may not come in is answered.
struct Refused {
  int status = 0;
  Error error;
};

/// Nothing where the visitor may come in. Refused are: methods but GET, HEAD, POST, PATCH and DELETE (405); a
/// Host that is neither localhost nor the address that is listened on nor one of `names`, since a page from
/// elsewhere can have its own name lead to this machine (DNS rebinding, 421); an Origin that is not this very
/// server (403); what a page of another site or port has its browser fetch, but for a way to a page of `open`
/// (403); a missing or wrong token or cookie (401); a change by a cookie without an Origin, or by who may
/// only look (403); a POST or PATCH that is not JSON, which a page from elsewhere could send without asking
/// (415). The port in Host is not looked at, so that a tunnel may begin at another one.
std::optional<Refused> turned_away(const Visitor& visitor, const GuardRules& rules);

/// Whose token it is; nothing: nobody's.
std::optional<Role> role_of_token(std::string_view token, const GuardRules& rules);

/// The Set-Cookie header with which a browser comes in, for 30 days and across restarts of the server: its
/// value follows from the role's token, and is void once that is another one.
std::string entry_cookie(Role role, const GuardRules& rules);
/// The one that makes a browser forget it.
std::string exit_cookie(const GuardRules& rules);

/// A token that nobody can guess: 64 hexadecimal digits. kTryAgain where the system has no random numbers.
Result<std::string> new_token();

/// The token in a file, without white space around it. kBadData if it is shorter than 16 characters, is not
/// printable, or if others than the owner may read the file.
Result<std::string> read_token(const std::string& file);

}  // namespace weft::app
