// SPDX-License-Identifier: Apache-2.0
#include "core/field_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

namespace weft {
namespace {

template <typename T>
const char* type_of() {
  if constexpr (std::is_same_v<T, bool>) return "boolean";
  if constexpr (std::is_same_v<T, int>) return "integer";
  if constexpr (std::is_same_v<T, double>) return "number";
  return "string";
}

template <typename T>
T read_one(JsonFields& fields, const char* name) {
  if constexpr (std::is_same_v<T, bool>) return fields.flag(name);
  if constexpr (std::is_same_v<T, int>) return fields.integer(name);
  if constexpr (std::is_same_v<T, double>) return fields.number(name);
  if constexpr (std::is_same_v<T, std::string> || std::is_same_v<T, std::filesystem::path>)
    return fields.text(name);
}

}  // namespace

template <typename T>
void JsonReader::hold(const Field& field, const T& read) {
  if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>)
    require(field.range.holds(read), field.name, rule_of(field.range, std::is_integral_v<T>));
  if constexpr (std::is_same_v<T, std::string>) {
    if (!field.words.empty() && std::ranges::find(field.words, read) == field.words.end())
      fields_.reject(field.name, rule_of_words(field.words, read));
  }
}

bool JsonReader::is_said(const Field& field) const {
  return field.need == Need::kMustSay || fields_.has(field.name);
}

void JsonReader::require(bool holds, const char* field, const std::string& rule) {
  if (!holds) fields_.reject(field, rule);
}

// One value stands for a list of one where a list of one will do.
Json JsonReader::list_of(const Field& field) {
  const bool is_one = field.fewest == 1 && fields_.has(field.name) && !object_.at(field.name).is_array();
  return is_one ? Json::array({object_.at(field.name)}) : fields_.list(field.name);
}

void JsonReader::take(const Field& field, Value value) {
  if (!is_said(field)) return;
  std::visit(
      [&]<typename T>(T* each) {
        using Read = typename Inner<T>::Type;
        if constexpr (std::is_same_v<T, Json>) {
          *each = object_.at(field.name);
        } else if constexpr (kIsList<T>) {
          const Json list = list_of(field);
          T read;
          for (std::size_t i = 0; i < list.size() && fields_.status(); ++i) {
            const Json one = {{field.name, list[i]}};
            JsonFields within(one, fields_.where());
            read.push_back(read_one<Read>(within, field.name));
            if (const Result<void> ok = within.status(); !ok) error_ = error_ ? error_ : ok.error();
            hold(field, read.back());
          }
          const auto count = static_cast<int>(read.size());
          require(field.most == 0 || (count >= field.fewest && count <= field.most), field.name,
                  fmt::format("must be a list of {} to {}", field.fewest, field.most));
          if (status()) *each = std::move(read);
        } else {
          Read read = read_one<Read>(fields_, field.name);
          hold(field, read);
          if (fields_.status()) *each = std::move(read);
        }
      },
      value);
}

void JsonReader::choose(const Field& field, Words words, std::size_t /*now*/,
                        const std::function<void(std::size_t)>& choose) {
  if (is_said(field)) choose(fields_.place_of(field.name, words));
}

void JsonReader::read_inside(const Json& object, const std::string& name,
                             const std::function<void(Fields&)>& inside) {
  JsonReader reader(object, fmt::format("{}: {}", fields_.where(), name), naming_);
  inside(reader);
  const Result<void> ok = reader.status();
  if (!ok && !error_) error_ = ok.error();
}

void JsonReader::enter(const Field& field, const std::function<void(Fields&)>& inside, bool /*is_default*/) {
  if (!is_said(field)) return;
  const bool is_of_people = naming_ == Naming::kOfPeople;
  read_inside(fields_.object(field.name), is_of_people ? fmt::format("[{}]", field.name) : field.name,
              inside);
}

void JsonReader::repeat(const Field& field, std::size_t /*count*/,
                        const std::function<void(std::size_t)>& resize,
                        const std::function<void(Fields&, std::size_t)>& inside) {
  if (!is_said(field)) return;
  const Json& list = fields_.list(field.name);
  std::string one = field.name;
  if (one.ends_with('s')) one.pop_back();
  resize(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::size_t number = i + (naming_ == Naming::kOfPeople ? 1 : 0);
    read_inside(list[i], fmt::format("{} {}", one, number), [&](Fields& each) { inside(each, i); });
  }
}

void JsonWriter::keep(Json& document) {
  if (document.is_object()) object_ = document;
}

void JsonWriter::write(const Field& field, bool is_empty, Json value) {
  if (is_empty) {
    object_.erase(field.name);
  } else {
    object_[field.name] = std::move(value);
  }
}

