// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft::app {

/// Letters, digits and "-_.:". It never begins with a dash, so that it is taken for no option, nor with a
/// dot.
bool is_plain(std::string_view text);

/// How a call refuses a body.
struct BodyWords {
  std::string what;     ///< "the LED cannot be lit"
  std::string subject;  ///< "a light", whose fields these are
  std::string see;      ///< the call in openapi.json: "POST rig/light"
};

/// Reads the body of a call into the struct that describes it; what is not said stays as it is.
class BodyFields : public Fields {
 public:
  BodyFields(const Json& body, BodyWords words) : body_(body), words_(std::move(words)) {}

  void require(bool holds, const char* field, const std::string& rule) override;
  void exclude(const char* field, const char* other) override;
  void need(const char* field, const char* other) override;
  void need_one(const std::vector<const char*>& fields) override;

  /// The first key that is no field, else the first field that is wrong, else one that is missing: kUsage
  /// with the field and its rule.
  Result<void> status() const;

 protected:
  void take(const Field& field, Value value) override;
  void choose(const Field& field, Words words, std::size_t now,
              const std::function<void(std::size_t)>& choose) override;

  virtual bool is_said(const std::string& field) const;
  bool is_known(const std::string& field) const;
  void know(const std::string& field) { known_.push_back(field); }
  /// Whether the field is said and nothing was wrong before.
  virtual bool begin(const Field& field);
  void refuse(const Error& error);
  void refuse(const std::string& field, const std::string& rule) { refuse(unfit(field, rule)); }
  void miss(const std::string& field, const std::string& others);
  Error unfit(const std::string& field, const std::string& rule) const;

  const Json& body_;

 private:
  BodyWords words_;
  std::vector<std::string> known_;
  std::optional<Error> error_, missing_;
};

/// Why a value does not fit its field; else it is read, and why is empty. A path is read as it is said.
std::string read_value(const Field& field, const Json& said, const Fields::Value& value);

/// A body over what `described` has already. kUsage.
template <typename Described>
Result<Described> read_body(const Json& body, BodyWords words, Described described = {}) {
  BodyFields fields(body, std::move(words));
  describe(fields, described);
  if (Result<void> fits = fields.status(); !fits) return std::move(fits).error();
  return described;
}

}  // namespace weft::app
