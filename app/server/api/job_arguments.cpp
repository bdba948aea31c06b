// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/job_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestSentence = 500;
constexpr std::size_t kLongestDocument = 100000;  // what Linux takes as one argument is 131072
constexpr std::size_t kMostOfList = 2000;
constexpr const char* kSet = "moved";  // names a set of photographs where a session would do too

bool is_sentence(const std::string& text) {
  return !text.empty() && text.size() <= kLongestSentence &&
         std::ranges::none_of(text, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

// Of "-o,--output" the long name.
std::string long_option_of(const Field& field) {
  std::string option = option_of(field);
  option.erase(0, option.find(',') + 1);
  if (option.starts_with('!')) option.erase(0, 1);
  return option;
}

bool is_word_of_its_own(const Field& field) {
  return !option_of(field).starts_with('-') && !option_of(field).starts_with('!');
}

// Why a value does not fit its field; else it is read.
std::string read_value(const Field& /*field*/, const Json& said, bool& value) {
  if (!said.is_boolean()) return "must be true or false";
  value = said.get<bool>();
  return "";
}

std::string read_value(const Field& field, const Json& said, double& value) {
  const double number = said.is_number() ? said.get<double>() : std::nan("");
  if (!field.range.holds(number)) return rule_of(field.range);
  value = number;
  return "";
}

std::string read_value(const Field& field, const Json& said, int& value) {
  const double number = said.is_number() ? said.get<double>() : std::nan("");
  const bool is_whole = number == std::floor(number) && std::abs(number) < std::numeric_limits<int>::max();
  if (!is_whole || !field.range.holds(number)) return rule_of(field.range, true);
  value = static_cast<int>(number);
  return "";
}

std::string read_value(const Field& field, const Json& said, std::string& value) {
  if (!said.is_string()) return "must be a text";
  const std::string& text = said.get_ref<const std::string&>();
  if (field.is_sentence && !is_sentence(text))
    return fmt::format("must be a text of 1 to {} bytes on one line", kLongestSentence);
  if (!field.is_sentence && !is_plain(text)) return "must be a plain word";
  if (!field.words.empty() && std::ranges::find(field.words, text) == field.words.end())
    return rule_of_words(field.words, text);
  value = text;
  return "";
}

std::string read_value(const Field& /*field*/, const Json& said, Json& value) {
  if (!said.is_object()) return "must be an object";
  if (said.dump().size() > kLongestDocument) return "is too long";
  value = said;
  return "";
}

template <typename T>
std::string read_value(const Field& field, const Json& said, std::optional<T>& value) {
  value.emplace();
  return read_value(field, said, *value);
}

template <typename T>
std::string read_value(const Field& field, const Json& said, std::vector<T>& values) {
  const auto least = static_cast<std::size_t>(std::max(1, field.fewest));
  const std::size_t most = field.most > 0 ? static_cast<std::size_t>(field.most) : kMostOfList;
  if (!said.is_array() || said.size() < least || said.size() > most)
    return fmt::format("must be a list of {} to {}", least, most);
  values.resize(said.size());
  for (std::size_t i = 0; i < said.size(); ++i) {
    const std::string why = read_value(field, said[i], values[i]);
    if (!why.empty()) return "each of it " + why;
  }
  return "";
}

// As the verb reads it.
template <typename T>
std::string argument_of(const Field& field, const T& value) {
  if constexpr (std::is_same_v<T, Json>) {
    return value.dump();
  } else if constexpr (kIsOptional<T>) {
    return argument_of(field, *value);
  } else if constexpr (kIsList<T>) {
    return fmt::format("{}", fmt::join(value, ","));
  } else {
    return fmt::format("{}{}", value, field.units.empty() ? "" : field.units.front().name);
  }
}

}  // namespace

bool JobArguments::is_said(const std::string& field) const {
  return body_.contains(field) || (field == "session" && is_known(kSet) && body_.contains(kSet));
}

bool JobArguments::is_known(const std::string& field) const {
  return std::ranges::find(known_, field) != known_.end();
}

void JobArguments::refuse(const std::string& field, const std::string& rule) {
  if (!error_) error_ = unfit_job(field, rule);
}

void JobArguments::require(bool holds, const char* field, const std::string& rule) {
  if (!holds) refuse(field, rule);
}

void JobArguments::exclude(const char* field, const char* other) {
  if (is_said(field) && is_said(other)) refuse(field, fmt::format("either it or {} may be named", other));
}

void JobArguments::need(const char* field, const char* other) {
  if (is_said(field) && !is_said(other)) refuse(field, fmt::format("needs {} beside it", other));
}

void JobArguments::need_one(const std::vector<const char*>& fields) {
  std::vector<std::string> others;
  for (const char* field : fields) {
    if (is_said(field)) return;
    if (is_known(field)) others.emplace_back(field);
    if (std::string_view(field) == "session" && is_known(kSet)) others.emplace_back(kSet);
  }
  const std::string first = others.front();
  others.erase(others.begin());
  miss(first, others.empty() ? "" : fmt::format(", or in its place {}", fmt::join(others, ", ")));
}

void JobArguments::miss(const std::string& field, const std::string& others) {
  if (!missing_) missing_ = unfit_job(field, fmt::format("is needed by a {} job{}", spec_.kind, others));
}

Result<void> JobArguments::status() const {
  for (const auto& [key, value] : body_.items()) {
    if (!is_known(key))
      return unfit_job(key.substr(0, 40), fmt::format("is no field of a {} job; did you mean '{}'",
                                                      spec_.kind, nearest_word(known_, key)));
  }
  if (error_) return *error_;
  return missing_ ? Result<void>(*missing_) : Result<void>();
}

bool JobArguments::begin(const Field& field) {
  if (field.said == Said::kAtThisMachine) return false;
  known_.emplace_back(field.name);
  if (field.path == PathTo::kSessionOrSet) {
    known_.emplace_back(kSet);
    if (body_.contains(field.name)) exclude(kSet, field.name);
  }
  if (!is_said(field.name) && field.need == kMustSay) miss(field.name, "");
  return is_said(field.name) && !error_;
}

void JobArguments::add(const Field& field, std::string argument) {
  if (field.said == Said::kToServer) return;
  if (is_word_of_its_own(field)) return spec_.arguments.push_back(std::move(argument));
  if (field.is_sentence) {
    options_.push_back(long_option_of(field) + "=" + argument);
  } else {
    options_.insert(options_.end(), {long_option_of(field), std::move(argument)});
  }
}

Result<fs::path> JobArguments::find_place(const Field& field, const Json& said) const {
  switch (field.path) {
    case PathTo::kSession:
    case PathTo::kSessionOrSet:
      if (!said.is_string()) return unfit_job(field.name, "must be the name of a session");
      return places_.session(said.get<std::string>());
    case PathTo::kNewFolder:
      return new_folder_below(places_.folder, said, field.name);
    case PathTo::kFile:
      return file_below(places_.folder, said, field.name);
    case PathTo::kNamed: {
      std::string name;
      const std::string why = read_value(field, said, name);
      if (!why.empty()) return unfit_job(field.name, why);
      return fs::path(name);
    }
    case PathTo::kFolder:
    case PathTo::kAnything:
      break;
  }
  return folder_below(places_.folder, said, field.name);
}

void JobArguments::read_place(const Field& field, const Json& said, fs::path& place) {
  const bool is_set = field.path == PathTo::kSessionOrSet && !body_.contains(field.name);
  Result<fs::path> found = is_set ? folder_below(places_.folder, said, kSet) : find_place(field, said);
  if (!found) {
    if (!error_) error_ = found.error();
    return;
  }
  place = std::move(*found);
  if (field.said == Said::kToServer) return;
  const bool is_there = field.path != PathTo::kNewFolder && field.path != PathTo::kNamed;
  if (is_there) spec_.needs.push_back(place.string());
  const bool is_worked_on = is_word_of_its_own(field) || field.path == PathTo::kSessionOrSet;
  if (is_worked_on) spec_.of = said.get<std::string>();
  add(field, place.string());
}

template <typename T>
void JobArguments::read(const Field& field, const Json& said, T& value) {
  const std::string why = read_value(field, said, value);
  if (!why.empty()) return refuse(field.name, why);
  if constexpr (std::is_same_v<T, bool>) {
    const bool is_option_said = value != option_of(field).starts_with('!');
    if (is_option_said && field.said != Said::kToServer) options_.push_back(long_option_of(field));
  } else {
    add(field, argument_of(field, value));
  }
}

void JobArguments::take(const Field& field, Value value) {
  if (!begin(field)) return;
  const Json& said = body_.contains(field.name) ? body_[field.name] : body_[kSet];
  std::visit(
      [&]<typename T>(T* each) {
        if constexpr (std::is_same_v<T, fs::path>) {
          read_place(field, said, *each);
        } else if constexpr (std::is_same_v<T, std::vector<fs::path>>) {
          for (const Json& one : said.is_array() ? said : Json::array({said}))
            read_place(field, one, each->emplace_back());
        } else {
          read(field, said, *each);
        }
      },
      value);
}

void JobArguments::choose(const Field& field, Words words, std::size_t /*now*/,
                          const std::function<void(std::size_t)>& choose) {
  if (!begin(field)) return;
  Field of_words = field;
  of_words.words = {words.begin(), words.end()};
  std::string word;
  const std::string why = read_value(of_words, body_[field.name], word);
  if (!why.empty()) return refuse(field.name, why);
  choose(static_cast<std::size_t>(std::ranges::find(of_words.words, word) - of_words.words.begin()));
  add(field, word);
}

void JobSchema::exclude(const char* field, const char* other) {
  if (has(field) && has(other)) JsonSchema::exclude(field, other);
}

void JobSchema::need(const char* field, const char* other) {
  if (has(field) && has(other)) JsonSchema::need(field, other);
}

void JobSchema::need_one(const std::vector<const char*>& fields) {
  std::vector<const char*> known;
  for (const char* field : fields) {
    if (!has(field)) continue;
    known.push_back(field);
    if (std::string_view(field) == "session" && has(kSet)) known.push_back(kSet);
  }
  JsonSchema::need_one(known);
}

void JobSchema::take(const Field& field, Value value) {
  if (field.said == Said::kAtThisMachine) return;
  const bool is_list = std::holds_alternative<std::vector<fs::path>*>(value);
  const bool is_path = is_list || std::holds_alternative<fs::path*>(value);
  Json property = property_of(field, value);
  if (!is_path) {
    Field told = field;
    if (option_of(field).starts_with('!')) told.says = "Off: " + field.says;
    return add(told, std::move(property));
  }
  const auto named = [&](const char* what, const char* says) {
    property = {{"type", "string"}, {"x-names", what}};
    if (is_list) property = {{"oneOf", {property, {{"type", "array"}, {"items", property}}}}};
    Field told = field;
    told.says += says;
    if (field.path == PathTo::kSessionOrSet) told.need = kMaySay;
    add(told, std::move(property));
  };
  switch (field.path) {
    case PathTo::kSession:
      return named("session", ": its name");
    case PathTo::kSessionOrSet: {
      const Field set = {.name = kSet,
                         .says = "In its place a set of photographs: folder below the rig file's"};
      named("session", ": its name");
      add(set, {{"type", "string"}, {"x-names", "folder"}});
      if (field.need == kMustSay) JsonSchema::need_one({field.name, kSet});
      return JsonSchema::exclude(field.name, kSet);
    }
    case PathTo::kNamed:
      return add(field, {{"type", "string"}, {"enum", field.words}});
    case PathTo::kNewFolder:
      return named("new folder", "; below the rig file's folder");
    case PathTo::kFile:
      return named("file", "; below the rig file's folder");
    case PathTo::kFolder:
    case PathTo::kAnything:
      return named("folder", "; below the rig file's folder");
  }
}

void JobSchema::choose(const Field& field, Words words, std::size_t now,
                       const std::function<void(std::size_t)>& choose) {
  if (field.said != Said::kAtThisMachine) JsonSchema::choose(field, words, now, choose);
}

}  // namespace weft::app
