// SPDX-License-Identifier: Apache-2.0
#include "core/describe/field_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

// One of a list of which one will do is written alone.
Json alone(const Field& field, Json value) {
  const bool is_alone = field.fewest == 1 && value.is_array() && value.size() == 1;
  return is_alone ? Json(value.front()) : value;
}

constexpr double kMostCount = 9007199254740992;  // 2^53: what a double holds

bool is_row(const Json& row, int columns) {
  return row.is_array() && row.size() == static_cast<std::size_t>(columns) &&
         std::ranges::all_of(row, [](const Json& each) { return each.is_number(); });
}

bool fits(const Json& list, NumberShape shape) {
  if (shape.columns == 0) return is_row(list, shape.rows);
  return (shape.rows == 0 || list.size() == static_cast<std::size_t>(shape.rows)) &&
         std::ranges::all_of(list, [&](const Json& row) { return is_row(row, shape.columns); });
}

std::string words_of(NumberShape shape) {
  if (shape.columns == 0) return fmt::format("{} numbers", shape.rows);
  if (shape.rows == 0) return fmt::format("lists of {} numbers", shape.columns);
  return fmt::format("{} lists of {} numbers", shape.rows, shape.columns);
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
  if (field.need == kOrNull && fields_.has(field.name)) return !object_.at(field.name).is_null();
  return field.need == kMustSay || fields_.has(field.name);
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
          // The value is of its default's kind; without one, of any.
          if (each->is_array()) fields_.list(field.name);
          if (each->is_object()) fields_.object(field.name);
          require(fields_.has(field.name), field.name, "is missing");
          if (fields_.status()) *each = object_.at(field.name);
        } else if constexpr (kIsList<T>) {
          const Json list = list_of(field);
          T read;
          for (std::size_t i = 0; i < list.size() && fields_.status(); ++i) {
            const Json one = {{field.name, list[i]}};
            JsonFields within(one, fields_.where());
            read.push_back(read_one<Read>(within, field.name));
            if (const Result<void> ok = within.status(); !ok && status()) error_ = ok.error();
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

void JsonReader::take_numbers(const Field& field, NumberShape shape, Json& numbers) {
  if (!is_said(field)) return;
  const Json& said = fields_.list(field.name);
  if (!fields_.status()) return;
  if (!fits(said, shape)) {
    constexpr std::size_t kEnough = 60;
    return require(false, field.name,
                   fmt::format("is {}; {} were expected", said.dump().substr(0, kEnough), words_of(shape)));
  }
  const Json flat = said.flatten();
  require(std::ranges::all_of(flat, [&](const Json& each) { return field.range.holds(each.get<double>()); }),
          field.name, rule_of(field.range));
  if (fields_.status()) numbers = said;
}

void JsonReader::take_count(const Field& field, std::int64_t& count) {
  if (!is_said(field)) return;
  const double said = fields_.number(field.name);
  require(said >= 0 && said <= kMostCount && said == std::floor(said), field.name,
          "must be a whole number from 0");
  if (fields_.status()) count = static_cast<std::int64_t>(said);
}

void JsonReader::choose(const Field& field, Words words, std::size_t /*now*/,
                        const std::function<void(std::size_t)>& choose) {
  if (!is_said(field)) return;
  if (naming_ != Naming::kOfPeople) return choose(fields_.place_of(field.name, words));
  const std::string said = fields_.text(field.name);
  const auto found = std::ranges::find(words, std::string_view(said));
  if (found == words.end()) {
    fields_.reject(field.name, rule_of_words({words.begin(), words.end()}, said));
  } else {
    choose(static_cast<std::size_t>(found - words.begin()));
  }
}

void JsonReader::read_inside(const Json& object, const std::string& name,
                             const std::function<void(Fields&)>& inside) {
  JsonReader reader(object, fmt::format("{}: {}", fields_.where(), name), naming_);
  inside(reader);
  const Result<void> ok = reader.status();
  if (!ok && status()) error_ = ok.error();
}

void JsonReader::enter(const Field& field, const std::function<void(Fields&)>& inside, bool /*is_default*/) {
  if (!is_said(field) || !status()) return;
  const bool is_of_people = naming_ == Naming::kOfPeople;
  read_inside(fields_.object(field.name), is_of_people ? fmt::format("[{}]", field.name) : field.name,
              inside);
}

void JsonReader::repeat(const Field& field, std::size_t /*count*/,
                        const std::function<void(std::size_t)>& resize,
                        const std::function<void(Fields&, std::size_t)>& inside) {
  if (!is_said(field) || !status()) return;
  const Json& list = fields_.list(field.name);
  std::string one = field.name;
  if (one.ends_with('s')) one.resize(one.size() - (one.ends_with("ches") ? 2 : 1));
  resize(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::size_t number = i + (naming_ == Naming::kOfPrograms ? 0 : 1);
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
          write(field, !each->has_value() && field.need != kOrNull, *each ? Json(**each) : Json());
        } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
          write(field, field.need == kUnlessEmpty && each->empty(), each->string());
        } else if constexpr (std::is_same_v<T, std::vector<std::filesystem::path>>) {
          Json paths = Json::array();
          for (const std::filesystem::path& path : *each) paths.push_back(path.string());
          write(field, field.need == kUnlessEmpty && each->empty(), std::move(paths));
        } else {
          const bool is_none = kIsList<T> && field.need == kOrNull && *each == T();
          write(field, field.need == kUnlessEmpty && *each == T(), is_none ? Json() : alone(field, *each));
        }
      },
      value);
}

