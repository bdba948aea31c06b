// SPDX-License-Identifier: Apache-2.0
#include "library/import/name_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace weft::library {
namespace {

constexpr std::size_t kLongestPattern = 500;

struct PatternWord {
  const char* word;
  const char* expression;
};
// Texts take as little as they can, so that a number behind one is whole.
constexpr std::array<PatternWord, 6> kWords = {{{"session", "([^/]+?)"},
                                                {"fabric", "([^/]+?)"},
                                                {"led", "([0-9]{1,4}|[Dd][Aa][Rr][Kk])"},
                                                {"index", "([0-9]{1,18})"},
                                                {"any", "([^/]*?)"},
                                                {"ext", "([A-Za-z0-9]+)"}}};

Error bad_pattern(const std::string& text, std::string why) {
  return {ErrorKind::kUsage, "the pattern cannot be used", "--pattern " + text, std::move(why),
          "write names as {session}/{fabric}_{led}.{ext}; {index} counts shots, {any} is passed over"};
}

std::int64_t number_of(const std::string& digits) {
  std::int64_t value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return value;
}

}  // namespace

Result<NamePattern> NamePattern::parse(const std::string& text) {
  if (text.size() > kLongestPattern) return bad_pattern(text.substr(0, 60), "it is too long");
  NamePattern pattern;
  std::string expression;
  for (std::string_view rest = text; !rest.empty();) {
    if (rest[0] != '{') {
      if (std::string_view("^$\\.*+?()[]}|").find(rest[0]) != std::string_view::npos) expression += '\\';
      if (rest[0] == '/') ++pattern.depth_;
      expression += rest[0];
      rest.remove_prefix(1);
      continue;
    }
    const std::size_t end = rest.find('}');
    if (end == std::string_view::npos) return bad_pattern(text, "a brace is not closed");
    std::string word(rest.substr(1, end - 1));
    if (word == "led:d" || word == "index:d") word.erase(word.find(':'));
    const auto* known =
        std::ranges::find(kWords, word, [](const PatternWord& w) { return std::string(w.word); });
    if (known == kWords.end()) return bad_pattern(text, fmt::format("it has no word {{{}}}", word));
    if (word != "any" && pattern.has(word))
      return bad_pattern(text, fmt::format("{{{}}} stands twice", word));
    expression += known->expression;
    pattern.groups_.push_back(std::move(word));
    rest.remove_prefix(end + 1);
  }
  if (pattern.groups_.empty()) return bad_pattern(text, "it has no word in braces");
  pattern.expression_ = std::regex(expression, std::regex::ECMAScript | std::regex::optimize);
  return pattern;
}

bool NamePattern::has(std::string_view word) const {
  return std::ranges::find(groups_, word) != groups_.end();
}

std::optional<NameParts> NamePattern::match(const std::filesystem::path& file) const {
  std::vector<std::string> parts;
  for (const std::filesystem::path& part : file) parts.push_back(part.string());
  if (parts.size() < depth_) return {};
  std::string tail;
  for (std::size_t i = parts.size() - depth_; i < parts.size(); ++i) {
    if (!tail.empty()) tail += '/';
    tail += parts[i];
  }
  std::smatch found;
  if (!std::regex_match(tail, found, expression_)) return {};
  NameParts said;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const std::string value = found[i + 1].str();
    if (groups_[i] == "session") said.session = value;
    if (groups_[i] == "fabric") said.fabric = value;
    if (groups_[i] == "led")
      said.led = value[0] >= '0' && value[0] <= '9' ? static_cast<int>(number_of(value)) : 0;
    if (groups_[i] == "index") said.index = number_of(value);
  }
  return said;
}

}  // namespace weft::library
