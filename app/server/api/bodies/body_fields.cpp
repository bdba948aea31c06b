// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/bodies/body_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace weft::app {
namespace {

constexpr std::size_t kLongestWord = 100;
constexpr std::size_t kLongestSentence = 500;
constexpr std::size_t kLongestDocument = 100000;  // what Linux takes as one argument is 131072
constexpr std::size_t kMostOfList = 2000;

std::size_t longest_of(const Field& field) {
  return field.most > 0 ? static_cast<std::size_t>(field.most) : kLongestSentence;
}

bool is_sentence(const std::string& text, std::size_t longest) {
  return !text.empty() && text.size() <= longest &&
         std::ranges::none_of(text, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

std::string read(const Field& /*field*/, const Json& said, bool& value) {
  if (!said.is_boolean()) return "must be true or false";
  value = said.get<bool>();
  return "";
}

std::string read(const Field& field, const Json& said, double& value) {
  const double number = said.is_number() ? said.get<double>() : std::nan("");
  if (!field.range.holds(number)) return rule_of(field.range);
  value = number;
  return "";
}

std::string read(const Field& field, const Json& said, int& value) {
  const double number = said.is_number() ? said.get<double>() : std::nan("");
  const bool is_whole = number == std::floor(number) && std::abs(number) < std::numeric_limits<int>::max();
  if (!is_whole || !field.range.holds(number)) return rule_of(field.range, true);
  value = static_cast<int>(number);
  return "";
}

std::string read(const Field& field, const Json& said, std::string& value) {
  if (!said.is_string()) return "must be a text";
  const std::string& text = said.get_ref<const std::string&>();
  if (field.is_sentence && !is_sentence(text, longest_of(field)))
    return fmt::format("must be a text of 1 to {} bytes on one line", longest_of(field));
  if (field.has_lines && text.size() > longest_of(field))
    return fmt::format("must be a text of at most {} bytes", longest_of(field));
  if (!field.is_sentence && !field.has_lines && !is_plain(text)) return "must be a plain word";
  if (!field.words.empty() && std::ranges::find(field.words, text) == field.words.end())
    return rule_of_words(field.words, text);
  value = text;
  return "";
}

// What a path names is looked for by who knows where.
std::string read(const Field& /*field*/, const Json& said, std::filesystem::path& value) {
  if (!said.is_string()) return "must be a text";
  value = said.get<std::string>();
  return "";
}

std::string read(const Field& /*field*/, const Json& said, Json& value) {
  if (!said.is_object()) return "must be an object";
  if (said.dump().size() > kLongestDocument) return "is too long";
  value = said;
  return "";
}

template <typename T>
std::string read(const Field& field, const Json& said, std::optional<T>& value) {
  value.emplace();
  return read(field, said, *value);
}

// One value stands for a list of one where a list of one will do.
template <typename T>
std::string read(const Field& field, const Json& said, std::vector<T>& values) {
  if (field.fewest == 1 && !said.is_array()) return read(field, Json::array({said}), values);
  const std::size_t least = field.most > 0 ? static_cast<std::size_t>(field.fewest) : 1;
  const std::size_t most = field.most > 0 ? static_cast<std::size_t>(field.most) : kMostOfList;
  if (!said.is_array() || said.size() < least || said.size() > most)
    return fmt::format("must be a list of {} to {}", least, most);
  values.resize(said.size());
  for (std::size_t i = 0; i < said.size(); ++i) {
    const std::string why = read(field, said[i], values[i]);
    if (!why.empty()) return "each of it " + why;
  }
  return "";
}

}  // namespace

bool is_plain(std::string_view text) {
  constexpr std::string_view kAllowed = "-_.:";
  return !text.empty() && text.size() <= kLongestWord && text[0] != '-' && text[0] != '.' &&
         std::ranges::all_of(text, [&](unsigned char c) {
           return std::isalnum(c) != 0 || kAllowed.find(static_cast<char>(c)) != kAllowed.npos;
         });
}

std::string read_value(const Field& field, const Json& said, const Fields::Value& value) {
  return std::visit([&](auto* each) { return read(field, said, *each); }, value);
}

// Who says null says nothing.
bool BodyFields::is_said(const std::string& field) const {
  const auto found = body_.find(field);
  return found != body_.end() && !found->is_null();
}

bool BodyFields::is_known(const std::string& field) const {
  return std::ranges::find(known_, field) != known_.end();
}

Error BodyFields::unfit(const std::string& field, const std::string& rule) const {
  return {ErrorKind::kUsage, words_.what, field, rule, fmt::format("see {} in openapi.json", words_.see)};
}

void BodyFields::refuse(const Error& error) {
  if (!error_) error_ = error;
}

void BodyFields::require(bool holds, const char* field, const std::string& rule) {
  if (!holds) refuse(field, rule);
}

void BodyFields::exclude(const char* field, const char* other) {
  if (is_said(field) && is_said(other)) refuse(field, fmt::format("either it or {} may be named", other));
}

void BodyFields::need(const char* field, const char* other) {
  if (is_said(field) && !is_said(other)) refuse(field, fmt::format("needs {} beside it", other));
}

void BodyFields::need_one(const std::vector<const char*>& fields) {
  if (std::ranges::any_of(fields, [&](const char* field) { return is_said(field); })) return;
  std::vector<std::string> known;
  std::ranges::copy_if(fields, std::back_inserter(known), [&](const char* field) { return is_known(field); });
  const std::string first = known.front();
  known.erase(known.begin());
  miss(first, known.empty() ? "" : fmt::format(", or in its place {}", fmt::join(known, ", ")));
}

void BodyFields::miss(const std::string& field, const std::string& others) {
  if (!missing_) missing_ = unfit(field, fmt::format("is needed by {}{}", words_.subject, others));
}

Result<void> BodyFields::status() const {
  for (const auto& [key, value] : body_.items()) {
    if (!is_known(key))
      return unfit(key.substr(0, 40), fmt::format("is no field of {}; did you mean '{}'", words_.subject,
                                                  nearest_word(known_, key)));
  }
  if (error_) return *error_;
  return missing_ ? Result<void>(*missing_) : Result<void>();
}

bool BodyFields::begin(const Field& field) {
  if (field.said == Said::kAtThisMachine) return false;
  know(field.name);
  if (!is_said(field.name) && field.need == kMustSay) miss(field.name, "");
  return is_said(field.name) && !error_;
}

void BodyFields::take(const Field& field, Value value) {
  if (!begin(field)) return;
  const std::string why = read_value(field, body_[field.name], value);
  if (!why.empty()) refuse(field.name, why);
}

void BodyFields::choose(const Field& field, Words words, std::size_t /*now*/,
                        const std::function<void(std::size_t)>& choose) {
  if (!begin(field)) return;
  Field of_words = field;
  of_words.words = {words.begin(), words.end()};
  std::string word;
  const std::string why = read(of_words, body_[field.name], word);
  if (!why.empty()) return refuse(field.name, why);
  choose(static_cast<std::size_t>(std::ranges::find(of_words.words, word) - of_words.words.begin()));
}

}  // namespace weft::app
