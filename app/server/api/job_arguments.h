// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/server/api/job_places.h"
#include "app/server/jobs/job.h"
#include "core/field_json.h"
#include "core/fields.h"

namespace weft::app {

/// Reads the body of a job into the struct that its verb reads its options into, and says those options.
class JobArguments final : public Fields {
 public:
  JobArguments(const Json& body, const JobPlaces& places, JobSpec& spec)
      : body_(body), places_(places), spec_(spec) {}

  void require(bool holds, const char* field, const std::string& rule) override;
  void exclude(const char* field, const char* other) override;
  void need(const char* field, const char* other) override;
  void need_one(const std::vector<const char*>& fields) override;

  /// The verb's options; its words stand among the arguments of the job.
  const std::vector<std::string>& options() const { return options_; }
  /// The first key that is no field, else the first field that is wrong: kUsage with the field and its rule,
  /// kNoInput, kCannotCreate.
  Result<void> status() const;

 private:
  void take(const Field& field, Value value) override;
  void choose(const Field& field, Words words, std::size_t now,
              const std::function<void(std::size_t)>& choose) override;

  bool is_said(const std::string& field) const;
  bool is_known(const std::string& field) const;
  /// Whether the field is said and nothing was wrong before.
  bool begin(const Field& field);
  void refuse(const std::string& field, const std::string& rule);
  void miss(const std::string& field, const std::string& others);
  void add(const Field& field, std::string argument);

  template <typename T>
  void read(const Field& field, const Json& said, T& value);
  void read_place(const Field& field, const Json& said, std::filesystem::path& place);
  Result<std::filesystem::path> find_place(const Field& field, const Json& said) const;

  const Json& body_;
  const JobPlaces& places_;
  JobSpec& spec_;
  std::vector<std::string> known_ = {"kind", "request_id"};
  std::vector<std::string> options_;
  std::optional<Error> error_, missing_;
};

/// What the body of a job may hold, as JSON Schema says it.
class JobSchema final : public JsonSchema {
 public:
  void exclude(const char* field, const char* other) override;
  void need(const char* field, const char* other) override;
  void need_one(const std::vector<const char*>& fields) override;

 private:
  void take(const Field& field, Value value) override;
  void choose(const Field& field, Words words, std::size_t now,
              const std::function<void(std::size_t)>& choose) override;
};

}  // namespace weft::app
