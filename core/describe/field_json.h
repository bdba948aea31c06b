// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft {

/// How a refusal names what is within: "shot 0" and "solver" of a program's document; "led 1" where people
/// count too; "led 1" and "[scan]" of what a person wrote in TOML.
enum class Naming { kOfPrograms, kFromOne, kOfPeople };

/// Reads the fields of an object over the values that are there.
class JsonReader final : public Fields {
 public:
  JsonReader(const Json& object, std::string where, Naming naming = Naming::kOfPrograms)
      : object_(object), fields_(object, std::move(where)), naming_(naming) {}

  void require(bool holds, const char* field, const std::string& rule) override;
  void keep(Json& document) override { document = object_; }
  /// The first field that is missing, of another kind or out of its range: kBadData.
  Result<void> status() const { return error_ ? Result<void>(*error_) : fields_.status(); }

 private:
  void take(const Field& field, Value value) override;
  void take_numbers(const Field& field, NumberShape shape, Json& numbers) override;
  void take_count(const Field& field, std::int64_t& count) override;
  void choose(const Field& field, Words words, std::size_t now,
              const std::function<void(std::size_t)>& choose) override;
  void enter(const Field& field, const std::function<void(Fields&)>& inside, bool is_default) override;
  void repeat(const Field& field, std::size_t count, const std::function<void(std::size_t)>& resize,
              const std::function<void(Fields&, std::size_t)>& inside) override;

  template <typename T>
  void hold(const Field& field, const T& read);
  bool is_said(const Field& field) const;
  Json list_of(const Field& field);
  void read_inside(const Json& object, const std::string& name, const std::function<void(Fields&)>& inside);

  const Json& object_;
  JsonFields fields_;
  Naming naming_;
  std::optional<Error> error_;  // of an object within
};

/// Writes the fields into an object, over what it has of them.
class JsonWriter final : public Fields {
 public:
  explicit JsonWriter(Json& object) : object_(object) {}

  void keep(Json& document) override;

 private:
  void take(const Field& field, Value value) override;
  void take_numbers(const Field& field, NumberShape shape, Json& numbers) override;
  void take_count(const Field& field, std::int64_t& count) override;
  void choose(const Field& field, Words words, std::size_t now,
              const std::function<void(std::size_t)>& choose) override;
  void enter(const Field& field, const std::function<void(Fields&)>& inside, bool is_default) override;
  void repeat(const Field& field, std::size_t count, const std::function<void(std::size_t)>& resize,
              const std::function<void(Fields&, std::size_t)>& inside) override;

  void write(const Field& field, bool is_empty, Json value);

  Json& object_;
};

/// What one field may hold, as JSON Schema says it, with its default.
Json property_of(const Field& field, const Fields::Value& value);

/// The documents that a schema is of: all that a reader takes, or what a writer of today makes, which always
/// has the fields that it may leave out of older ones.
enum class SchemaOf { kRead, kWritten };

/// Says what an object may have, as JSON Schema does (2020-12).
class JsonSchema : public Fields {
 public:
  explicit JsonSchema(SchemaOf documents = SchemaOf::kRead) : documents_(documents) {}

  /// {"type": "object", "properties": ...}
  Json schema() const;

  void exclude(const char* field, const char* other) override;
  void need(const char* field, const char* other) override;
  void need_one(const std::vector<const char*>& fields) override;
  void only_if(bool holds, const std::function<void()>& walk) override;

 protected:
  void take(const Field& field, Value value) override;
  void take_numbers(const Field& field, NumberShape shape, Json& numbers) override;
  void take_count(const Field& field, std::int64_t& count) override;
  void choose(const Field& field, Words words, std::size_t now,
              const std::function<void(std::size_t)>& choose) override;
  void enter(const Field& field, const std::function<void(Fields&)>& inside, bool is_default) override;
  void repeat(const Field& field, std::size_t count, const std::function<void(std::size_t)>& resize,
              const std::function<void(Fields&, std::size_t)>& inside) override;

  void add(const Field& field, Json schema, bool may_be_none = false);
  bool has(const char* field) const { return properties_.contains(field); }

 private:
  SchemaOf documents_;
  Json properties_ = Json::object(), needed_ = Json::array();
  Json needed_beside_ = Json::object(), rules_ = Json::array();
};

/// The fields of what is described, read from an object over their defaults. kBadData.
template <typename Described>
Result<Described> read_fields(const Json& object, const std::string& where,
                              Naming naming = Naming::kOfPrograms) {
  Described read;
  JsonReader reader(object, where, naming);
  describe(reader, read);
  if (Result<void> ok = reader.status(); !ok) return std::move(ok).error();
  return read;
}

template <typename Described>
void write_fields(Json& object, Described described) {
  JsonWriter writer(object);
  describe(writer, described);
}

/// The same as a new object.
template <typename Described>
Json object_of(Described described) {
  Json object = Json::object();
  write_fields(object, std::move(described));
  return object;
}

/// The fields that differ from their defaults.
template <typename Described>
Json changes_of(Described described) {
  Json changes = Json::object();
  const Json defaults = object_of(Described()), all = object_of(std::move(described));
  for (const auto& [key, value] : all.items()) {
    if (!defaults.contains(key) || defaults[key] != value) changes[key] = value;
  }
  return changes;
}

/// A list of such, read from one. kBadData.
template <typename Described>
Result<std::vector<Described>> read_list(const Json& list, const std::string& where) {
  std::vector<Described> read;
  for (const Json& each : list) {
    Result<Described> one = read_fields<Described>(each, where);
    if (!one) return std::move(one).error();
    read.push_back(std::move(*one));
  }
  return read;
}

template <typename Described>
Json list_of(const std::vector<Described>& described) {
  Json list = Json::array();
  for (const Described& each : described) list.push_back(object_of(each));
  return list;
}

template <typename Described>
Json schema_of(SchemaOf documents = SchemaOf::kRead) {
  Described described = {};
  JsonSchema schema(documents);
  describe(schema, described);
  return schema.schema();
}

}  // namespace weft