void JsonWriter::take(const Field& field, Value value) {
  std::visit(
      [&]<typename T>(T* each) {
        if constexpr (kIsOptional<T>) {
          write(field, !each->has_value(), *each ? Json(**each) : Json());
        } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
          write(field, field.need == Need::kUnlessEmpty && each->empty(), each->string());
        } else if constexpr (std::is_same_v<T, std::vector<std::filesystem::path>>) {
          Json paths = Json::array();
          for (const std::filesystem::path& path : *each) paths.push_back(path.string());
          write(field, field.need == Need::kUnlessEmpty && each->empty(), std::move(paths));
        } else {
          write(field, field.need == Need::kUnlessEmpty && *each == T(), *each);
        }
      },
      value);
}

void JsonWriter::choose(const Field& field, Words words, std::size_t now,
                        const std::function<void(std::size_t)>& /*choose*/) {
  write(field, field.need == Need::kUnlessEmpty && now == 0, words[now]);
}

void JsonWriter::enter(const Field& field, const std::function<void(Fields&)>& inside, bool is_default) {
  if (field.need == Need::kUnlessEmpty && is_default) {
    object_.erase(field.name);
    return;
  }
  Json object = object_.value(field.name, Json::object());
  JsonWriter writer(object);
  inside(writer);
  object_[field.name] = std::move(object);
}

void JsonWriter::repeat(const Field& field, std::size_t count,
                        const std::function<void(std::size_t)>& /*resize*/,
                        const std::function<void(Fields&, std::size_t)>& inside) {
  Json list = Json::array();
  for (std::size_t i = 0; i < count; ++i) {
    Json object = Json::object();
    JsonWriter writer(object);
    inside(writer, i);
    list.push_back(std::move(object));
  }
  object_[field.name] = std::move(list);
}

Json property_of(const Field& field, const Fields::Value& value) {
  return std::visit(
      [&]<typename T>(const T* each) {
        if constexpr (std::is_same_v<T, Json>) return Json{{"type", "object"}};
        Json schema = {{"type", type_of<typename Inner<T>::Type>()}};
        if (!field.words.empty()) schema["enum"] = field.words;
        if (field.range.least == kAboveZero.least) {
          schema["exclusiveMinimum"] = 0;
        } else if (field.range.least > -kMostNumber) {
          schema["minimum"] = field.range.least;
        }
        if (field.range.most < kMostNumber) schema["maximum"] = field.range.most;
        if constexpr (kIsList<T>) {
          schema = {{"type", "array"}, {"items", std::move(schema)}};
          if (field.fewest > 0) schema["minItems"] = field.fewest;
          if (field.most > 0) schema["maxItems"] = field.most;
        }
        if constexpr (std::is_arithmetic_v<T>) {
          if (field.need == Need::kMaySay) schema["default"] = *each;
        } else if constexpr (std::is_same_v<T, std::string>) {
          if (!each->empty()) schema["default"] = *each;
        }
        return schema;
      },
      value);
}

Json JsonSchema::schema() const {
  Json schema = {{"type", "object"}, {"properties", properties_}};
  if (!needed_.empty()) schema["required"] = needed_;
  if (!needed_beside_.empty()) schema["dependentRequired"] = needed_beside_;
  if (!rules_.empty()) schema["allOf"] = rules_;
  return schema;
}

void JsonSchema::exclude(const char* field, const char* other) {
  rules_.push_back({{"not", {{"required", {field, other}}}}});
}

void JsonSchema::need(const char* field, const char* other) {
  needed_beside_[field].push_back(other);
}

void JsonSchema::need_one(const std::vector<const char*>& fields) {
  if (fields.size() == 1) return needed_.push_back(fields.front());
  Json one = Json::array();
  for (const char* field : fields) one.push_back({{"required", {field}}});
  rules_.push_back({{"anyOf", std::move(one)}});
}

void JsonSchema::add(const Field& field, Json schema) {
  if (!field.says.empty()) schema["description"] = field.says;
  if (field.need == Need::kMustSay) needed_.push_back(field.name);
  properties_[field.name] = std::move(schema);
}

void JsonSchema::take(const Field& field, Value value) {
  add(field, property_of(field, value));
}

void JsonSchema::choose(const Field& field, Words words, std::size_t now,
                        const std::function<void(std::size_t)>& /*choose*/) {
  Json schema = {{"type", "string"}, {"enum", words}};
  if (field.need != Need::kMustSay) schema["default"] = words[now];
  add(field, std::move(schema));
}

void JsonSchema::enter(const Field& field, const std::function<void(Fields&)>& inside, bool /*is_default*/) {
  JsonSchema within;
  inside(within);
  add(field, within.schema());
}

void JsonSchema::repeat(const Field& field, std::size_t /*count*/,
                        const std::function<void(std::size_t)>& resize,
                        const std::function<void(Fields&, std::size_t)>& inside) {
  resize(1);
  JsonSchema within;
  inside(within, 0);
  add(field, {{"type", "array"}, {"items", within.schema()}});
}

}  // namespace weft
