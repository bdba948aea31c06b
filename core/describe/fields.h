// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/number.h"
#include "core/base/vec.h"

// Each thing that people fill in or that a file keeps says its fields once, in a function beside its struct:
//
//   void describe(Fields& fields, CalibrateLightsOptions& o) {
//     fields.value({"flatness_deg", "Rms waviness of the sheet, degrees", {0, 2}}, o.flatness_deg);
//   }
//
// What reads, writes, checks or explains it is a Fields that the function walks over: the command line, the
// body of a call, a JSON document, its schema (docs/decisions/0016).

template <>
struct nlohmann::adl_serializer<weft::Vec3> {
  static void to_json(weft::Json& json, const weft::Vec3& v) { json = {v.x, v.y, v.z}; }
  static void from_json(const weft::Json& json, weft::Vec3& v) {
    v = {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
  }
};

namespace weft {

inline constexpr double kMostNumber = std::numeric_limits<double>::max();
inline constexpr NumberRange kAnyNumber = {};
inline constexpr NumberRange kNotNegative = {0, kMostNumber};
inline constexpr NumberRange kAboveZero = {std::numeric_limits<double>::min(), kMostNumber};

/// What a path may name where not every path will do: to a client that sends names and no paths, and to a
/// form.
enum class PathTo {
  kAnything,
  kFile,          ///< one that is there
  kFolder,        ///< one that is there
  kNewFolder,     ///< one that must not be there
  kSession,       ///< NAME.weft
  kSessionOrSet,  ///< a session, or a set of photographs that is a folder of some
  kNamed,         ///< one of Field::words, or a file where files can be named
};

/// What stands behind a number on a command line: {"h", 3600} of seconds.
struct NumberUnit {
  const char* name;
  double size = 1;
};

/// When a field must be said, and when a document leaves it out.
enum class Need {
  kMaySay,       ///< it has a default, and is always written
  kMustSay,      ///< a reader refuses what has no such field
  kUnlessEmpty,  ///< it has a default, and is written where it differs from "", the first word or nothing
  kOrNull        ///< it is always written, as null where there is none
};

using enum Need;

/// Who may say a field.
enum class Said {
  kEverywhere,
  kAtThisMachine,  ///< on a command line alone: where files go, what is printed
  kToServer,       ///< in a call alone: a name that the server turns into arguments of its verb
};

/// What is said of one field.
struct Field {
  const char* name;                ///< in documents and bodies, with its unit: "tape_sigma_mm"
  std::string says = {};           ///< what it is, with its unit, without a full stop
  NumberRange range = kAnyNumber;  ///< of a number, and of each in a list
  Need need = Need::kMaySay;
  PathTo path = PathTo::kAnything;
  /// On the command line; null: option_of(name); "": a word without a dash; "!--no-repeat": turns a flag off.
  const char* option = nullptr;
  std::vector<std::string> words = {};  ///< that a text, or each in a list, may be; none: any
  int fewest = 0, most = 0;             ///< of a list, or bytes of a text; 0 and 0: any number
  Said said = Said::kEverywhere;
  bool is_sentence = false;            ///< a text for people, of any words
  bool has_lines = false;              ///< a text of several lines
  bool is_said_again = false;          ///< on a command line each of a list has its own option
  std::vector<NumberUnit> units = {};  ///< of which one stands behind the number on a command line
};

/// "--tape-sigma" of "tape_sigma_mm": its help says the unit.
std::string option_of(const Field& field);
/// "must be a number from 0 to 2", "must be a whole number above 0".
std::string rule_of(const NumberRange& range, bool is_whole = false);
/// "must be one of plain, twill, and is "twil"; did you mean 'twill'"
std::string rule_of_words(const std::vector<std::string>& words, std::string_view said);
/// The nearest of some words: what somebody meant.
std::string nearest_word(const std::vector<std::string>& words, std::string_view said);

/// What is held in an optional or a list; else the type itself.
template <typename T>
struct Inner {
  using Type = T;
};
template <typename T>
struct Inner<std::optional<T>> {
  using Type = T;
};
template <typename T>
struct Inner<std::vector<T>> {
  using Type = T;
};
template <typename T>
constexpr bool kIsList = false;
template <typename T>
constexpr bool kIsList<std::vector<T>> = true;
template <typename T>
constexpr bool kIsOptional = false;
template <typename T>
constexpr bool kIsOptional<std::optional<T>> = true;

/// How numbers of a document are nested: {3, 0} is a list of three, {0, 2} any number of pairs.
struct NumberShape {
  int rows = 0, columns = 0;
};
template <typename T>
constexpr NumberShape kShape = {-1, -1};  // no numbers in a shape
template <>
inline constexpr NumberShape kShape<Vec3> = {3, 0};
template <std::size_t N>
constexpr NumberShape kShape<std::array<double, N>> = {N, 0};
template <typename Row, std::size_t N>
requires(kShape<Row>.columns == 0) constexpr NumberShape kShape<std::array<Row, N>> = {N, kShape<Row>.rows};
template <typename Row>
requires(kShape<Row>.columns == 0) constexpr NumberShape kShape<std::vector<Row>> = {0, kShape<Row>.rows};

/// Walks over the fields of a struct, in their order. What is walked over must live as long as the visitor.
class Fields {
 public:
  using Value = std::variant<bool*, int*, double*, std::string*, std::filesystem::path*, std::optional<int>*,
                             std::optional<double>*, std::optional<std::string>*, std::vector<int>*,
                             std::vector<double>*, std::vector<std::string>*,
                             std::vector<std::filesystem::path>*, Json*>;
  using Words = std::span<const char* const>;

