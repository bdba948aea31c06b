// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/server/api/bodies/body_fields.h"
#include "app/server/api/bodies/job_places.h"
#include "app/server/jobs/job.h"
#include "core/describe/field_json.h"
#include "core/describe/fields.h"

namespace weft::app {

/// Reads the body of a job into the struct that its verb reads its options into, and says those options. Its
/// status may be kNoInput or kCannotCreate too, of a place.
class JobArguments final : public BodyFields {
 public:
  JobArguments(const Json& body, const JobPlaces& places, JobSpec& spec);

  void need_one(const std::vector<const char*>& fields) override;

  /// The verb's options; its words stand among the arguments of the job.
  const std::vector<std::string>& options() const { return options_; }

 private:
  void take(const Field& field, Value value) override;
  void choose(const Field& field, Words words, std::size_t now,
              const std::function<void(std::size_t)>& choose) override;

  bool is_said(const std::string& field) const override;
  bool begin(const Field& field) override;
  void add(const Field& field, std::string argument);
  void add_flag(const Field& field, bool is_on);
  void read_place(const Field& field, const Json& said, std::filesystem::path& place);
  Result<std::filesystem::path> find_place(const Field& field, const Json& said) const;

  const JobPlaces& places_;
  JobSpec& spec_;
  std::vector<std::string> options_;
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
