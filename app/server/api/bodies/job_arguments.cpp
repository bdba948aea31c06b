// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/bodies/job_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <type_traits>

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSet = "moved";  // names a set of photographs where a session would do too

// The long name in "-o,--output".
std::string long_option_of(const Field& field) {
  std::string option = option_of(field);
  option.erase(0, option.find(',') + 1);
  if (option.starts_with('!')) option.erase(0, 1);
  return option;
}

bool is_word_of_its_own(const Field& field) {
  return !option_of(field).starts_with('-') && !option_of(field).starts_with('!');
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

JobArguments::JobArguments(const Json& body, const JobPlaces& places, JobSpec& spec)
    : BodyFields(body, {"job cannot be read", fmt::format("a {} job", spec.kind), "POST jobs"}),
      places_(places),
      spec_(spec) {
  know("kind");
  know("request_id");
}

bool JobArguments::is_said(const std::string& field) const {
  return body_.contains(field) || (field == "session" && is_known(kSet) && body_.contains(kSet));
}

void JobArguments::need_one(const std::vector<const char*>& fields) {
  std::vector<const char*> all;
  for (const char* field : fields) {
    all.push_back(field);
    if (std::string_view(field) == "session") all.push_back(kSet);
  }
  BodyFields::need_one(all);
}

bool JobArguments::begin(const Field& field) {
  if (field.said != Said::kAtThisMachine && field.path == PathTo::kSessionOrSet) {
    know(kSet);
    if (body_.contains(field.name)) exclude(kSet, field.name);
  }
  return BodyFields::begin(field);
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

void JobArguments::add_flag(const Field& field, bool is_on) {
  const bool is_option_said = is_on != option_of(field).starts_with('!');
  if (is_option_said && field.said != Said::kToServer) options_.push_back(long_option_of(field));
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
      const std::string why = read_value(field, said, &name);
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
  if (!found) return refuse(found.error());
  place = std::move(*found);
  if (field.said == Said::kToServer) return;
  const bool is_there = field.path != PathTo::kNewFolder && field.path != PathTo::kNamed;
  if (is_there) spec_.needs.push_back(place.string());
  const bool is_worked_on = is_word_of_its_own(field) || field.path == PathTo::kSessionOrSet;
  if (is_worked_on) spec_.of = said.get<std::string>();
  add(field, place.string());
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
          const std::string why = read_value(field, said, each);
          if (!why.empty()) return refuse(field.name, why);
          if constexpr (std::is_same_v<T, bool>) {
            add_flag(field, *each);
          } else {
            add(field, argument_of(field, *each));
          }
        }
      },
      value);
}

void JobArguments::choose(const Field& field, Words words, std::size_t now,
                          const std::function<void(std::size_t)>& choose) {
  BodyFields::choose(field, words, now, [&](std::size_t chosen) {
    choose(chosen);
    add(field, words[chosen]);
  });
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
