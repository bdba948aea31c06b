// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/photograph_evidence.h"

#include <fmt/format.h>

#include <string>

#include "core/rig/exposure_words.h"
#include "core/rig/same_camera.h"

namespace weft::capture {
namespace {

// A clock's seconds as a property and as a photograph's sub-seconds need not turn at the same moment.
constexpr double kClockSlackS = 0.25;

Error older(const std::string& why) {
  return {ErrorKind::kProtocol, "an older photograph arrived", "", why, "take this one again"};
}

Result<void> check_kind(const PhotographFacts& facts) {
  if (is_raw_ending(facts.ending)) return {};
  if (facts.ending.empty()) {
    return Error{ErrorKind::kProtocol, "what arrived is no photograph", "", "its header cannot be read",
                 "take it again"};
  }
  if (is_unread_raw_ending(facts.ending)) {
    return Error{ErrorKind::kBadData, "this kind of raw is not read yet", "",
                 "a " + facts.ending + " arrived", "use a body that writes DNG, NEF, CR2, ARW or PEF"};
  }
  return Error{ErrorKind::kBadData, "the camera sends no raw photographs", "",
               "a " + facts.ending + " arrived", "set its image quality to raw alone"};
}

Result<void> check_order(const PhotographFacts& facts, const AskedFor& asked) {
  if (facts.image_number && asked.last_image_number && *facts.image_number <= *asked.last_image_number)
    return older(fmt::format("image {} after image {}", *facts.image_number, *asked.last_image_number));
  const std::optional<double> taken = taken_s(facts, asked.clock);
  if (!taken) return {};
  const double slack_s = asked.clock->uncertainty_s + facts.resolution_s + kClockSlackS;
  if (*taken < asked.triggered_s - slack_s)
    return older(fmt::format("it was taken {:.1f} s before it was asked for", asked.triggered_s - *taken));
  if (*taken <= asked.arrived_s + slack_s) return {};
  return Error{ErrorKind::kProtocol, "the photograph's time lies ahead", "",
               fmt::format("by {:.1f} s: the camera's clock was set", *taken - asked.arrived_s),
               "connect the camera again"};
}

Result<void> check_exposure(const PhotographFacts& facts, const ExposureSettings& set) {
  const auto differs = [](double said, double wanted) {
    return said > 0 && wanted > 0 && !same_setting(said, wanted);
  };
  const auto refuse = [](const char* name, const std::string& said, const std::string& wanted,
                         const char* remedy = "leave the camera's dials alone during a scan") {
    return Error{ErrorKind::kBadData, "the photograph was not taken as set", "",
                 fmt::format("{} is {}, not {}", name, said, wanted), remedy};
  };
  if (differs(facts.exposure_us, set.exposure_us))
    return refuse("exposure", exposure_words(facts.exposure_us), exposure_words(set.exposure_us));
  if (differs(facts.iso, set.iso))
    return refuse("ISO", fmt::format("{:.10g}", facts.iso), fmt::format("{:.10g}", set.iso),
                  "switch the camera's auto ISO off, and leave its dials alone during a scan");
  if (differs(facts.f_number, set.f_number))
    return refuse("f-number", fmt::format("{:g}", facts.f_number), fmt::format("{:g}", set.f_number));
  return {};
}

}  // namespace

std::optional<double> taken_s(const PhotographFacts& facts, const std::optional<CameraClock>& clock) {
  if (!facts.taken_s || !clock) return {};
  return *facts.taken_s - clock->offset_s;
}

Result<void> check_photograph(const PhotographFacts& facts, const AskedFor& asked) {
  if (Result<void> raw = check_kind(facts); !raw) return raw;
  if (asked.bytes < facts.data_end) {
    return Error{
        ErrorKind::kProtocol, "the photograph is not whole", "",
        fmt::format("{} bytes arrived, and by its header there are at least {}", asked.bytes, facts.data_end),
        "take it again"};
  }
  if (Result<void> newer = check_order(facts, asked); !newer) return newer;
  return check_exposure(facts, asked.exposure);
}

}  // namespace weft::capture
