// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "core/base/iso_time.h"
#include "library/chain/chain.h"
#include "solve/session/solved.h"

namespace weft::app {
namespace {

struct StatusArguments {
  std::vector<std::string> sessions;
  bool strict = false;
};

// "3 minutes ago".
std::string age_of(const std::string& written) {
  const std::optional<double> then = seconds_of_iso_time(written);
  if (!then) return "";
  const double seconds = seconds_since_1970() - *then;
  struct Unit {
    double seconds;
    const char* name;
  };
  for (const Unit& unit : {Unit{86400, "day"}, Unit{3600, "hour"}, Unit{60, "minute"}}) {
    const int count = static_cast<int>(seconds / unit.seconds);
    if (count > 0) return fmt::format(", {} {}{} ago", count, unit.name, count > 1 ? "s" : "");
  }
  return ", just now";
}

void print_words(const library::Chain& chain) {
  print(chain.session + (chain.fabric.empty() ? "" : "  " + chain.fabric));
  print("  " + words_of(chain.verdict));
  for (const library::ChainLink& link : chain.links)
    print(fmt::format("  {:12} {}{}", link.name, words_of(link), age_of(link.written)));
  if (!chain.is_fresh) print(fmt::format("  to make what is not fresh: weft make {}", chain.session));
}

Result<int> status(const StatusArguments& a, const CommonArguments& common) {
  Json chains = Json::array();
  bool is_fresh = true;
  for (const std::string& folder : a.sessions) {
    const Result<Session> session = solve::read_solved(std::filesystem::absolute(folder).lexically_normal());
    if (!session) return session.error();
    const library::Chain chain = library::chain_of(*session);
    is_fresh = is_fresh && chain.is_fresh;
    if (common.json) {
      chains.push_back(json_of(chain));
    } else {
      print_words(chain);
    }
  }
  if (common.json) print_json({{"sessions", std::move(chains)}});
  return a.strict && !is_fresh ? kDoneWithWarnings : kDone;
}

Run add_status(Options& options) {
  const auto a = std::make_shared<StatusArguments>();
  options.add("sessions", &a->sessions, "Session folders, NAME.weft").required();
  options.add_flag("--strict", &a->strict, "Exit code 2 where anything is missing, a draft or stale");
  return [a](const CommonArguments& common) { return status(*a, common); };
}

}  // namespace

Verb status_verb() {
  return {"status", "What sessions have from photographs to exports, and how fresh it is", add_status};
}

}  // namespace weft::app