  virtual ~Fields() = default;

  template <typename T>
  void value(const Field& field, T& value) {
    if constexpr (kShape<T>.rows >= 0) {
      Json numbers = value;
      take_numbers(field, kShape<T>, numbers);
      value = numbers.get<T>();
    } else if constexpr (std::same_as<T, std::int64_t> || std::same_as<T, std::uint64_t>) {
      auto count = static_cast<std::int64_t>(value);
      take_count(field, count);
      value = static_cast<T>(count);
    } else {
      take(field, Value(&value));
    }
  }
  /// An enum by the name of its value; `words` has one a value, in their order.
  template <typename Enum, std::size_t N>
  void choice(const Field& field, Enum& value, const std::array<const char*, N>& words) {
    choose(field, words, static_cast<std::size_t>(value),
           [&value](std::size_t chosen) { value = static_cast<Enum>(chosen); });
  }
  /// A struct that is described itself.
  template <typename T>
  void object(const Field& field, T& value) {
    bool is_default = false;
    if constexpr (std::equality_comparable<T>) is_default = value == T();
    enter(
        field, [&value](Fields& inside) { describe(inside, value); }, is_default);
  }
  /// One that may not be there.
  template <typename T>
  void object(const Field& field, std::optional<T>& value) {
    const auto walk = [&value](Fields& inside) {
      if (!value) value.emplace();
      describe(inside, *value);
    };
    enter(field, walk, !value);
  }
  /// A list of such.
  template <typename T>
  void list(const Field& field, std::vector<T>& values) {
    repeat(
        field, values.size(), [&values](std::size_t count) { values.resize(count); },
        [&values](Fields& inside, std::size_t i) { describe(inside, values[i]); });
  }

  /// One that may not be there, which is another thing than an empty one.
  template <typename T>
  void list(Field field, std::optional<std::vector<T>>& values) {
    field.need = values ? kMaySay : kUnlessEmpty;
    repeat(
        field, values ? values->size() : 0, [&values](std::size_t count) { values.emplace(count); },
        [&values](Fields& inside, std::size_t i) { describe(inside, values->at(i)); });
  }

  /// Fields that only some have.
  virtual void only_if(bool holds, const std::function<void()>& walk) {
    if (holds) walk();
  }

  /// What a field must keep to beside its range: "must be above 0 for a lit shot".
  virtual void require(bool /*holds*/, const char* /*field*/, const std::string& /*rule*/) {}
  /// At most one of the two may be said.
  virtual void exclude(const char* /*field*/, const char* /*other*/) {}
  /// Who says the field must say the other.
  virtual void need(const char* /*field*/, const char* /*other*/) {}
  /// At least one of some fields must be said.
  virtual void need_one(const std::vector<const char*>& /*fields*/) {}
  /// The object as it was read, so that fields of newer minor versions survive a rewrite.
  virtual void keep(Json& /*document*/) {}

 protected:
  virtual void take(const Field& field, Value value) = 0;
  virtual void choose(const Field& field, Words words, std::size_t now,
                      const std::function<void(std::size_t)>& choose) = 0;
  /// What documents alone have: numbers in a shape, and counts of bytes and pixels, to 2^53.
  virtual void take_numbers(const Field& /*field*/, NumberShape /*shape*/, Json& /*numbers*/) {}
  virtual void take_count(const Field& /*field*/, std::int64_t& /*count*/) {}
  /// Where nothing is nested, as on a command line, the fields of a struct stand among the others.
  virtual void enter(const Field& field, const std::function<void(Fields&)>& inside, bool is_default);
  /// Where there is no list, there is none of these.
  virtual void repeat(const Field& field, std::size_t count, const std::function<void(std::size_t)>& resize,
                      const std::function<void(Fields&, std::size_t)>& inside);
};

}  // namespace weft