void JsonWriter::take_numbers(const Field& field, NumberShape /*shape*/, Json& numbers) {
  write(field, field.need == kUnlessEmpty && numbers.empty(), numbers);
}

void JsonWriter::take_count(const Field& field, std::int64_t& count) {
  write(field, field.need == kUnlessEmpty && count == 0, count);
}

void JsonWriter::choose(const Field& field, Words words, std::size_t now,
                        const std::function<void(std::size_t)>& /*choose*/) {
  write(field, field.need == kUnlessEmpty && now == 0, words[now]);
}

void JsonWriter::enter(const Field& field, const std::function<void(Fields&)>& inside, bool is_default) {
  if (is_default && field.need == kOrNull) return write(field, false, Json());
  if (is_default && field.need == kUnlessEmpty) return write(field, true, Json());
  Json object = object_.value(field.name, Json::object());
  JsonWriter writer(object);
  inside(writer);
  object_[field.name] = std::move(object);
}

void JsonWriter::repeat(const Field& field, std::size_t count,
                        const std::function<void(std::size_t)>& /*resize*/,
                        const std::function<void(Fields&, std::size_t)>& inside) {
  if (count == 0 && field.need == kUnlessEmpty) return write(field, true, Json());
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
        if constexpr (std::is_same_v<T, Json>) return Json{{"type", each->is_array() ? "array" : "object"}};
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
          if (field.need == kMaySay) schema["default"] = *each;
        } else if constexpr (std::is_same_v<T, std::string>) {
          if (!each->empty()) schema["default"] = *each;
          if (field.most > 0) schema["maxLength"] = field.most;
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

void JsonSchema::add(const Field& field, Json schema, bool may_be_none) {
  if (!field.says.empty()) schema["description"] = field.says;
  if (field.need == kOrNull && schema.contains("type")) {
    Json types = Json::array({schema["type"], "null"});
    if (field.fewest == 1 && schema.contains("items")) types.insert(types.begin(), schema["items"]["type"]);
    schema["type"] = std::move(types);
  }
  const bool is_written = field.need == kOrNull || (field.need == kMaySay && !may_be_none);
  if (field.need == kMustSay || (is_written && documents_ == SchemaOf::kWritten))
    needed_.push_back(field.name);
  if (documents_ == SchemaOf::kWritten) schema.erase("default");
  properties_[field.name] = std::move(schema);
}

void JsonSchema::take(const Field& field, Value value) {
  const bool may_be_none = std::visit([]<typename T>(const T*) { return kIsOptional<T>; }, value);
  add(field, property_of(field, value), may_be_none);
}

void JsonSchema::take_numbers(const Field& field, NumberShape shape, Json& /*numbers*/) {
  const auto list_of = [](Json each, int count) {
    Json list = {{"type", "array"}, {"items", std::move(each)}};
    if (count > 0) list["minItems"] = list["maxItems"] = count;
    return list;
  };
  const Json number = {{"type", "number"}};
  add(field, list_of(shape.columns == 0 ? number : list_of(number, shape.columns), shape.rows));
}

void JsonSchema::take_count(const Field& field, std::int64_t& /*count*/) {
  add(field, {{"type", "integer"}, {"minimum", 0}});
}

void JsonSchema::only_if(bool /*holds*/, const std::function<void()>& walk) {
  const Json needed = needed_;
  walk();
  needed_ = needed;
}

void JsonSchema::choose(const Field& field, Words words, std::size_t now,
                        const std::function<void(std::size_t)>& /*choose*/) {
  Json schema = {{"type", "string"}, {"enum", words}};
  if (field.need != kMustSay) schema["default"] = words[now];
  add(field, std::move(schema));
}

void JsonSchema::enter(const Field& field, const std::function<void(Fields&)>& inside, bool /*is_default*/) {
  JsonSchema within(documents_);
  inside(within);
  add(field, within.schema());
}

void JsonSchema::repeat(const Field& field, std::size_t /*count*/,
                        const std::function<void(std::size_t)>& resize,
                        const std::function<void(Fields&, std::size_t)>& inside) {
  resize(1);
  JsonSchema within(documents_);
  inside(within, 0);
  add(field, {{"type", "array"}, {"items", within.schema()}});
}

}  // namespace weft
