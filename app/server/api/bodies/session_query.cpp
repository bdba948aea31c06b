// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/bodies/session_query.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <utility>

namespace weft::app {
namespace {

Error no_query(const std::string& key, const std::string& rule) {
  return {ErrorKind::kUsage, "sessions cannot be searched so", key, rule, "see GET sessions in openapi.json"};
}

Result<std::int64_t> count_in(const std::string& key, const std::string& text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size() && number > 0) return number;
  return no_query(key, "must be a number from 1");
}

}  // namespace

Result<library::Query> session_query(const std::map<std::string, std::string>& asked) {
  library::Query query;
  const std::array<std::pair<const char*, std::string*>, 8> texts = {{{"query", &query.words},
                                                                      {"id", &query.id},
                                                                      {"tag", &query.tag},
                                                                      {"state", &query.state},
                                                                      {"rig", &query.rig},
                                                                      {"calibration", &query.calibration},
                                                                      {"from", &query.from},
                                                                      {"to", &query.before}}};
  for (const auto& [key, value] : asked) {
    const auto text = std::ranges::find(texts, key, [](const auto& each) { return std::string(each.first); });
    if (text != texts.end()) {
      *text->second = value;
      continue;
    }
    if (key == "warned") {
      if (value != "true" && value != "false") return no_query(key, "must be true or false");
      query.warned = value == "true";
      continue;
    }
    if (key != "limit" && key != "after") return no_query(key.substr(0, 40), "there is no such filter");
    const Result<std::int64_t> number = count_in(key, value);
    if (!number) return number.error();
    if (key == "after") query.after = *number;
    if (key == "limit") query.limit = static_cast<int>(std::min<std::int64_t>(*number, 1000));
  }
  // Nothing in a time follows this sign: all that begins with what is said is within.
  if (!query.before.empty()) query.before += '~';
  return query;
}

}  // namespace weft::app
