// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/clock_memory.h"

#include <system_error>

#include "core/base/json_document.h"

namespace weft::capture {
namespace {

constexpr double kKept_s = 3600;
constexpr double kDrift = 1e-4;  // of two quartzes, 50 ppm each: 0.36 s in an hour
constexpr const char* kSchema = "weft.camera_clock";

}  // namespace

std::optional<RememberedClock> ClockMemory::recall(double now_s) const {
  const Result<Json> document = read_json(file_, kSchema, 1);
  if (!document) return {};
  JsonFields fields(*document, file_.string());
  RememberedClock known = {fields.text("serial"),
                           {fields.number("offset_s"), fields.number("uncertainty_s")}};
  const double age_s = now_s - fields.number("read_s");
  if (!fields.status() || !(age_s >= 0 && age_s <= kKept_s)) return {};
  known.clock.uncertainty_s += kDrift * age_s;
  return known;
}

void ClockMemory::keep(const RememberedClock& watched, double now_s) const {
  static_cast<void>(write_json(file_, {{"schema", std::string(kSchema) + "/1.0"},
                                       {"serial", watched.serial},
                                       {"read_s", now_s},
                                       {"offset_s", watched.clock.offset_s},
                                       {"uncertainty_s", watched.clock.uncertainty_s}}));
}

void ClockMemory::forget() const {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

}  // namespace weft::capture
